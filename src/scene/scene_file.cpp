#include <algorithm>
#include <cctype>
#include <set>

#include "gpu_planning_scene/error.h"
#include "scene/scene_reader.h"

namespace gpu_planning_scene
{
namespace
{
/// ROS writes the message's zeros where an object's pose was never set; that pose means "none".
bool isUnsetPose(const YamlValue& value)
{
  for (const char* key : {"position", "orientation"})
  {
    const YamlValue* part = value.find(key);
    if (!part || part->kind() != YamlValue::Kind::Map)
      return false;
    for (const auto& member : part->members())
      if (member.second.number() != 0.0)
        return false;
  }
  return true;
}

void requireAdd(const YamlValue& object)
{
  const YamlValue* operation = object.find("operation");
  if (!operation)
    return;
  std::string name = operation->text();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name != "0" && name != "add")
    operation->fail("operation " + operation->text() +
                    " in a scene file; it describes a full scene, so objects can only " + "be added (0)");
}

WorldObject readObject(const YamlValue& value, SceneReader& reader)
{
  value.warnOfUnknownKeys({"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses",
                           "planes", "plane_poses", "subframe_names", "subframe_poses", "operation"},
                          reader.warnings);
  refuseUnsupportedInObject(value, reader);
  requireAdd(value);
  WorldObject object;
  object.id = value.at("id").text();
  if (object.id.empty())
    value.fail("an object without an id");
  object.pose = readFrame(value.find("header"), reader);
  const YamlValue* pose = value.find("pose");
  if (pose && isUnsetPose(*pose))
    reader.warn(pose->where() + ": the pose of object '" + object.id + "' was never set; taken as no displacement");
  else if (pose)
    object.pose = object.pose * readPose(*pose);
  object.shapes = readShapes(value, reader);
  if (object.shapes.empty())
    value.fail("object '" + object.id + "' has no shapes");
  return object;
}

std::vector<WorldObject> readObjects(const YamlValue& scene, SceneReader& reader)
{
  std::vector<WorldObject> objects;
  const YamlValue* world = scene.find("world");
  if (!world)
    return objects;
  world->warnOfUnknownKeys({"collision_objects", "octomap"}, reader.warnings);
  const YamlValue* values = world->find("collision_objects");
  if (!values)
    return objects;
  std::set<std::string> ids;
  for (const YamlValue& value : values->items())
  {
    objects.push_back(readObject(value, reader));
    const std::string& id = objects.back().id;
    if (!ids.insert(id).second)
      value.fail("object '" + id + "' is given twice");
    if (reader.robot.linkIndex(id) >= 0)
      value.fail("object '" + id + "' has the name of a link");
  }
  return objects;
}
}  // namespace

PlanningScene loadSceneFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings)
{
  const YamlValue file = YamlValue::loadFile(path);
  static const std::initializer_list<const char*> known_keys = {"name",
                                                                "robot_state",
                                                                "robot_model_name",
                                                                "fixed_frame_transforms",
                                                                "allowed_collision_matrix",
                                                                "link_padding",
                                                                "link_scale",
                                                                "object_colors",
                                                                "world",
                                                                "is_diff"};
  if (std::none_of(known_keys.begin(), known_keys.end(), [&](const char* key) { return file.find(key) != nullptr; }))
    file.fail("not a planning scene: none of 'world', 'robot_state', 'allowed_collision_matrix' is here");
  file.warnOfUnknownKeys(known_keys, warnings);
  const YamlValue* is_diff = file.find("is_diff");
  if (is_diff && is_diff->boolean())
    is_diff->fail("this is a difference to another scene (is_diff: true); a full scene is needed");
  refuseUnsupported(file);

  const std::size_t slash = path.rfind('/');
  SceneReader reader{*robot, packages, slash == std::string::npos ? "." : path.substr(0, slash + 1), warnings};
  PlanningScene scene(robot);
  const YamlValue* robot_name = file.find("robot_model_name");
  if (robot_name && !robot_name->text().empty() && robot_name->text() != robot->name())
    reader.warn(robot_name->where() + ": the scene is for robot '" + robot_name->text() + "', the robot is '" +
                robot->name() + "'");
  if (const YamlValue* state = file.find("robot_state"))
    reader.state = readRobotState(*state, reader);
  if (const YamlValue* frames = file.find("fixed_frame_transforms"))
    for (const YamlValue& frame : frames->items())
      readFixedFrame(frame, reader);
  if (const YamlValue* matrix = file.find("allowed_collision_matrix"))
  {
    if (readMatrix(*matrix, reader, scene.allowed_collisions))
      scene.matrix_source = MatrixSource::SceneFile;
    else
      reader.warn(matrix->where() + ": the allowed_collision_matrix is empty; the robot's own is kept");
  }
  scene.objects = readObjects(file, reader);
  scene.current_state = reader.state;
  return scene;
}
}  // namespace gpu_planning_scene
