#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "scene/changes/matrix_entries.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/files/scene_text_file.h"

namespace gpu_planning_scene::core
{
namespace
{
/// `folder`: start of the relative paths of mesh files.
PlanningScene sceneFromYaml(const YamlValue& file, const std::string& folder, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings,
                            const MeshAccess& meshes, const SceneDefaults& defaults)
{
  refuseMisspeltKeys(file, SceneMap::Scene);
  if (!hasKnownKey(file, SceneMap::Scene))
    file.fail("not a planning scene: it has no 'world', 'robot_state' or 'allowed_collision_matrix'");
  checkKeys(file, SceneMap::Scene, warnings);
  const YamlValue* is_diff = file.find("is_diff");
  if (is_diff && is_diff->boolean())
    is_diff->fail("this is a difference to another scene (is_diff: true); a full scene is needed");

  SceneReader reader{*robot, packages, folder, warnings, defaults};
  reader.meshes = meshes;
  reader.mesh_files = MeshCache(meshes.read);
  PlanningScene scene(robot, defaults);
  const YamlValue* robot_name = file.find("robot_model_name");
  if (robot_name && !robot_name->text().empty() && robot_name->text() != robot->name())
    reader.warn(robot_name->where() + ": the scene is for robot '" + robot_name->text() + "', the robot is '" +
                robot->name() + "'");
  if (const YamlValue* name = file.find("name"))
    scene.name = name->text();
  if (const YamlValue* state = file.find("robot_state"))
    reader.state = readRobotState(*state, reader);
  if (const YamlValue* frames = file.find("fixed_frame_transforms"))
    for (const YamlValue& frame : frames->items())
      readFixedFrame(frame, reader);
  if (const YamlValue* matrix = file.find("allowed_collision_matrix"))
  {
    if (readMatrix(*matrix, reader, scene.allowed_collisions))
    {
      scene.matrix_source = MatrixSource::SceneFile;
      for (const std::string& warning : warningsOfMatrix(*robot, scene.allowed_collisions))
        reader.warn(matrix->where() + ": " + warning);
    }
    else
      reader.warn(matrix->where() + ": the allowed_collision_matrix is empty; the robot's own is kept");
  }
  scene.link_padding = readLinkPadding(file, reader);
  scene.setLinkScale(readLinkScale(file, reader));
  scene.robot = scene.robot->withSolids(readLinkSolids(file, reader));
  scene.colors = readColors(file, reader);
  scene.fixed_frames = reader.fixed_frames;
  scene.fixed_frames.erase(robot->planningFrame());
  readObjects(file, reader, scene);
  readOctomap(file, reader, scene);
  if (const YamlValue* allowed = file.find("allowed_collisions"))
    addAllowedCollisions(*allowed, reader, scene);
  scene.current_state = reader.state;
  scene.base_is_default = reader.leaves_out_base && !reader.has_link_frames;
  if (reader.leaves_out_base && reader.has_link_frames)
    reader.warn(file.where() + ": the robot is taken to stand at the origin of frame '" + robot->planningFrame() +
                "', because the file places objects relative to links; set the virtual joint in robot_state if it "
                "stands elsewhere");
  return scene;
}

/// Whether a path or name is that of a file in the text format of RViz's plugin.
bool isSceneText(const std::string& path)
{
  const std::string extension = ".scene";
  return path.size() >= extension.size() &&
         path.compare(path.size() - extension.size(), extension.size(), extension) == 0;
}
}  // namespace

void SceneReader::warn(const std::string& line) const
{
  if (warnings)
    warnings->push_back(line);
}

PlanningScene loadSceneFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                            const PackageResolver& packages, std::vector<std::string>* warnings,
                            const MeshAccess& meshes, const SceneDefaults& defaults)
{
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  try
  {
    return isSceneText(path) ? loadSceneTextFile(path, std::move(robot), defaults)
                             : sceneFromYaml(YamlValue::loadFile(path), folder, std::move(robot), packages, warnings,
                                             meshes, defaults);
  }
  catch (const Error& error)
  {
    throw Error(onOneLine(error.what()));
  }
}

PlanningScene loadSceneText(const std::string& text, const std::string& name, const std::string& folder,
                            std::shared_ptr<const RobotModel> robot, const PackageResolver& packages,
                            std::vector<std::string>* warnings, const MeshAccess& meshes, const SceneDefaults& defaults)
{
  try
  {
    return isSceneText(name) ? readSceneText(text, name, std::move(robot), defaults)
                             : sceneFromYaml(YamlValue::fromText(text, name), folder, std::move(robot), packages,
                                             warnings, meshes, defaults);
  }
  catch (const Error& error)
  {
    throw Error(onOneLine(error.what()));
  }
}
}  // namespace gpu_planning_scene::core
