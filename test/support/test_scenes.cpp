#include "support/test_scenes.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>

#include <yaml-cpp/yaml.h>

#include "model/real_robots.h"
#include "support/obstacles.h"
#include "tools/acm_generator.h"
#include "tools/srdf_writer.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::uint64_t kObstacleSeed = 1;

const std::string kUr5Prefix = "ur5_";

/// The folder of the problem set that a scene's name ends in.
std::string problemFolder(const std::string& name)
{
  return std::string(GPS_SHARED_DIR) + "/problems/ur5/" + name.substr(kUr5Prefix.size());
}

RealRobot robotOf(const std::string& name)
{
  if (name.rfind(kUr5Prefix, 0) == 0)
  {
    return ur5Robotiq();
  }
  if (name == "wam")
  {
    return wam();
  }
  return name == "drchubo" ? drchubo() : kr5();
}

/// Random states of every variable's full range.
TestScene inFullRanges(const std::string& name, PlanningScene scene)
{
  TestScene made;
  made.name = name;
  for (const Variable& variable : scene.robot->variables())
  {
    made.lower.push_back(variable.lower);
    made.upper.push_back(variable.upper);
  }
  made.scene = std::make_shared<const PlanningScene>(std::move(scene));
  return made;
}

/// Random states within `reach` of `center`, as far as the limits allow.
void limitTo(const std::vector<double>& center, double reach, TestScene& scene)
{
  for (std::size_t i = 0; i < center.size(); ++i)
  {
    scene.lower[i] = std::max(scene.lower[i], center[i] - reach);
    scene.upper[i] = std::min(scene.upper[i], center[i] + reach);
  }
}

/// The goal of a motion request, near the obstacles; other variables at their default.
std::vector<double> goalOf(const std::string& request_file, const RobotModel& robot)
{
  std::vector<double> state = robot.defaultState();
  for (const auto& joint : YAML::LoadFile(request_file)["goal_constraints"][0]["joint_constraints"])
  {
    state.at(robot.variableIndex(joint["joint_name"].as<std::string>())) = joint["position"].as<double>();
  }
  return state;
}

/// The robot with the SRDF that generate_acm writes for it: of robots without one, more than adjacent links collide
/// always.
std::shared_ptr<const RobotModel> loadWithGeneratedSrdf(const RealRobot& robot)
{
  SamplingOptions sampling;
  sampling.samples = 2000;
  const auto bare = robot.load();
  const std::string srdf = srdfWith(generateMatrix(bare, sampling), *bare, sampling, "");
  RobotModelOptions options;
  options.packages = packageResolver(robot.packages);
  options.urdf_folder = std::filesystem::path(robot.urdf).parent_path();
  return RobotModel::fromXml(robot.urdfText(), srdf, options);
}

TestScene load(const std::string& name)
{
  const RealRobot robot = robotOf(name);
  if (name.rfind(kUr5Prefix, 0) == 0)
  {
    const std::string folder = problemFolder(name);
    const auto model = robot.load();
    TestScene made = inFullRanges(name, loadSceneFile(folder + "/scene0001.yaml", model, {}));
    limitTo(goalOf(folder + "/request0001.yaml", *model), 0.7, made);
    return made;
  }
  if (name == "drchubo")
  {
    PlanningScene scene(loadWithGeneratedSrdf(robot));
    scene.objects = generateObstacles({12, {0.0, 0.0, 0.0}, 0.5, 0.9, 0.3}, kObstacleSeed);
    TestScene made = inFullRanges(name, scene);
    limitTo(scene.robot->defaultState(), 0.5, made);
    return made;
  }
  if (name == "wam")
  {
    PlanningScene scene(loadWithGeneratedSrdf(robot));
    scene.objects = generateObstacles({12, {0.0, 0.0, 0.6}, 0.5, 0.9, 0.3}, kObstacleSeed);
    return inFullRanges(name, scene);
  }
  PlanningScene scene(robot.load());
  scene.objects = name == "kr5" ? generateObstacles({24, {0.0, 0.0, 0.6}, 0.3, 0.7, 0.3}, kObstacleSeed)
                                : generateObstacles({400, {0.0, 0.0, 0.6}, 0.6, 4.0, 0.2}, kObstacleSeed);
  return inFullRanges(name, scene);
}
}  // namespace

std::vector<double> TestScene::randomStates(std::size_t count, std::uint64_t seed) const
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> states;
  states.reserve(count * lower.size());
  for (std::size_t i = 0; i < count; ++i)
  {
    for (std::size_t v = 0; v < lower.size(); ++v)
    {
      states.push_back(lower[v] + (upper[v] - lower[v]) * share(generator));
    }
  }
  return states;
}

const std::vector<std::string>& testSceneNames()
{
  static const std::vector<std::string> names = {"kr5",
                                                 "kr5_crowded",
                                                 "wam",
                                                 "drchubo",
                                                 "ur5_bookshelf_small",
                                                 "ur5_bookshelf_tall",
                                                 "ur5_bookshelf_thin",
                                                 "ur5_box",
                                                 "ur5_cage",
                                                 "ur5_table_pick",
                                                 "ur5_table_under_pick"};
  return names;
}

std::string missingFor(const std::string& name)
{
  const RealRobot robot = robotOf(name);
  if (!robot.available())
  {
    return robot.urdf;
  }
  if (name.rfind(kUr5Prefix, 0) == 0)
  {
    return std::filesystem::exists(problemFolder(name)) ? "" : problemFolder(name);
  }
  return "";
}

const TestScene& testScene(const std::string& name)
{
  static std::map<std::string, TestScene> loaded;
  const auto known = loaded.find(name);
  return known != loaded.end() ? known->second : loaded.emplace(name, load(name)).first->second;
}
}  // namespace gpu_planning_scene
