#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gpu_planning_scene/error.h"
#include "model/meshes/mesh_formats.h"
#include "model/meshes/ply_header.h"
#include "model/meshes/ply_values.h"
#include "model/meshes/words.h"

// The format of G. Turk: The PLY Polygon File Format, 1994. It is read here, because the libraries that Debian has read
// some files wrongly or refuse them: binary values that look like ends of lines, vertices behind faces, faces that
// share an edge with two others.
namespace gpu_planning_scene::core
{
namespace
{
/// Polygons as indices of vertices.
class Polygons
{
 public:
  void begin() { ends_.push_back(corners_.size()); }
  void addCorner(std::uint32_t vertex)
  {
    corners_.push_back(vertex);
    ends_.back() = corners_.size();
  }

  void addTo(MeshBuilder& mesh, const std::vector<Eigen::Vector3d>& vertices) const
  {
    std::vector<Eigen::Vector3d> polygon;
    std::size_t begin = 0;
    for (const std::size_t end : ends_)
    {
      polygon.clear();
      for (; begin < end; ++begin)
      {
        if (corners_[begin] >= vertices.size())
          throw Error("a face names vertex " + std::to_string(corners_[begin]) + ", but there are " +
                      std::to_string(vertices.size()) + " vertices");
        polygon.push_back(vertices[corners_[begin]]);
      }
      if (polygon.size() >= 3)  // fewer corners are a point or a line
        mesh.addPolygon(polygon);
    }
  }

 private:
  std::vector<std::uint32_t> corners_;
  std::vector<std::size_t> ends_;
};

bool isIndexList(const PlyProperty& property)
{
  return property.length_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

class PlyReader
{
 public:
  explicit PlyReader(std::string_view content) : header_(readPlyHeader(content)), values_(plyValues(content, header_))
  {
  }

  void read(MeshBuilder& mesh)
  {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex")
        readVertices(element);
      else if (element.name == "face")
        readFaces(element);
      else if (element.name == "tristrips")
        readStrips(element);
      else
        skipElements(element);
    values_->requireEnd();
    polygons_.addTo(mesh, vertices_);
  }

 private:
  void readVertices(const PlyElement& element)
  {
    std::vector<int> axes;  // the coordinate that each property is; -1: none
    for (const PlyProperty& property : element.properties)
    {
      const bool is_axis = property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
      axes.push_back(is_axis && !property.length_type ? property.name[0] - 'x' : -1);
    }
    if (std::count(axes.begin(), axes.end(), -1) + 3 != static_cast<std::ptrdiff_t>(axes.size()))
      throw Error("the element 'vertex' does not have the properties x, y and z");
    for (std::uint64_t i = 0; i < element.count; ++i)
    {
      vertices_.emplace_back();
      for (std::size_t k = 0; k < axes.size(); ++k)
        if (axes[k] >= 0)
          vertices_.back()[axes[k]] = values_->next(element.properties[k].type);
        else
          skip(element.properties[k]);
    }
  }

  void readFaces(const PlyElement& element)
  {
    const PlyProperty& list = indexList(element);
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
      {
        if (&property != &list)
        {
          skip(property);
          continue;
        }
        polygons_.begin();
        for (std::uint64_t left = length(property); left > 0; --left)
          polygons_.addCorner(vertexOf(values_->next(property.type)));
      }
  }

  /// Strips of triangles; -1 ends a strip. Triangles with equal vertices only join parts of a strip.
  void readStrips(const PlyElement& element)
  {
    const PlyProperty& list = indexList(element);
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
      {
        if (&property != &list)
        {
          skip(property);
          continue;
        }
        std::vector<std::uint32_t> strip;
        for (std::uint64_t left = length(property); left > 0; --left)
        {
          const double value = values_->next(property.type);
          if (value == -1.0)
          {
            strip.clear();
            continue;
          }
          strip.push_back(vertexOf(value));
          addLastOf(strip);
        }
      }
  }

  void addLastOf(const std::vector<std::uint32_t>& strip)
  {
    const std::size_t count = strip.size();
    if (count < 3)
      return;
    std::uint32_t a = strip[count - 3];
    std::uint32_t b = strip[count - 2];
    const std::uint32_t c = strip[count - 1];
    if (a == b || b == c || c == a)
      return;
    if (count % 2 == 0)
      std::swap(a, b);
    polygons_.begin();
    for (const std::uint32_t vertex : {a, b, c})
      polygons_.addCorner(vertex);
  }

  /// Elements that this reader does not know have no surface, unless they name vertices.
  void skipElements(const PlyElement& element)
  {
    if (std::any_of(element.properties.begin(), element.properties.end(), isIndexList))
      throw Error("the element " + inQuotes(element.name) +
                  " cannot be read; only 'face' and 'tristrips' can, so export the model as a polygon mesh");
    if (!element.properties.empty())
      for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties)
          skip(property);
  }

  static const PlyProperty& indexList(const PlyElement& element)
  {
    if (std::count_if(element.properties.begin(), element.properties.end(), isIndexList) != 1)
      throw Error("the element '" + element.name + "' does not have one list 'vertex_indices' or 'vertex_index'");
    return *std::find_if(element.properties.begin(), element.properties.end(), isIndexList);
  }

  std::uint64_t length(const PlyProperty& list)
  {
    const double value = values_->next(*list.length_type);
    if (value < 0.0)
      throw Error(values_->place() + ": a list has a negative number of values");
    return static_cast<std::uint64_t>(value);
  }

  std::uint32_t vertexOf(double value) const
  {
    if (!(value >= 0.0 && value <= 0xffffffffU) || value != std::floor(value))
      throw Error(values_->place() + ": a face has a number of a vertex that is negative, too large or not an integer");
    return static_cast<std::uint32_t>(value);
  }

  void skip(const PlyProperty& property)
  {
    if (!property.length_type)
      return values_->skip(property.type);
    for (std::uint64_t left = length(property); left > 0; --left)
      values_->skip(property.type);
  }

  PlyHeader header_;
  std::unique_ptr<PlyValues> values_;
  std::vector<Eigen::Vector3d> vertices_;
  Polygons polygons_;
};
}  // namespace

void readPly(std::string_view content, MeshBuilder& mesh)
{
  PlyReader(content).read(mesh);
}
}  // namespace gpu_planning_scene::core
