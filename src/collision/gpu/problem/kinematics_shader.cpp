#include "collision/gpu/problem/kinematics_shader.h"

#include <functional>

#include "base/text/number_text.h"

// Forward kinematics as straight-line code: the pose of each link is the pose of its parent times the pose of its
// joint. Rotations use Rodrigues' formula (K. M. Lynch, F. C. Park: Modern Robotics, 2017, chapters 3 and 4).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string literal(double value)
{
  return exactText(value) + "lf";
}

std::string vector(const std::function<std::string(int)>& entry)
{
  return "dvec3(" + entry(0) + ", " + entry(1) + ", " + entry(2) + ")";
}

std::string vector(const Vector3d& v)
{
  return vector([&](int i) { return literal(v[i]); });
}

/// The text of a matrix; GLSL lists the columns one after the other.
std::string matrix(const std::function<std::string(int, int)>& entry)
{
  return "dmat3(" + vector([&](int row) { return entry(row, 0); }) + ", " +
         vector([&](int row) { return entry(row, 1); }) + ", " + vector([&](int row) { return entry(row, 2); }) + ")";
}

std::string matrix(const Matrix3d& m)
{
  return matrix([&](int row, int column) { return literal(m(row, column)); });
}

/// Adds the term coefficient * factor to the text of a sum. An empty factor means 1.
void addTerm(double coefficient, const std::string& factor, std::string& sum)
{
  if (coefficient == 0.0)
    return;
  if (!sum.empty())
    sum += " + ";
  sum += factor.empty() ? literal(coefficient) : literal(coefficient) + " * " + factor;
}

/// The text of origin * (rotation around `axis`) by Rodrigues' formula a a^T + c (I - a a^T) + s [a]x. `c` and `s` are
/// the names of the cosine and the sine.
std::string turned(const Matrix3d& origin, const Vector3d& axis, const std::string& c, const std::string& s)
{
  const Matrix3d along = axis * axis.transpose();
  Matrix3d across;
  across << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  const Matrix3d constant = origin * along;
  const Matrix3d with_cosine = origin * (Matrix3d::Identity() - along);
  const Matrix3d with_sine = origin * across;
  return matrix(
      [&](int row, int column)
      {
        std::string sum;
        addTerm(constant(row, column), "", sum);
        addTerm(with_cosine(row, column), c, sum);
        addTerm(with_sine(row, column), s, sum);
        return sum.empty() ? literal(0.0) : sum;
      });
}

/// The lines that define relativeN, the pose of link N in the frame of its parent link.
class JointText
{
 public:
  JointText(const RobotModel& robot, std::size_t link)
    : joint_(robot.joints()[static_cast<std::size_t>(robot.links()[link].parent_joint)]),
      width_(robot.variables().size()),
      number_(std::to_string(link))
  {
  }

  std::string lines() const
  {
    const Matrix3d& rotation = joint_.origin.linear();
    const Vector3d& translation = joint_.origin.translation();
    switch (joint_.type)
    {
      case JointType::Revolute:
      case JointType::Continuous:
        return sineOf(position()) +
               pose(turned(rotation, joint_.axis, "c" + number_, "s" + number_), vector(translation));
      case JointType::Prismatic:
        return pose(matrix(rotation),
                    vector(translation) + " + (" + position() + ") * " + vector(Vector3d(rotation * joint_.axis)));
      case JointType::Planar:
      {
        const Matrix3d directions = rotation * planarDirections(joint_.axis);
        return sineOf(variable(2)) +
               pose(turned(rotation, joint_.axis, "c" + number_, "s" + number_),
                    vector(translation) + " + " + variable(0) + " * " + vector(Vector3d(directions.col(0))) + " + " +
                        variable(1) + " * " + vector(Vector3d(directions.col(1))));
      }
      case JointType::Floating:
        return pose(matrix(rotation) + " * quaternionRotation(dvec4(" + variable(3) + ", " + variable(4) + ", " +
                        variable(5) + ", " + variable(6) + "))",
                    vector(translation) + " + " + matrix(rotation) + " * dvec3(" + variable(0) + ", " + variable(1) +
                        ", " + variable(2) + ")");
      case JointType::Fixed:
        break;
    }
    return pose(matrix(rotation), vector(translation));
  }

 private:
  std::string variable(int i) const
  {
    return "variable(state, " + std::to_string(width_) + "u, " + std::to_string(joint_.first_variable + i) + "u)";
  }
  std::string position() const
  {
    return literal(joint_.multiplier) + " * " + variable(0) + " + " + literal(joint_.offset);
  }
  std::string sineOf(const std::string& angle) const
  {
    return "  double s" + number_ + ", c" + number_ + ";\n  sineCosine(" + angle + ", s" + number_ + ", c" + number_ +
           ");\n";
  }
  std::string pose(const std::string& rotation, const std::string& translation) const
  {
    return "  const DoublePose relative" + number_ + " = DoublePose(" + rotation + ", " + translation + ");\n";
  }

  const Joint& joint_;
  std::size_t width_;
  std::string number_;
};
}  // namespace

std::string kinematicsShader(const RobotModel& robot)
{
  std::string text =
      "#include \"shader_constants.h\"\n"
      "layout(local_size_x = GROUP_SIZE) in;\n"
      "#include \"common/invocation.glsl\"\n"
      "#include \"problem/kinematics.glsl\"\n"
      "void main()\n"
      "{\n"
      "  const uint i = invocationIndex();\n"
      "  if (i >= (listed != 0u ? lengthOf(LIST_OPEN_STATES, state_count) : state_count))\n"
      "    return;\n"
      "  const uint state = listed != 0u ? open_states[i] : i;\n";
  for (std::size_t i = 0; i < robot.links().size(); ++i)
  {
    const std::string link = "link" + std::to_string(i);
    const int parent_joint = robot.links()[i].parent_joint;
    if (parent_joint < 0)
    {
      text += "  const DoublePose " + link + " = DoublePose(dmat3(1.0lf), dvec3(0.0lf));\n";
    }
    else
    {
      const int parent = robot.joints()[static_cast<std::size_t>(parent_joint)].parent_link;
      const std::string relative = "relative" + std::to_string(i);
      text += JointText(robot, i).lines();
      text += "  const DoublePose " + link + " = " +
              (parent < 0 ? relative : "compose(link" + std::to_string(parent) + ", " + relative + ")") + ";\n";
    }
    text += "  placeShapes(state, " + std::to_string(i) + "u, " + link + ");\n";
  }
  return text + "}\n";
}
}  // namespace gpu_planning_scene::core
