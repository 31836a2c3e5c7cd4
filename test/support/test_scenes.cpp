#include "support/test_scenes.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <random>

#include <yaml-cpp/yaml.h>

#include "model/real_robots.h"
#include "support/generated_arm.h"
#include "support/obstacles.h"
#include "tools/acm_generator.h"
#include "tools/srdf_writer.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kObstacleSeed = 1;

const std::string kUr5Prefix = "ur5_";
const std::string kPandaPrefix = "panda_";
const std::string kArmPrefix = "arm_";
constexpr std::size_t kArmTriangles = 10000;

bool startsWith(const std::string& name, const std::string& start)
{
  return name.rfind(start, 0) == 0;
}

/// The folder of the problem set whose name follows the prefix of the scene's name.
std::string problemFolderOf(const std::string& name)
{
  return problemFolder(name.substr(kUr5Prefix.size()));
}

RealRobot robotOf(const std::string& name)
{
  if (startsWith(name, kUr5Prefix))
    return ur5Robotiq();
  if (startsWith(name, kPandaPrefix))
    return panda();
  if (name == "wam")
    return wam();
  return startsWith(name, "drchubo") ? drchubo() : kr5();
}

/// A test scene whose random states use the full range of every variable. Floating joints stay where they are: the
/// panda's SRDF has one, although its base stands on the floor.
TestScene inFullRanges(const std::string& name, PlanningScene scene)
{
  TestScene made;
  made.name = name;
  for (const Variable& variable : scene.robot->variables())
  {
    made.lower.push_back(variable.lower);
    made.upper.push_back(variable.upper);
  }
  const std::vector<double> stays = scene.robot->defaultState();
  for (const Joint& joint : scene.robot->joints())
    for (int k = 0; joint.type == JointType::Floating && k < variableCount(joint.type); ++k)
    {
      const std::size_t variable = static_cast<std::size_t>(joint.first_variable) + static_cast<std::size_t>(k);
      made.lower[variable] = made.upper[variable] = stays[variable];
    }
  made.scene = std::make_shared<const PlanningScene>(std::move(scene));
  return made;
}

/// Restricts random states to at most `reach` from `center`, within the limits.
void limitTo(const std::vector<double>& center, double reach, TestScene& scene)
{
  for (std::size_t i = 0; i < center.size(); ++i)
  {
    scene.lower[i] = std::max(scene.lower[i], center[i] - reach);
    scene.upper[i] = std::min(scene.upper[i], center[i] + reach);
  }
}

/// The goal of a motion request, which lies near the obstacles. The other variables have their default values.
std::vector<double> goalOf(const std::string& request_file, const RobotModel& robot)
{
  std::vector<double> state = robot.defaultState();
  for (const auto& joint : YAML::LoadFile(request_file)["goal_constraints"][0]["joint_constraints"])
    state.at(robot.variableIndex(joint["joint_name"].as<std::string>())) = joint["position"].as<double>();
  return state;
}

/// The robot with an SRDF as MoveIt's Setup Assistant makes it: unlike generate_acm, it leaves out pairs that collide
/// in no random state. So it has few pairs, which keeps tests short and benchmarks comparable. Without an SRDF, some
/// pairs of links that are not adjacent collide in every state.
std::shared_ptr<const RobotModel> loadWithGeneratedSrdf(const RealRobot& robot)
{
  GeneratorOptions generator;
  generator.samples = 2000;
  generator.proof_tests = 0;
  const auto bare = robot.load();
  GeneratedMatrix matrix = generateMatrix(bare, generator);
  for (const auto& [first, second] : matrix.unproven)
    matrix.disabled.push_back({first, second, DisabledReason::Never});
  const std::string srdf = srdfWith(matrix, *bare, generator, "");
  RobotModelOptions options;
  options.packages = packageResolver(robot.packages);
  options.urdf_folder = std::filesystem::path(robot.urdf).parent_path();
  return RobotModel::fromXml(robot.urdfText(), srdf, options);
}

/// Models of which several scenes exist are loaded once per process. Generating the matrix of DRC-Hubo takes a while,
/// and checkers share the trees of meshes that are the same object.
std::shared_ptr<const RobotModel> drchuboModel()
{
  static const std::shared_ptr<const RobotModel> model = loadWithGeneratedSrdf(drchubo());
  return model;
}

std::shared_ptr<const RobotModel> ur5Model()
{
  static const std::shared_ptr<const RobotModel> model = ur5Robotiq().load();
  return model;
}

std::shared_ptr<const RobotModel> pandaModel()
{
  static const std::shared_ptr<const RobotModel> model = panda().load();
  return model;
}

std::shared_ptr<const RobotModel> kr5Model()
{
  static const std::shared_ptr<const RobotModel> model = kr5().load();
  return model;
}

const GeneratedArm& generatedArm()
{
  static const GeneratedArm arm(kArmTriangles);
  return arm;
}

TestScene loadUr5(const std::string& name)
{
  const std::string folder = problemFolderOf(name);
  const auto model = ur5Model();
  PlanningScene scene = loadSceneFile(folder + "/scene0001.yaml", model, {});
  scene.name = name;
  TestScene made = inFullRanges(name, std::move(scene));
  limitTo(goalOf(folder + "/request0001.yaml", *model), 0.7, made);
  return made;
}

/// Legs apart, forearms level, fingers half closed. At the default pose most neighbouring links touch.
std::vector<double> atWork(const RobotModel& drchubo)
{
  std::vector<double> state = drchubo.defaultState();
  for (std::size_t i = 0; i < state.size(); ++i)
    if (const std::string& name = drchubo.variables()[i].name; startsWith(name, "LF") || startsWith(name, "RF"))
      state[i] = -0.4;
  for (const auto& [name, value] :
       {std::pair("LHR", 0.2), {"RHR", -0.2}, {"LSR", 0.3}, {"RSR", -0.3}, {"LEP", -1.4}, {"REP", -1.4}})
    state.at(drchubo.variableIndex(name)) = value;
  return state;
}

TestScene loadDrchubo(const std::string& name)
{
  PlanningScene scene(drchuboModel());
  const bool at_work = name != "drchubo";
  scene.objects = name == "drchubo_table"      ? table({0.64, 0.0, -0.36}, {0.6, 1.4, 0.6})
                  : name == "drchubo_corridor" ? corridor({0.0, 0.0, 0.0}, {3.0, 1.1, 2.0})
                                               : generateObstacles({12, {0.0, 0.0, 0.0}, 0.5, 0.9, 0.3}, kObstacleSeed);
  TestScene made = inFullRanges(name, scene);
  limitTo(at_work ? atWork(*scene.robot) : scene.robot->defaultState(), at_work ? 0.25 : 0.5, made);
  return made;
}

/// Converts objects to the frame of KR5's URDF, in which y points up and the robot's foot is at y = -0.5.
std::vector<WorldObject> forKr5(std::vector<WorldObject> objects)
{
  Eigen::Isometry3d upright(Eigen::AngleAxisd(-M_PI / 2.0, Eigen::Vector3d::UnitX()));
  upright.pretranslate(Eigen::Vector3d(0.0, -0.5, 0.0));
  for (WorldObject& object : objects)
    object.pose = upright * object.pose;
  return objects;
}

/// Objects in a frame whose z axis points up and whose origin is the robot's foot.
std::vector<WorldObject> furnitureOf(const std::string& name)
{
  const bool boxes = name != "kr5_shelf" && name != "arm_shelf" && name != "panda_shelf";
  return boxes ? boxesAround({0.0, 0.0, 0.5}, 8, 0.5, 0.3) : shelf({0.5, 0.0, 0.0}, {0.5, 1.4, 1.5}, 4);
}

std::vector<WorldObject> objectsOf(const std::string& name)
{
  const Eigen::Vector3d shoulder(0.0, 0.0, 0.6);
  if (name == "wam")
    return generateObstacles({12, shoulder, 0.5, 0.9, 0.3}, kObstacleSeed);
  if (name == "kr5")
    return generateObstacles({24, shoulder, 0.3, 0.7, 0.3}, kObstacleSeed);
  if (name == "panda_table")
    return table({0.5, 0.0, 0.2}, {0.5, 1.0, 0.3});
  if (name == "kr5_crowded")
    return generateObstacles({400, shoulder, 0.6, 4.0, 0.2}, kObstacleSeed);
  return startsWith(name, "kr5") ? forKr5(furnitureOf(name)) : furnitureOf(name);
}

TestScene load(const std::string& name)
{
  if (startsWith(name, kUr5Prefix))
    return loadUr5(name);
  if (startsWith(name, "drchubo"))
    return loadDrchubo(name);
  PlanningScene scene(name == "arm_driven"             ? generatedArm().loadDriven()
                      : startsWith(name, kArmPrefix)   ? generatedArm().load()
                      : startsWith(name, kPandaPrefix) ? pandaModel()
                      : name == "wam"                  ? loadWithGeneratedSrdf(wam())
                                                       : kr5Model());
  scene.objects = objectsOf(name);
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
    for (std::size_t v = 0; v < lower.size(); ++v)
      states.push_back(lower[v] + (upper[v] - lower[v]) * share(generator));
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

const std::vector<std::string>& benchmarkSceneNames()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> all = testSceneNames();
    for (const char* name : {"kr5_boxes", "kr5_shelf", "drchubo_table", "drchubo_corridor", "arm_boxes", "arm_shelf",
                             "arm_driven", "panda_boxes", "panda_shelf", "panda_table"})
      all.emplace_back(name);
    return all;
  }();
  return names;
}

std::string missingFor(const std::string& name)
{
  if (startsWith(name, kArmPrefix))
    return "";
  const RealRobot robot = robotOf(name);
  if (!robot.available())
    return robot.urdf;
  if (startsWith(name, kUr5Prefix) && !std::filesystem::exists(problemFolderOf(name)))
    return problemFolderOf(name);
  return "";
}

std::shared_ptr<const RobotModel> loadRobotOf(const std::string& name)
{
  if (startsWith(name, kArmPrefix))
    return name == "arm_driven" ? generatedArm().loadDriven() : generatedArm().load();
  return robotOf(name).load();
}

TestScene withPadding(const TestScene& scene, double padding)
{
  TestScene padded = scene;
  PlanningScene changed = *scene.scene;
  changed.link_padding.assign(changed.robot->links().size(), padding);
  padded.scene = std::make_shared<const PlanningScene>(std::move(changed));
  return padded;
}

const TestScene& testScene(std::string_view name)
{
  static std::map<std::string, TestScene, std::less<>> loaded;
  const auto known = loaded.find(name);
  return known != loaded.end() ? known->second : loaded.emplace(name, load(std::string(name))).first->second;
}
}  // namespace gpu_planning_scene::core
