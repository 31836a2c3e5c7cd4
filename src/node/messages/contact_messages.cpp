#include "node/messages/contact_messages.h"

#include "node/messages/pose_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
std::uint32_t bodyType(const PlanningScene& scene, std::int32_t body)
{
  const std::size_t links = scene.robot->links().size();
  const auto index = static_cast<std::size_t>(body);
  if (index < links)
    return ContactInformation::ROBOT_LINK;
  return index < links + scene.objects.size() ? ContactInformation::WORLD_OBJECT : ContactInformation::ROBOT_ATTACHED;
}
}  // namespace

ContactInformation messageOf(const Contact& contact, const PlanningScene& scene, std::size_t state)
{
  ContactInformation message;
  message.header.frame_id = scene.robot->planningFrame();
  message.position = pointOf(contact.point);
  setPosition(message.normal, contact.normal);
  message.depth = contact.depth;
  message.contact_body_1 = scene.bodyName(contact.bodies[0]);
  message.body_type_1 = bodyType(scene, contact.bodies[0]);
  message.contact_body_2 = scene.bodyName(contact.bodies[1]);
  message.body_type_2 = bodyType(scene, contact.bodies[1]);
  message.state = static_cast<std::uint32_t>(state);
  return message;
}

NearestPairMessage messageOf(const NearestPair& pair, const PlanningScene& scene)
{
  NearestPairMessage message;
  message.distance = pair.distance;
  message.point_1 = pointOf(pair.points[0]);
  message.point_2 = pointOf(pair.points[1]);
  if (pair.bodies == kNoPair)
    return message;
  message.body_1 = scene.bodyName(pair.bodies[0]);
  message.body_type_1 = bodyType(scene, pair.bodies[0]);
  message.body_2 = scene.bodyName(pair.bodies[1]);
  message.body_type_2 = bodyType(scene, pair.bodies[1]);
  return message;
}
}  // namespace gpu_planning_scene::core
