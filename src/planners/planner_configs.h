#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace gpu_planning_scene::core
{
/// The plugin name of the planner that plans if none is named.
constexpr char kBatchPlanner[] = "gpu_planning_scene/BatchRrtConnect";

/// A planner's type (plugin name) and its parameters, under OMPL's names.
struct PlannerConfig
{
  std::string type;
  std::map<std::string, std::string> parameters;
};

/// The entry of a group in ~planners, whose layout is that of MoveIt's ompl_planning.yaml.
struct GroupPlanners
{
  std::string default_config;           ///< empty: none
  std::vector<std::string> configs;     ///< the configurations that the group may use; empty: all
  std::vector<std::string> projection;  ///< projection_evaluator: joints(A,B)
  std::optional<double> longest_valid_segment_fraction;
};

class PlannerConfigs
{
 public:
  /// Reads ~planners: planner_configs/NAME/{type, PARAMETER...} and GROUP/{default_planner_config, planner_configs,
  /// projection_evaluator, longest_valid_segment_fraction}. Other keys of a group give a warning. Throws Error, which
  /// names the parameter.
  static PlannerConfigs fromParameters(const ros::NodeHandle& own);
  /// Reads a value of that layout. `name`: of the parameter, for messages.
  static PlannerConfigs fromValue(XmlRpc::XmlRpcValue& planners, const std::string& name);

  /// The configuration `name`. If there is no such configuration, `name` is the type of a planner without parameters.
  /// An empty name means the group's default, and the batch planner if the group has no default. Throws Error for a
  /// configuration that the group may not use.
  PlannerConfig find(const std::string& name, const std::string& group) const;

  const std::map<std::string, PlannerConfig>& configs() const { return configs_; }
  /// The names of all configurations.
  std::vector<std::string> names() const;

  const GroupPlanners& ofGroup(const std::string& group) const;

 private:
  std::map<std::string, PlannerConfig> configs_;
  std::map<std::string, GroupPlanners> groups_;
};
}  // namespace gpu_planning_scene::core
