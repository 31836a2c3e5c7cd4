#pragma once

#include <set>
#include <string>

#include <moveit/collision_detection/collision_matrix.h>
#include <moveit/robot_model/robot_model.h>

#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// Which pairs of bodies a request checks. The rules are those of MoveIt's FCL detector.
class PairFilter
{
 public:
  enum class Rule
  {
    Check,
    Skip,
    Ask  ///< the matrix has a decider, which is asked about each contact
  };

  /// `matrix`: null: every pair is checked. `active`: null: all links.
  PairFilter(const collision_detection::AllowedCollisionMatrix* matrix,
             const std::set<const moveit::core::LinkModel*>* active)
    : matrix_(matrix), active_(active)
  {
  }

  /// The links that the group moves; null for the whole robot and for unknown groups, as in MoveIt.
  static const std::set<const moveit::core::LinkModel*>* activeLinks(const moveit::core::RobotModel& robot,
                                                                     const std::string& group);

  bool isActive(const Body& body) const
  {
    return !active_ || (body.link && active_->find(body.link) != active_->end());
  }

  /// The rule for two different bodies. Does not look at isActive().
  Rule rule(const Body& a, const Body& b) const;
  /// The decider of a pair with the rule Ask. May be empty, then no contact is allowed.
  collision_detection::DecideContactFn decider(const Body& a, const Body& b) const;

 private:
  const collision_detection::AllowedCollisionMatrix* matrix_;
  const std::set<const moveit::core::LinkModel*>* active_;
};
}  // namespace gpu_planning_scene::detector
