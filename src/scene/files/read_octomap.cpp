#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "gpu_planning_scene/scene_change.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A file holds at most as many leaves as a scene may have shapes.
const std::size_t kMostLeavesOfFile = SceneLimits().shapes;

std::vector<std::int8_t> readBytes(const YamlValue& value)
{
  std::vector<std::int8_t> bytes;
  bytes.reserve(value.items().size());
  for (const YamlValue& item : value.items())
  {
    const long long byte = item.integer();
    if (byte < -128 || byte > 127)
      item.fail("a byte of an octomap is " + item.text() + "; it must be from -128 to 127");
    bytes.push_back(static_cast<std::int8_t>(byte));
  }
  return bytes;
}

/// MoveIt's message octomap_msgs/Octomap.
SerializedOctree readOctree(const YamlValue& value, const SceneReader& reader)
{
  checkKeys(value, SceneMap::Octomap, reader.warnings);
  frameOf(value.find("header"));  // the frame is that of world.octomap
  SerializedOctree octree;
  const YamlValue* data = value.find("data");
  if (data == nullptr || data->items().empty())
    return octree;
  octree.binary = value.at("binary").boolean();
  octree.id = value.at("id").text();
  octree.resolution = value.at("resolution").number();
  octree.bytes = readBytes(*data);
  return octree;
}

/// Adds the octomap to the scene if it has occupied leaves. `where`: the place of its data in the file.
void addOctomap(const SerializedOctree& octree, const Eigen::Isometry3d& pose, const YamlValue& where,
                SceneReader& reader, PlanningScene& result)
{
  WorldObject object;
  object.id = kOctomapId;
  object.pose = pose;
  object.padding = reader.defaults.object_padding;
  try
  {
    object.shapes = occupiedLeaves(octree, kMostLeavesOfFile);
    for (const PlacedShape& placed : object.shapes)
      validateShape(placed.shape, "octomap");
  }
  catch (const Error& error)
  {
    where.fail(error.what());
  }
  if (!object.shapes.empty())
    result.objects.push_back(std::move(object));
}

SerializedOctree readOctreeFile(const YamlValue& resource, const SceneReader& reader)
{
  try
  {
    return loadOctreeFile(reader.meshes.resolve(resource.text(), reader.folder, reader.packages));
  }
  catch (const Error& error)
  {
    resource.fail(error.what());
  }
}
}  // namespace

void readOctomap(const YamlValue& scene, SceneReader& reader, PlanningScene& result)
{
  const YamlValue* const file = scene.find("octomap");
  if (file != nullptr)
    addOctomap(readOctreeFile(*file, reader), Eigen::Isometry3d::Identity(), *file, reader, result);
  const YamlValue* const world = scene.find("world");
  const YamlValue* const value = world != nullptr ? world->find("octomap") : nullptr;
  if (value == nullptr)
    return;
  checkKeys(*value, SceneMap::OctomapWithPose, reader.warnings);
  const YamlValue* const resource = value->find("resource");
  const YamlValue* const message = value->find("octomap");
  if (resource == nullptr && message == nullptr)
    return;
  if (resource != nullptr && message != nullptr)
    resource->fail("an octomap must not have both 'resource' and 'octomap'");
  const SerializedOctree octree =
      resource != nullptr ? readOctreeFile(*resource, reader) : readOctree(*message, reader);
  if (octree.bytes.empty())
    return;
  if (file != nullptr)
    file->fail("the scene has an octomap already, in 'world'; give one of the two");
  const YamlValue* const origin = value->find("origin");
  const Eigen::Isometry3d pose =
      origin != nullptr && !isUnsetPose(*origin) ? readPose(*origin) : Eigen::Isometry3d::Identity();
  addOctomap(octree, readFrame(value->find("header"), reader) * pose, resource != nullptr ? *resource : *message,
             reader, result);
}
}  // namespace gpu_planning_scene::core
