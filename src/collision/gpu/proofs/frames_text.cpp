#include "collision/gpu/proofs/frames_text.h"

#include <vector>

#include "collision/gpu/proofs/proof_names.h"

// The pose of a frame is that of its parent times the pose of its joint: a constant plus the cosine and the sine of the
// joint value times constants (Rodrigues' formula; K. M. Lynch, F. C. Park: Modern Robotics, 2017). Terms that are 0
// are left out. Numbers are those of the lane kernel, which are floats.
namespace gpu_planning_scene::core
{
namespace
{
using lanes::Frame;
using lanes::FrameKind;

void addTerm(float coefficient, const std::string& factor, std::string& sum)
{
  if (coefficient == 0.0F)
    return;
  sum += (sum.empty() ? "" : " + ") + number(coefficient) + (factor.empty() ? "" : " * " + factor);
}

/// The lines that define a frame.
class FrameText
{
 public:
  FrameText(const Frame& frame, std::size_t index) : frame_(frame), index_(std::to_string(index)) {}

  std::string lines() const
  {
    std::string text = value();
    // The pose relative to the parent's frame, entry by entry.
    for (std::size_t k = 0; k < 12; ++k)
      if (const std::string sum = entry(k); !sum.empty())
        text += "  precise const float " + relative(k) + " = " + sum + ";\n";
    for (std::size_t row = 0; row < 3; ++row)
      text += "  precise const vec4 " + rowOf(index_, row) + " = vec4(" + placed(row, 0) + ", " + placed(row, 1) +
              ", " + placed(row, 2) + ", " + placed(row, 3) + ");\n";
    return text;
  }

  /// The rows, as arguments of a function.
  std::string rows() const { return rowOf(index_, 0) + ", " + rowOf(index_, 1) + ", " + rowOf(index_, 2); }

 private:
  static std::string rowOf(const std::string& frame, std::size_t row) { return std::string(1, "xyz"[row]) + frame; }
  std::string relative(std::size_t k) const { return "r" + index_ + "_" + std::to_string(k); }
  std::string joint() const
  {
    return exactText(frame_.multiplier) + "lf * " + valueName(frame_.variable) + " + " + exactText(frame_.offset) +
           "lf";
  }

  /// The lines that define what the entries need of the joint's value.
  std::string value() const
  {
    switch (frame_.kind)
    {
      case FrameKind::Fixed:
        break;
      case FrameKind::Revolute:
        return "  float s" + index_ + ", c" + index_ + ";\n  sineCosine(float(turned(" + joint() + ")), s" + index_ +
               ", c" + index_ + ");\n";
      case FrameKind::Prismatic:
        return "  const float d" + index_ + " = float(" + joint() + ");\n";
      case FrameKind::Turned:
      {
        std::string coefficients;
        for (int k = 0; k < 4; ++k)
          coefficients += (k == 0 ? "" : ", ") + valueName(frame_.variable + k);
        return "  mat3 q" + index_ + ";\n  placed = turnedBy(vec4(" + coefficients + "), q" + index_ + ") && placed;\n";
      }
    }
    return "";
  }

  /// An entry of the relative pose; empty: it is 0.
  std::string entry(std::size_t k) const
  {
    const std::size_t row = k / 4;
    const std::size_t column = k % 4;
    if (frame_.kind == FrameKind::Turned)
      return column == 3 ? "" : "q" + index_ + "[" + std::to_string(column) + "][" + std::to_string(row) + "]";
    std::string sum;
    addTerm(frame_.constant[k], "", sum);
    if (frame_.kind == FrameKind::Revolute && column != 3)
    {
      addTerm(frame_.first[k], "c" + index_, sum);
      addTerm(frame_.second[k], "s" + index_, sum);
    }
    if (frame_.kind == FrameKind::Prismatic && column == 3)
      addTerm(frame_.first[k], "d" + index_, sum);
    return sum;
  }

  /// An entry of the frame: a sum of products of the parent's row with the entries of the relative pose.
  std::string placed(std::size_t row, std::size_t column) const
  {
    if (frame_.parent < 0)
      return entry(4 * row + column).empty() ? "0.0" : relative(4 * row + column);
    const std::string parent = rowOf(std::to_string(frame_.parent), row) + ".";
    std::string sum = column == 3 ? parent + "w" : "";
    for (std::size_t k = 3; k-- > 0;)
    {
      if (entry(4 * k + column).empty())
        continue;
      const std::string factors = parent + "xyz"[k] + (sum.empty() ? " * " : ", ") + relative(4 * k + column);
      sum = sum.empty() ? factors : "fma(" + factors + ", " + sum + ")";
    }
    return sum.empty() ? "0.0" : sum;
  }

  const Frame& frame_;
  std::string index_;
};

/// The lines that read the values of a state. Two of them share a texel. With an odd width, a row may begin in the
/// middle of a texel.
std::string valueLines(std::size_t width)
{
  std::string text = "  const uint first = state * " + std::to_string(width) + "u;\n";
  const bool may_be_odd = width % 2 == 1;
  const std::size_t texels = width / 2 + (may_be_odd ? 1 : 0);
  for (std::size_t t = 0; t < texels; ++t)
    text += "  const uvec4 t" + std::to_string(t) + " = texelFetch(state_texels, int(first / 2u + " +
            std::to_string(t) + "u));\n";
  const auto half = [](std::size_t place)
  { return "t" + std::to_string(place / 2) + (place % 2 == 0 ? ".xy" : ".zw"); };
  for (std::size_t v = 0; v < width; ++v)
    text += "  const double " + valueName(static_cast<int>(v)) + " = packDouble2x32(" +
            (may_be_odd ? "first % 2u == 0u ? " + half(v) + " : " + half(v + 1) : half(v)) + ");\n";
  return text;
}
/// A centre that moves with a frame is a value of its own, and with CENTER_ARRAY also an entry of an array.
std::string centerLines(const LaneScene& scene, std::uint32_t center, const FrameText& frame)
{
  const lanes::Model& model = scene.model();
  std::string point = "vec3(0.0)";
  if (center < model.instances.count)
  {
    const float* place = model.instances[center].center;
    point = "vec3(" + number(place[0]) + ", " + number(place[1]) + ", " + number(place[2]) + ")";
  }
  return "  const vec3 " + centerName(center) + " = placedBy(" + frame.rows() + ", " + point +
         ");\n#if CENTER_ARRAY\n  centers[" + std::to_string(center) + "] = " + centerName(center) + ";\n#endif\n";
}
}  // namespace

std::string framesText(const LaneScene& scene)
{
  const lanes::Model& model = scene.model();
  const std::vector<int> places = placesOfFrames(model);
  std::string text;
  for (std::size_t i = 0; i < model.frames.count; ++i)
  {
    const FrameText frame(model.frames[i], i);
    text += frame.lines();
    if (const int place = places[i]; place >= 0)
      text += "  writeFrame(state, " + std::to_string(place) + "u, " + frame.rows() + ");\n";
    text += "#if CENTER_ARRAY\n  placeAttached(records, " + std::to_string(i) + "u, " + frame.rows() +
            ", centers);\n#endif\n";
    for (const std::uint32_t center : scene.linkCenters())
      if (frameOf(model, center) == static_cast<int>(i))
        text += centerLines(scene, center, frame);
  }
  return text;
}

std::string valuesText(const LaneScene& scene)
{
  const std::size_t width = scene.model().width;
  std::string text;
  text += valueLines(width) + "  bool bounded = true;\n";
  const std::vector<LaneFrames::Limit>& limits = scene.frames().limits();
  for (std::size_t v = 0; v < limits.size(); ++v)
    text += "  bounded = bounded && abs(" + valueName(static_cast<int>(v)) + " - " + exactText(limits[v].middle) +
            "lf) <= " + exactText(limits[v].reach) + "lf;\n";
  return text;
}
}  // namespace gpu_planning_scene::core
