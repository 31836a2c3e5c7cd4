#include <algorithm>
#include <array>
#include <cstdint>

#include "gpu_planning_scene/error.h"
#include "model/meshes/mesh_formats.h"
#include "model/meshes/words.h"

// The format of Wavefront Technologies: Advanced Visualizer Manual, appendix B1: Object Files.
namespace gpu_planning_scene::core
{
namespace
{
// Statements without a surface: attributes, groups, points and lines, and what only draws.
constexpr std::array<std::string_view, 21> kNoSurface = {
    "vn", "vt", "vp",    "g",   "s",        "o",        "mg",         "usemtl",    "mtllib", "usemap", "maplib",
    "p",  "l",  "bevel", "lod", "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech",  "stech"};

/// Splits a text at the ends of its lines. A backslash at the end of a line joins the next line to it.
class Lines
{
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// False at the end of the text.
  bool next(std::string& line)
  {
    line.clear();
    number_ += read_;
    read_ = 0;
    if (text_.empty())
      return false;
    do
    {
      if (!line.empty())
        line.back() = ' ';  // in place of the backslash
      const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
      line.append(text_.substr(0, end));
      const std::size_t width = text_.substr(end, 2) == "\r\n" ? 2 : 1;
      text_.remove_prefix(std::min(end + width, text_.size()));
      ++read_;
    } while (!line.empty() && line.back() == '\\' && !text_.empty());
    return true;
  }
  /// The number of the first line of the last call.
  std::size_t number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t number_ = 1;
  std::size_t read_ = 0;  // lines of the last call
};

class ObjReader
{
 public:
  explicit ObjReader(std::string_view text) : lines_(text) {}

  void read(MeshBuilder& mesh)
  {
    std::string line;
    while (lines_.next(line))
      readStatement(line.substr(0, line.find('#')));
    addFaces(mesh);
  }

 private:
  struct Face
  {
    std::size_t first;  // place in corners_
    std::size_t line;
  };

  void readStatement(const std::string& line)
  {
    Words words(line);
    const std::string_view keyword = words.next();
    if (keyword == "v")
      readVertex(words);
    else if (keyword == "f" || keyword == "fo")  // fo: the old name
      readFace(words);
    else if (!keyword.empty() && std::find(kNoSurface.begin(), kNoSurface.end(), keyword) == kNoSurface.end())
      failInLine(lines_.number(), "the statement " + inQuotes(keyword) +
                                      " cannot be read; only polygons can, so export the model as a polygon mesh");
  }

  /// x y z, then a weight or a colour.
  void readVertex(Words& words)
  {
    std::vector<double> values;
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      values.push_back(numberFrom(word, lines_.number()));
    const bool has_weight = values.size() == 4;
    if (values.size() != 3 && values.size() != 6 && !has_weight)
      failInLine(lines_.number(), "a vertex has " + std::to_string(values.size()) + " numbers, not 3");
    if (has_weight && values[3] != 1.0)
      failInLine(lines_.number(), "a vertex has a weight that is not 1");
    vertices_.emplace_back(values[0], values[1], values[2]);
  }

  void readFace(Words& words)
  {
    faces_.push_back({corners_.size(), lines_.number()});
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      corners_.push_back(vertexOf(word));
  }

  /// A corner is VERTEX, VERTEX/TEXTURE, VERTEX//NORMAL or VERTEX/TEXTURE/NORMAL. A negative number counts back from
  /// the newest vertex.
  std::int64_t vertexOf(std::string_view corner) const
  {
    const std::size_t end = std::min(corner.find('/'), corner.size());
    const std::int64_t number = integerFrom(corner.substr(0, end), lines_.number());
    if (corner.find_first_not_of("-0123456789/", end) != corner.npos)
      failInLine(lines_.number(), inQuotes(corner) + " is no corner of a face");
    return number < 0 ? static_cast<std::int64_t>(vertices_.size()) + number : number - 1;
  }

  void addFaces(MeshBuilder& mesh) const
  {
    std::vector<Eigen::Vector3d> polygon;
    for (std::size_t i = 0; i < faces_.size(); ++i)
    {
      polygon.clear();
      const std::size_t end = i + 1 < faces_.size() ? faces_[i + 1].first : corners_.size();
      for (std::size_t k = faces_[i].first; k < end; ++k)
      {
        if (corners_[k] < 0 || corners_[k] >= static_cast<std::int64_t>(vertices_.size()))
          failInLine(faces_[i].line, "a face names a vertex that the file does not have");
        polygon.push_back(vertices_[static_cast<std::size_t>(corners_[k])]);
      }
      if (polygon.size() >= 3)  // fewer corners are a point or a line
        mesh.addPolygon(polygon);
    }
  }

  Lines lines_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::int64_t> corners_;  // indices of vertices, face after face
  std::vector<Face> faces_;
};
}  // namespace

void readObj(std::string_view content, MeshBuilder& mesh)
{
  ObjReader(withoutByteOrderMark(content)).read(mesh);
}
}  // namespace gpu_planning_scene::core
