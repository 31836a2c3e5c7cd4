#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <moveit/planning_interface/planning_interface.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/param.h>
#include <pluginlib/class_list_macros.hpp>

#include "collision/checkers/open_checker.h"
#include "moveit/planner/planning_context.h"
#include "moveit/planner/preparation.h"
#include "moveit/planner/refusal.h"
#include "moveit/planner/request.h"
#include "planners/planner_configs.h"
#include "planners/planner_loader.h"
#include "service/checker_maker.h"

// The planner for MoveIt's plugin loader: see moveit_planner_plugins.xml.
namespace gpu_planning_scene::pipeline
{
namespace
{
using core::PlannerConfigs;
using planning_interface::MotionPlanRequest;
using planning_interface::PlannerConfigurationSettings;

constexpr double kWaypointDistance = 0.1;  // radians or metres: the default of NAMESPACE/waypoint_distance
constexpr double kLeastWaypointDistance = 1e-3;
constexpr int kMostKnownPaths = 1000;

/// The name of a group's planner in MoveIt's map of configurations.
std::string settingsName(const std::string& group, const std::string& config)
{
  return config.empty() ? group : group + "[" + config + "]";
}

core::MakeChecker checkerMakerFor(const std::string& device)
{
  core::BatchCheckerOptions options;
  options.device = device;
  return core::makeCheckers(options, core::openGpuDevice,
                            [](const std::string& warning) { ROS_WARN_STREAM_NAMED(kLogName, warning); });
}

std::string textParameter(const std::string& name, const std::string& fallback)
{
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name, value))
    return fallback;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt)  // roslaunch makes an integer of a text like "0"
    return std::to_string(static_cast<int>(value));
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString)
    throw core::Error("parameter " + name + " must be a text, such as auto or cpu");
  return static_cast<std::string>(value);
}

double waypointDistance(const std::string& name)
{
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name, value))
    return kWaypointDistance;
  const double distance = value.getType() == XmlRpc::XmlRpcValue::TypeDouble ? static_cast<double>(value)
                          : value.getType() == XmlRpc::XmlRpcValue::TypeInt  ? static_cast<int>(value)
                                                                             : std::nan("");
  if (distance != 0.0 && !(distance >= kLeastWaypointDistance && std::isfinite(distance)))
    throw core::Error("parameter " + name + " must be a finite number: 0 or at least " +
                      std::to_string(kLeastWaypointDistance));
  return distance;
}

std::size_t knownPaths(const std::string& name)
{
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name, value))
    return Workshop::kKnownPaths;
  const int count = value.getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(value) : -1;
  if (count < 0 || count > kMostKnownPaths)
    throw core::Error("parameter " + name + " must be an integer from 0 to " + std::to_string(kMostKnownPaths));
  return static_cast<std::size_t>(count);
}

/// The parameters of MoveIt's namespace, with the names and the layout of ompl_planning.yaml.
PlannerConfigs readConfigs(const moveit::core::RobotModel& model, const std::string& name_space)
{
  XmlRpc::XmlRpcValue planners;
  planners.begin();  // makes it a map
  std::vector<std::string> keys = model.getJointModelGroupNames();
  keys.emplace_back("planner_configs");
  for (const std::string& key : keys)
    if (XmlRpc::XmlRpcValue value; ros::param::get(name_space + "/" + key, value))
      planners[key] = value;
  return PlannerConfigs::fromValue(planners, name_space);
}
}  // namespace

/// Makes planning contexts. Reads these parameters of its namespace if ROS is initialised: planner_configs and
/// GROUP/{default_planner_config, planner_configs, projection_evaluator, longest_valid_segment_fraction} as in
/// ompl_planning.yaml, `device` (a device as in BatchCheckerOptions, or "cpu"), `waypoint_distance`, `known_paths`.
class PlannerManager : public planning_interface::PlannerManager
{
 public:
  bool initialize(const moveit::core::RobotModelConstPtr& model, const std::string& name_space) override
  {
    try
    {
      model_ = model;
      std::string device = "auto";
      std::size_t known_paths = Workshop::kKnownPaths;
      if (ros::isInitialized())
      {
        configs_ = readConfigs(*model, name_space);
        device = textParameter(name_space + "/device", device);
        waypoint_distance_ = waypointDistance(name_space + "/waypoint_distance");
        known_paths = knownPaths(name_space + "/known_paths");
      }
      workshop_ = std::make_shared<Workshop>(checkerMakerFor(device), known_paths);
      prepareChecker(*workshop_, model);  // now, so that the first request need not wait for the device
      setPlannerConfigurations(settings());
      return true;
    }
    catch (const std::exception& error)
    {
      ROS_ERROR_STREAM_NAMED(kLogName, error.what());
      return false;
    }
  }

  std::string getDescription() const override { return "gpu_planning_scene"; }

  void getPlanningAlgorithms(std::vector<std::string>& names) const override
  {
    names.clear();
    for (const auto& [name, settings] : config_settings_)
      names.push_back(name);
  }

  planning_interface::PlanningContextPtr getPlanningContext(const planning_scene::PlanningSceneConstPtr& scene,
                                                            const MotionPlanRequest& request,
                                                            moveit_msgs::MoveItErrorCodes& code) const override
  {
    try
    {
      if (!scene)
        throw Refusal(MoveItErrorCodes::FAILURE, "there is no planning scene");
      requireSupported(request, *scene->getRobotModel());
      auto context = std::make_shared<PlanningContext>(request.group_name, choiceFor(request), workshop_);
      context->setPlanningScene(scene);
      context->setMotionPlanRequest(request);
      code.val = MoveItErrorCodes::SUCCESS;
      return context;
    }
    catch (const Refusal& refusal)
    {
      code.val = refusal.code();
      ROS_ERROR_STREAM_NAMED(kLogName, refusal.what());
    }
    catch (const std::exception& error)  // the planner is unknown, or its plugin cannot be loaded
    {
      code.val = MoveItErrorCodes::PLANNING_FAILED;
      ROS_ERROR_STREAM_NAMED(kLogName, error.what());
    }
    return nullptr;
  }

  bool canServiceRequest(const MotionPlanRequest& request) const override
  {
    try
    {
      requireSupported(request, *model_);
      return true;
    }
    catch (const Refusal&)
    {
      return false;
    }
  }

 private:
  /// MoveIt's map of configurations: GROUP has the group's default planner, GROUP[CONFIG] each other one.
  planning_interface::PlannerConfigurationMap settings() const
  {
    planning_interface::PlannerConfigurationMap map;
    for (const std::string& group : model_->getJointModelGroupNames())
    {
      const auto add = [&](const std::string& config)
      {
        const core::PlannerConfig planner = configs_.find(config, group);
        PlannerConfigurationSettings settings{group, settingsName(group, config), planner.parameters};
        settings.config["type"] = planner.type;
        map[settings.name] = settings;
      };
      add("");
      std::vector<std::string> names = configs_.ofGroup(group).configs;
      if (names.empty())
        names = configs_.names();
      for (const std::string& name : names)
        add(name);
    }
    return map;
  }

  /// The planner of a request. `planner_id` is empty, a configuration, GROUP[CONFIG], or the plugin of a planner.
  /// Throws core::Error if it is unknown, and std::runtime_error if the plugin cannot be loaded.
  PlannerChoice choiceFor(const MotionPlanRequest& request) const
  {
    auto found = config_settings_.find(settingsName(request.group_name, request.planner_id));
    if (found == config_settings_.end())
      found = config_settings_.find(request.planner_id);
    PlannerChoice choice;
    choice.type = request.planner_id;
    if (found != config_settings_.end() && found->second.group == request.group_name)
    {
      choice.parameters = found->second.config;
      const auto type = choice.parameters.find("type");
      choice.type = type == choice.parameters.end() ? core::kBatchPlanner : type->second;
      choice.parameters.erase("type");
    }
    else if (choice.type.empty())
      choice.type = core::kBatchPlanner;
    choice.factory = workshop_->plugins.find(choice.type, configs_.names());
    const core::GroupPlanners& group = configs_.ofGroup(request.group_name);
    choice.projection = group.projection;
    choice.longest_valid_segment_fraction = group.longest_valid_segment_fraction;
    choice.waypoint_distance = waypoint_distance_;
    return choice;
  }

  moveit::core::RobotModelConstPtr model_;
  PlannerConfigs configs_;
  double waypoint_distance_ = kWaypointDistance;
  std::shared_ptr<Workshop> workshop_;
};
}  // namespace gpu_planning_scene::pipeline

PLUGINLIB_EXPORT_CLASS(gpu_planning_scene::pipeline::PlannerManager, planning_interface::PlannerManager)
