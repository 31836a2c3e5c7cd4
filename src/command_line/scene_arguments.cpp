#include "command_line/scene_arguments.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/text/parse_number.h"
#include "command_line/robot_arguments.h"

namespace gpu_planning_scene::core
{
std::vector<Option> sceneOptions()
{
  return {{"--scene", "FILE",
           "the planning scene, YAML with MoveIt's field names;\nwithout it, the scene has only the robot"},
          {"--object", "ID=FILE[,POSE]",
           "a mesh file as a further object; FILE is a path or\npackage://NAME/PATH; POSE is x,y,z or "
           "x,y,z,qx,qy,qz,qw in the\nplanning frame; can be repeated",
           true}};
}

std::vector<double> numbersFrom(const std::string& option, const std::string& text, std::size_t count)
{
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
  {
    const auto number = parseNumber(word);
    if (!number || !std::isfinite(*number))
      throw UsageError(option + ": '" + word + "' is not a finite number");
    numbers.push_back(*number);
  }
  if (numbers.size() != count)
    throw UsageError(option + ": '" + text + "' must be " + std::to_string(count) + " numbers, separated by commas");
  return numbers;
}

WorldObject objectFrom(const std::string& text, const PackageResolver& packages)
{
  const std::size_t equals = text.find('=');
  const std::size_t comma = std::min(text.find(',', equals == std::string::npos ? 0 : equals), text.size());
  if (equals == std::string::npos || equals == 0 || equals + 1 >= comma)
    throw UsageError("--object: '" + text + "' is not ID=FILE[,x,y,z[,qx,qy,qz,qw]]");
  WorldObject object;
  object.id = text.substr(0, equals);
  if (comma < text.size())
  {
    const std::string pose = text.substr(comma + 1);
    const bool has_rotation = std::count(pose.begin(), pose.end(), ',') > 2;
    const std::vector<double> values = numbersFrom("--object", pose, has_rotation ? 7 : 3);
    object.pose.translation() = Eigen::Vector3d(values.data());
    if (has_rotation)
    {
      const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
      if (rotation.norm() == 0.0)
        throw UsageError("--object: the quaternion is zero; the identity is 0,0,0,1");
      object.pose.linear() = rotation.normalized().toRotationMatrix();
    }
  }
  const std::string file = text.substr(equals + 1, comma - equals - 1);
  const std::string path = file.find("://") == std::string::npos ? file : resolveUri(file, "", packages);
  object.shapes.push_back({MeshCache().load(path, Eigen::Vector3d::Ones()), Eigen::Isometry3d::Identity()});
  return object;
}

PlanningScene sceneFrom(const CommandLine& arguments, std::vector<std::string>* warnings)
{
  auto robot = robotFrom(arguments, warnings);
  PlanningScene scene = arguments.has("--scene")
                            ? loadSceneFile(arguments.required("--scene"), robot, packagesFrom(arguments), warnings)
                            : PlanningScene(robot);
  for (const std::string& text : arguments.values("--object"))
    scene.objects.push_back(objectFrom(text, packagesFrom(arguments)));
  return scene;
}
}  // namespace gpu_planning_scene::core
