#include "model/meshes/collada_geometry.h"

#include <algorithm>

// COLLADA 1.4.1, chapter 5: <mesh>, <source>, <accessor>, <triangles>, <polylist>, <polygons>, <tristrips>, <trifans>.
namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;
using Corners = std::vector<Eigen::Vector3d>;

/// The places of X, Y and Z in the stride of an accessor. The specification leaves out values without a name.
std::array<std::size_t, 3> axesOf(const XMLElement& accessor)
{
  std::array<std::size_t, 3> axes{};
  std::array<int, 3> found{};
  std::size_t place = 0;
  for (const auto* param = accessor.FirstChildElement("param"); param != nullptr;
       param = param->NextSiblingElement("param"), ++place)
    if (const char* name = param->Attribute("name");
        name != nullptr && name[0] >= 'X' && name[0] <= 'Z' && name[1] == 0)
    {
      axes[static_cast<std::size_t>(name[0] - 'X')] = place;
      ++found[static_cast<std::size_t>(name[0] - 'X')];
    }
  if (found != std::array<int, 3>{1, 1, 1})
    failAt(accessor, "its <param> elements do not name X, Y and Z once each");
  return axes;
}

Corners pointsOf(const ColladaDocument& document, const XMLElement& source)
{
  const XMLElement& accessor = onlyChild(onlyChild(source, "technique_common"), "accessor");
  const XMLElement& array = document.target(accessor, "source", "float_array");
  const std::vector<double> values = numbersOf(array);
  if (countOf(array, "count") != values.size())
    failAt(array, "it has " + std::to_string(values.size()) + " numbers, but its count says " +
                      std::to_string(countOf(array, "count")));
  const std::size_t stride = countOf(accessor, "stride", 1);
  const std::size_t offset = countOf(accessor, "offset", 0);
  const std::array<std::size_t, 3> axes = axesOf(accessor);
  if (*std::max_element(axes.begin(), axes.end()) >= stride)
    failAt(accessor, "its stride is smaller than the number of its <param> elements");
  const std::size_t count = countOf(accessor, "count");
  if (count > 0 && (offset > values.size() || count > (values.size() - offset) / stride))
    failAt(accessor, "it reads more numbers than its <float_array> has");
  Corners points;
  points.reserve(count);
  for (std::size_t at = offset; points.size() < count; at += stride)
    points.emplace_back(values[at + axes[0]], values[at + axes[1]], values[at + axes[2]]);
  return points;
}

/// Reads one <triangles>, <polylist> or other primitive.
class PrimitiveReader
{
 public:
  PrimitiveReader(const XMLElement& primitive, const Corners& points, MeshBuilder& mesh)
    : primitive_(primitive), points_(points), mesh_(mesh)
  {
    vertex_offset_ = countOf(onlyInput(primitive, "VERTEX"), "offset", 0);
    for (const auto* input = primitive.FirstChildElement("input"); input != nullptr;
         input = input->NextSiblingElement("input"))
      stride_ = std::max(stride_, countOf(*input, "offset", 0) + 1);
  }

  void readTriangles()
  {
    const Corners corners = allCorners();
    requireCount(corners.size() / 3);
    if (corners.size() % 3 != 0)
      failAt(primitive_, "its last triangle lacks corners");
    for (std::size_t i = 0; i < corners.size(); i += 3)
      mesh_.addPolygon(
          {corners.begin() + static_cast<std::ptrdiff_t>(i), corners.begin() + static_cast<std::ptrdiff_t>(i) + 3});
  }

  void readPolylist()
  {
    const std::vector<std::int64_t> sizes = integersOf(onlyChild(primitive_, "vcount"));
    requireCount(sizes.size());
    const Corners corners = allCorners();
    auto begin = corners.begin();
    for (const std::int64_t size : sizes)
    {
      if (size < 0 || size > corners.end() - begin)
        failAt(primitive_, "its <vcount> names more corners than <p> has");
      add({begin, begin + size});
      begin += size;
    }
    if (begin != corners.end())
      failAt(primitive_, "its <p> has more corners than <vcount> names");
  }

  void readPolygons()
  {
    std::size_t count = 0;
    forEachChild(primitive_,
                 [&](const XMLElement& child)
                 {
                   const std::string_view name = child.Name();
                   if (name == "p")
                     add(cornersOf(child));
                   else if (name == "ph")
                     addWithHoles(child);
                   count += name == "p" || name == "ph" ? 1 : 0;
                 });
    requireCount(count);
  }

  /// Calls `read_strip` for the corners of each <p>.
  void readStrips(void (*read_strip)(const Corners& strip, PrimitiveReader& reader))
  {
    std::size_t count = 0;
    for (const auto* p = primitive_.FirstChildElement("p"); p != nullptr; p = p->NextSiblingElement("p"), ++count)
      read_strip(cornersOf(*p), *this);
    requireCount(count);
  }

  /// Triangles with equal corners only join parts of a strip.
  void addTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
  {
    if (a != b && b != c && c != a)
      mesh_.addPolygon({a, b, c});
  }

 private:
  void requireCount(std::size_t count) const
  {
    if (countOf(primitive_, "count") != count)
      failAt(primitive_, "it has " + std::to_string(count) + " polygons or strips, but its count says " +
                             std::to_string(countOf(primitive_, "count")));
  }

  void add(const Corners& polygon)
  {
    if (polygon.size() >= 3)  // fewer corners are a point or a line
      mesh_.addPolygon(polygon);
  }

  void addWithHoles(const XMLElement& element)
  {
    Corners corners = cornersOf(onlyChild(element, "p"));
    if (corners.size() < 3)
      failAt(element, "its outline has fewer than 3 corners");
    std::vector<std::uint32_t> hole_starts;
    for (const auto* hole = element.FirstChildElement("h"); hole != nullptr; hole = hole->NextSiblingElement("h"))
    {
      hole_starts.push_back(static_cast<std::uint32_t>(corners.size()));
      const Corners inner = cornersOf(*hole);
      corners.insert(corners.end(), inner.begin(), inner.end());
    }
    mesh_.addPolygon(corners, hole_starts);
  }

  /// A primitive without polygons may have no <p>.
  Corners allCorners() const
  {
    return primitive_.FirstChildElement("p") == nullptr ? Corners() : cornersOf(onlyChild(primitive_, "p"));
  }

  Corners cornersOf(const XMLElement& p) const
  {
    const std::vector<std::int64_t> indices = integersOf(p);
    if (indices.size() % stride_ != 0)
      failAt(p,
             "it has " + std::to_string(indices.size()) + " indices, and each corner needs " + std::to_string(stride_));
    Corners corners;
    for (std::size_t i = vertex_offset_; i < indices.size(); i += stride_)
    {
      if (indices[i] < 0 || indices[i] >= static_cast<std::int64_t>(points_.size()))
        failAt(p, "it names vertex " + std::to_string(indices[i]) + ", but there are " +
                      std::to_string(points_.size()) + " vertices");
      corners.push_back(points_[static_cast<std::size_t>(indices[i])]);
    }
    return corners;
  }

  const XMLElement& primitive_;
  const Corners& points_;
  MeshBuilder& mesh_;
  std::size_t vertex_offset_ = 0;
  std::size_t stride_ = 1;  // indices of a corner
};

/// Triangle i has the corners i, i + 1 and i + 2, and each second one turns around.
void readStrip(const Corners& strip, PrimitiveReader& reader)
{
  for (std::size_t i = 2; i < strip.size(); ++i)
    if (i % 2 == 0)
      reader.addTriangle(strip[i - 2], strip[i - 1], strip[i]);
    else
      reader.addTriangle(strip[i - 1], strip[i - 2], strip[i]);
}

void readFan(const Corners& fan, PrimitiveReader& reader)
{
  for (std::size_t i = 2; i < fan.size(); ++i)
    reader.addTriangle(fan[0], fan[i - 1], fan[i]);
}
}  // namespace

void ColladaGeometries::add(const XMLElement& geometry, MeshBuilder& mesh)
{
  forEachChild(
      geometry,
      [&](const XMLElement& child)
      {
        const std::string_view name = child.Name();
        if (name == "mesh")
          forEachChild(
              child, [&](const XMLElement& part) { addPrimitive(part, mesh); });
        else if (name != "asset" && name != "extra" && name != "spline")  // a spline has no surface
          failAt(child, "it cannot be read; only <mesh> can, so export the model as a polygon mesh");
      });
}

void ColladaGeometries::addPrimitive(const XMLElement& element, MeshBuilder& mesh)
{
  const std::string_view name = element.Name();
  if (name == "source" || name == "vertices" || name == "extra" || name == "lines" || name == "linestrips")
    return;  // no surface
  if (element.FirstChildElement("input") == nullptr && countOf(element, "count", 0) == 0)
    return;  // some programs write a primitive without polygons
  PrimitiveReader reader(element, vertices(element), mesh);
  if (name == "triangles")
    reader.readTriangles();
  else if (name == "polylist")
    reader.readPolylist();
  else if (name == "polygons")
    reader.readPolygons();
  else if (name == "tristrips")
    reader.readStrips(readStrip);
  else if (name == "trifans")
    reader.readStrips(readFan);
  else
    failAt(element, "it cannot be read");
}

const Corners& ColladaGeometries::vertices(const XMLElement& primitive)
{
  const XMLElement& vertices = document_.target(onlyInput(primitive, "VERTEX"), "source", "vertices");
  const XMLElement& source = document_.target(onlyInput(vertices, "POSITION"), "source", "source");
  const auto known = points_.find(&source);
  return known != points_.end() ? known->second : points_.emplace(&source, pointsOf(document_, source)).first->second;
}
}  // namespace gpu_planning_scene::core
