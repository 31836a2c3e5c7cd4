#include "moveit/pairs/pair_filter.h"

namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::AllowedCollision::Type;
using collision_detection::BodyTypes::ROBOT_ATTACHED;
using collision_detection::BodyTypes::ROBOT_LINK;

bool isTouchLink(const Body& link, const Body& carried)
{
  return link.type == ROBOT_LINK && carried.type == ROBOT_ATTACHED &&
         carried.attached->getTouchLinks().count(*link.name) != 0;
}
}  // namespace

const std::set<const moveit::core::LinkModel*>* PairFilter::activeLinks(const moveit::core::RobotModel& robot,
                                                                        const std::string& group)
{
  if (!robot.hasJointModelGroup(group))
    return nullptr;
  return &robot.getJointModelGroup(group)->getUpdatedLinkModelsSet();
}

PairFilter::Rule PairFilter::rule(const Body& a, const Body& b) const
{
  if (a.type == ROBOT_ATTACHED && b.type == ROBOT_ATTACHED && a.link == b.link)
    return Rule::Skip;
  if (isTouchLink(a, b) || isTouchLink(b, a))
    return Rule::Skip;
  Type type;
  if (!matrix_ || !matrix_->getAllowedCollision(*a.name, *b.name, type) || type == Type::NEVER)
    return Rule::Check;
  return type == Type::ALWAYS ? Rule::Skip : Rule::Ask;
}

collision_detection::DecideContactFn PairFilter::decider(const Body& a, const Body& b) const
{
  collision_detection::DecideContactFn decider;
  matrix_->getAllowedCollision(*a.name, *b.name, decider);
  return decider;
}
}  // namespace gpu_planning_scene::detector
