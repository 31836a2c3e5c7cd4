#include "support/planning_problems.h"

#include <algorithm>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "gpu_planning_scene/error.h"
#include "model/real_robots.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const RobotModel> robot()
{
  static const std::shared_ptr<const RobotModel> model = ur5Robotiq().load();
  return model;
}

/// Ignores joints that the robot lacks or that are fixed, because the files name them.
void setVariable(const RobotModel& model, const std::string& name, double value, std::vector<double>& row)
{
  const int variable = model.variableIndex(name);
  if (variable >= 0)
    row[static_cast<std::size_t>(variable)] = value;
}
}  // namespace

std::string planningProblemFolder()
{
  return problemFolder("");
}

std::vector<std::string> planningProblemNames()
{
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(planningProblemFolder()))
    return names;
  for (const auto& set : std::filesystem::directory_iterator(planningProblemFolder()))
    for (const auto& file : std::filesystem::directory_iterator(set.path()))
    {
      const std::string stem = file.path().stem();
      constexpr char kRequest[] = "request";
      if (stem.rfind(kRequest, 0) == 0)
        names.push_back(set.path().filename().string() + "/" + stem.substr(sizeof(kRequest) - 1));
    }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> chosenPlanningProblems(std::size_t max)
{
  const std::vector<std::string> all = planningProblemNames();
  if (all.empty())
    throw Error("there are no problems in " + planningProblemFolder() +
                "; CONTRIBUTING.md (Data that is not in the repository) names their source");
  const std::size_t count = std::min(max, all.size());
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

PlanningProblem loadPlanningProblem(const std::string& name)
{
  const std::size_t slash = name.find('/');
  const std::string folder = problemFolder(name.substr(0, slash)) + "/";
  const std::string number = name.substr(slash + 1);
  PlanningProblem problem;
  problem.name = name;
  problem.scene = std::make_shared<const PlanningScene>(
      loadSceneFile(folder + "scene" + number + ".yaml", robot(), packageResolver(ur5Robotiq().packages)));
  const std::string path = folder + "request" + number + ".yaml";
  try
  {
    const YAML::Node request = YAML::LoadFile(path);
    problem.group = request["group_name"].as<std::string>();
    const YAML::Node joints = request["start_state"]["joint_state"];
    problem.start = robot()->defaultState();
    for (std::size_t i = 0; i < joints["name"].size(); ++i)
      setVariable(*robot(), joints["name"][i].as<std::string>(), joints["position"][i].as<double>(), problem.start);
    problem.goal = problem.start;
    for (const YAML::Node& constraint : request["goal_constraints"][0]["joint_constraints"])
      setVariable(*robot(), constraint["joint_name"].as<std::string>(), constraint["position"].as<double>(),
                  problem.goal);
  }
  catch (const YAML::Exception& error)
  {
    throw Error(path + ": " + error.what());
  }
  return problem;
}
}  // namespace gpu_planning_scene::core
