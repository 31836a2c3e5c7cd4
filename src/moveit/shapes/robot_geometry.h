#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <moveit/robot_state/robot_state.h>

#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// The shapes of a robot's links, with scale and padding. Immutable; copies of an environment share it.
class RobotGeometry
{
 public:
  /// `padding`, `scale`: by the names of the links, as the environment has them.
  RobotGeometry(const moveit::core::RobotModel& robot, const std::map<std::string, double>& padding,
                const std::map<std::string, double>& scale);

  /// Appends the shape instances of the links and of the attached objects to `instances`. They point into the state and
  /// into `attached`, which receives the shapes of the attached objects. `active`: if not null, only the instances of
  /// these links and of the objects that they carry.
  void place(const moveit::core::RobotState& state, const std::set<const moveit::core::LinkModel*>* active,
             std::vector<ShapeInstance>& instances, std::vector<CollisionShapePtr>& attached) const;

 private:
  struct LinkShape
  {
    const moveit::core::LinkModel* link;
    std::size_t number;  // of the shape, within the link
    CollisionShapePtr shape;
    double padding;
  };
  struct LinkSettings
  {
    double padding;
    double scale;
  };
  std::vector<LinkShape> shapes_;
  std::map<const moveit::core::LinkModel*, LinkSettings> settings_;  // of the links that have a padding or a scale
};
}  // namespace gpu_planning_scene::detector
