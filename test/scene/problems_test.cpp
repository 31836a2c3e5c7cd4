// The 140 motion planning problems of MotionBenchMaker ("Data that is not in the repository" in CONTRIBUTING.md): every
// scene loads, every start and goal is free.

#include <algorithm>
#include <filesystem>
#include <optional>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::filesystem::path kShared = GPS_SHARED_DIR;

std::shared_ptr<const RobotModel> ur5()
{
  const std::string folder = kShared / "robots/ur5_robotiq";
  RobotModelOptions options;
  options.packages = packageResolver({{"ur5_robotiq", folder}});
  static const auto robot = RobotModel::fromFiles(folder + "/urdf/ur5.urdf", folder + "/srdf/ur5.srdf", options);
  return robot;
}

std::vector<std::filesystem::path> sceneFiles()
{
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kShared / "problems"))
    if (entry.path().filename().string().rfind("scene", 0) == 0)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Sets a joint value of the request in a state. Joints that the robot lacks are ignored.
std::vector<double> with(std::vector<double> state, const RobotModel& robot, const std::string& joint, double value)
{
  const int variable = robot.variableIndex(joint);
  if (variable >= 0)
    state[variable] = value;
  return state;
}

std::vector<double> startOf(const YAML::Node& request, std::vector<double> state, const RobotModel& robot)
{
  const YAML::Node joints = request["start_state"]["joint_state"];
  for (std::size_t i = 0; i < joints["name"].size(); ++i)
    state = with(state, robot, joints["name"][i].as<std::string>(), joints["position"][i].as<double>());
  return state;
}

std::vector<double> goalOf(const YAML::Node& request, std::vector<double> state, const RobotModel& robot)
{
  for (const auto& joint : request["goal_constraints"][0]["joint_constraints"])
    state = with(state, robot, joint["joint_name"].as<std::string>(), joint["position"].as<double>());
  return state;
}

TEST(Problems, EveryStartAndGoalIsFree)
{
  if (!std::filesystem::exists(kShared / "problems"))
    GTEST_SKIP() << "needs " << kShared / "problems";
  const auto robot = ur5();
  const auto files = sceneFiles();
  EXPECT_EQ(140u, files.size());
  std::optional<CpuChecker> checker;  // one checker for all scenes, so that the robot's trees are built once
  for (const auto& file : files)
  {
    SCOPED_TRACE(file);
    const auto scene = std::make_shared<const PlanningScene>(loadSceneFile(file, robot, {}));
    EXPECT_EQ(robot->variables().size(), scene->current_state.size());
    EXPECT_GE(scene->objects.size(), 5u);
    EXPECT_EQ(MatrixSource::SceneFile, scene->matrix_source);

    std::string request_name = file.filename();
    request_name.replace(0, 5, "request");
    const YAML::Node request = YAML::LoadFile(file.parent_path() / request_name);
    const std::vector<double> start = startOf(request, scene->current_state, *robot);
    std::vector<double> states = start;
    const std::vector<double> goal = goalOf(request, start, *robot);
    states.insert(states.end(), goal.begin(), goal.end());

    if (checker)
      checker->setScene(scene);
    else
      checker.emplace(scene);
    const BatchResult result = checker->check(states.data(), 2);
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(result.valid[i]) << (i == 0 ? "start: " : "goal: ") << scene->bodyName(result.colliding[i][0])
                                   << " hits " << scene->bodyName(result.colliding[i][1]);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
