#include "support/test_scenes.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>

#include "model/real_robots.h"
#include "support/obstacles.h"
#include "support/sampled_matrix.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::uint64_t kObstacleSeed = 1;
constexpr std::uint64_t kMatrixSeed = 2;

const std::string kUr5Prefix = "ur5_";

std::string ur5SceneFile(const std::string& set)
{
  return std::string(GPS_SHARED_DIR) + "/problems/ur5/" + set + "/scene0001.yaml";
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

void limitToAroundNominal(double reach, TestScene& scene)
{
  const std::vector<double> nominal = scene.scene->robot->defaultState();
  for (std::size_t i = 0; i < nominal.size(); ++i)
  {
    scene.lower[i] = std::max(scene.lower[i], nominal[i] - reach);
    scene.upper[i] = std::min(scene.upper[i], nominal[i] + reach);
  }
}

/// For a robot without an SRDF of which more than adjacent links always collide.
void allowPairsOfRandomStates(TestScene& scene)
{
  PlanningScene with_matrix = *scene.scene;
  allowSampledPairs(scene.randomStates(500, kMatrixSeed), with_matrix);
  scene.scene = std::make_shared<const PlanningScene>(std::move(with_matrix));
}

TestScene load(const std::string& name)
{
  const auto robot = robotOf(name).load();
  if (name.rfind(kUr5Prefix, 0) == 0)
  {
    return inFullRanges(name, loadSceneFile(ur5SceneFile(name.substr(kUr5Prefix.size())), robot, {}));
  }
  PlanningScene scene(robot);
  if (name == "kr5")
  {
    scene.objects = generateObstacles({12, {0.0, 0.0, 0.6}, 0.5, 0.9, 0.3}, kObstacleSeed);
    return inFullRanges(name, scene);
  }
  if (name == "kr5_crowded")
  {
    scene.objects = generateObstacles({400, {0.0, 0.0, 0.6}, 0.6, 4.0, 0.2}, kObstacleSeed);
    return inFullRanges(name, scene);
  }
  if (name == "wam")
  {
    scene.objects = generateObstacles({12, {0.0, 0.0, 0.6}, 0.5, 0.9, 0.3}, kObstacleSeed);
    TestScene made = inFullRanges(name, scene);
    allowPairsOfRandomStates(made);
    return made;
  }
  scene.objects = generateObstacles({12, {0.0, 0.0, 0.0}, 0.5, 0.9, 0.3}, kObstacleSeed);
  TestScene made = inFullRanges(name, scene);
  limitToAroundNominal(0.5, made);
  allowPairsOfRandomStates(made);
  return made;
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
    const std::string file = ur5SceneFile(name.substr(kUr5Prefix.size()));
    return std::filesystem::exists(file) ? "" : file;
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
