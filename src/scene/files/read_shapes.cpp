#include <algorithm>
#include <cctype>

#include "gpu_planning_scene/error.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The numbers are those of shape_msgs/SolidPrimitive.
PrimitiveType readType(const YamlValue& value)
{
  std::string name = value.text();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name == "box" || name == "1")
    return PrimitiveType::Box;
  if (name == "sphere" || name == "2")
    return PrimitiveType::Sphere;
  if (name == "cylinder" || name == "3")
    return PrimitiveType::Cylinder;
  if (name == "cone" || name == "4")
    return PrimitiveType::Cone;
  value.fail("unknown primitive type '" + value.text() + "'; known are box (1), sphere (2), cylinder (3) and cone (4)");
}

Shape readPrimitive(const YamlValue& value, const SceneReader& reader)
{
  checkKeys(value, SceneMap::Primitive, reader.warnings);
  const YamlValue& dimensions = value.at("dimensions");
  const PrimitiveType type = readType(value.at("type"));
  std::vector<double> numbers;
  for (const YamlValue& item : dimensions.items())
    numbers.push_back(item.number());
  Shape shape;
  try
  {
    shape = primitiveOf(type, numbers);
  }
  catch (const Error& error)
  {
    dimensions.fail(error.what());
  }
  validateShape(shape, dimensions.where());
  return shape;
}

std::array<std::uint32_t, 3> readTriangle(const YamlValue& value, std::size_t vertex_count)
{
  const bool is_map = value.kind() == YamlValue::Kind::Map;
  if (is_map)
    checkKeys(value, SceneMap::Triangle, nullptr);
  const YamlValue& indices = is_map ? value.at("vertex_indices") : value;
  if (indices.items().size() != 3)
    indices.fail("a triangle has three vertex indices");
  std::array<std::uint32_t, 3> triangle;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const long long index = indices.items()[i].integer();
    if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
      indices.items()[i].fail("vertex index " + std::to_string(index) + " is out of range; the mesh has " +
                              std::to_string(vertex_count) + " vertices");
    triangle[i] = static_cast<std::uint32_t>(index);
  }
  return triangle;
}

std::shared_ptr<const Mesh> readInlineMesh(const YamlValue& value, SceneReader& reader)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->name = value.where();
  for (const YamlValue& vertex : value.at("vertices").items())
    mesh->vertices.push_back(readVector(vertex));
  for (const YamlValue& triangle : value.at("triangles").items())
    mesh->triangles.push_back(readTriangle(triangle, mesh->vertices.size()));
  if (mesh->triangles.empty())
    value.fail("the mesh has no triangles");
  for (const auto& known : reader.inline_meshes)
    if (known->triangles == mesh->triangles && known->vertices == mesh->vertices)
      return known;  // equal meshes share one tree
  reader.inline_meshes.push_back(mesh);
  return mesh;
}

/// A mesh: `vertices` and `triangles`, or a `resource` (a URI or path) with an optional `scale`, which robowflex's
/// files call `dimensions`.
std::shared_ptr<const Mesh> readMesh(const YamlValue& value, SceneReader& reader)
{
  checkKeys(value, SceneMap::Mesh, reader.warnings);
  const YamlValue* resource = value.find("resource");
  if (!resource)
    return readInlineMesh(value, reader);
  for (const char* key : {"vertices", "triangles"})
    if (const YamlValue* surplus = value.find(key))
      surplus->fail(std::string("a mesh must not have both 'resource' and '") + key + "'");
  const YamlValue* scale = value.find("scale");
  const YamlValue* dimensions = value.find("dimensions");
  if (scale && dimensions)
    dimensions->fail("a mesh must not have both 'scale' and 'dimensions'");
  if (!scale)
    scale = dimensions;
  try
  {
    const std::string path = reader.meshes.resolve(resource->text(), reader.folder, reader.packages);
    return reader.mesh_files.load(path, scale ? readVector(*scale) : Eigen::Vector3d(1.0, 1.0, 1.0));
  }
  catch (const Error& error)
  {
    resource->fail(error.what());
  }
}

/// The plane a x + b y + c z + d = 0: MoveIt's `coef`, or the bare numbers.
HalfSpace readPlane(const YamlValue& value, const SceneReader&)
{
  const bool is_map = value.kind() == YamlValue::Kind::Map;
  if (is_map)
    checkKeys(value, SceneMap::Plane, nullptr);
  const YamlValue& coefficients = is_map ? value.at("coef") : value;
  const std::vector<double> numbers = coefficients.numbers(4);
  try
  {
    return halfSpaceBehind(Eigen::Vector4d(numbers.data()));
  }
  catch (const Error& error)
  {
    coefficients.fail(error.what());
  }
}

/// Reads one pose per shape. A lone shape needs none.
std::vector<Eigen::Isometry3d> readShapePoses(const YamlValue& object, const char* key, std::size_t count)
{
  std::vector<Eigen::Isometry3d> poses;
  const YamlValue* values = object.find(key);
  if (values)
    for (const YamlValue& value : values->items())
      poses.push_back(readPose(value));
  if (poses.empty() && count == 1)
    poses.push_back(Eigen::Isometry3d::Identity());
  if (poses.size() != count)
    (values ? *values : object)
        .fail(std::to_string(poses.size()) + " " + key + " for " + std::to_string(count) + " shapes");
  return poses;
}
}  // namespace

std::vector<PlacedShape> readShapes(const YamlValue& object, SceneReader& reader)
{
  std::vector<PlacedShape> shapes;
  const auto add = [&](const char* key, const char* poses_key, const auto& read)
  {
    const std::size_t first = shapes.size();
    if (const YamlValue* values = object.find(key))
      for (const YamlValue& value : values->items())
        shapes.push_back({read(value, reader)});
    const auto poses = readShapePoses(object, poses_key, shapes.size() - first);
    for (std::size_t i = 0; i < poses.size(); ++i)
      shapes[first + i].pose = poses[i];
  };
  add("primitives", "primitive_poses", readPrimitive);
  add("meshes", "mesh_poses", readMesh);
  add("planes", "plane_poses", readPlane);
  return shapes;
}
}  // namespace gpu_planning_scene::core
