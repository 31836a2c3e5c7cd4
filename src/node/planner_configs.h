#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>

namespace gpu_planning_scene::core
{
/// A planner by its type and its parameters, by OMPL's names.
struct PlannerConfig
{
  std::string type;
  std::map<std::string, std::string> parameters;
};

/// What a planners.yaml, laid out as MoveIt's ompl_planning.yaml, says of a group.
struct GroupPlanners
{
  std::string default_config;           ///< empty: none
  std::vector<std::string> configs;     ///< that are meant for the group; empty: all
  std::vector<std::string> projection;  ///< projection_evaluator: joints(A,B)
  std::optional<double> longest_valid_segment_fraction;
};

class PlannerConfigs
{
 public:
  /// From ~planners (other keys of a group are warned of): planner_configs/NAME/{type, PARAMETER...} and
  /// GROUP/{default_planner_config, planner_configs, projection_evaluator, longest_valid_segment_fraction}. Throws
  /// Error, which names the parameter.
  static PlannerConfigs fromParameters(const ros::NodeHandle& own);

  /// The configuration of that name; one of that type without parameters where there is none; the group's default, or
  /// the batch planner's, for an empty name. Throws Error for one that is there and not meant for the group.
  PlannerConfig find(const std::string& name, const std::string& group) const;

  const GroupPlanners& ofGroup(const std::string& group) const;

 private:
  std::map<std::string, PlannerConfig> configs_;
  std::map<std::string, GroupPlanners> groups_;
};
}  // namespace gpu_planning_scene::core
