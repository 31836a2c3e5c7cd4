#include "moveit/shapes/robot_geometry.h"

#include "moveit/shapes/log.h"

namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::BodyTypes::ROBOT_ATTACHED;
using collision_detection::BodyTypes::ROBOT_LINK;

double valueOf(const std::map<std::string, double>& values, const std::string& link, double otherwise)
{
  const auto found = values.find(link);
  return found == values.end() ? otherwise : found->second;
}
}  // namespace

RobotGeometry::RobotGeometry(const moveit::core::RobotModel& robot, const std::map<std::string, double>& padding,
                             const std::map<std::string, double>& scale)
{
  for (const moveit::core::LinkModel* link : robot.getLinkModels())
  {
    LinkSettings settings{valueOf(padding, link->getName(), 0.0), valueOf(scale, link->getName(), 1.0)};
    if (settings.padding < 0.0)
    {
      ROS_ERROR_STREAM_NAMED(kLogName, "The padding of '" << link->getName() << "' is negative; it counts as 0");
      settings.padding = 0.0;
    }
    if (settings.padding != 0.0 || settings.scale != 1.0)
      settings_[link] = settings;
    for (std::size_t i = 0; i < link->getShapes().size(); ++i)
      shapes_.push_back(
          {link, i, collisionShapeOf(link->getShapes()[i], settings.scale, link->getName()), settings.padding});
  }
}

void RobotGeometry::place(const moveit::core::RobotState& state, const std::set<const moveit::core::LinkModel*>* active,
                          std::vector<ShapeInstance>& instances, std::vector<CollisionShapePtr>& attached) const
{
  const auto is_active = [active](const moveit::core::LinkModel* link)
  { return !active || active->find(link) != active->end(); };
  for (const LinkShape& shape : shapes_)
    if (shape.shape->kind() != ShapeKind::Empty && is_active(shape.link))
      instances.push_back(makeShapeInstance(*shape.shape, state.getCollisionBodyTransform(shape.link, shape.number),
                                            shape.padding, {ROBOT_LINK, &shape.link->getName(), shape.link, nullptr}));
  thread_local std::vector<const moveit::core::AttachedBody*> bodies;
  state.getAttachedBodies(bodies);
  for (const moveit::core::AttachedBody* body : bodies)
  {
    const moveit::core::LinkModel* link = body->getAttachedLink();
    if (!is_active(link))
      continue;
    const auto found = settings_.find(link);
    const LinkSettings settings = found == settings_.end() ? LinkSettings{0.0, 1.0} : found->second;
    for (std::size_t i = 0; i < body->getShapes().size(); ++i)
    {
      attached.push_back(collisionShapeOf(body->getShapes()[i], settings.scale, body->getName()));
      if (attached.back()->kind() != ShapeKind::Empty)
        instances.push_back(makeShapeInstance(*attached.back(), body->getGlobalCollisionBodyTransforms()[i],
                                              settings.padding, {ROBOT_ATTACHED, &body->getName(), link, body}));
    }
  }
}
}  // namespace gpu_planning_scene::detector
