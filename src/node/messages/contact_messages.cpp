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

/// Sets the bodies of a message with the fields of NearestPair.
template <class Message>
void setBodies(Message& message, const BodyPair& bodies, const PlanningScene& scene)
{
  message.body_1 = scene.bodyName(bodies[0]);
  message.body_type_1 = bodyType(scene, bodies[0]);
  message.body_2 = scene.bodyName(bodies[1]);
  message.body_type_2 = bodyType(scene, bodies[1]);
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
  if (pair.bodies != kNoPair)
    setBodies(message, pair.bodies, scene);
  return message;
}

BodyDistanceMessage messageOf(const BodyDistances& distances, std::size_t pair, const std::vector<int>& variables,
                              const PlanningScene& scene, std::size_t state)
{
  const BodyDistance& found = distances.pairs[pair];
  BodyDistanceMessage message;
  message.state = static_cast<std::uint32_t>(state);
  message.collides = static_cast<std::uint8_t>(found.collides);
  message.distance = found.distance;
  message.depth_at_least = found.depth_at_least;
  setBodies(message, found.bodies, scene);
  message.point_1 = pointOf(found.points[0]);
  message.point_2 = pointOf(found.points[1]);
  setPosition(message.normal, found.normal);
  const double* gradient = &distances.gradients[pair * scene.robot->variables().size()];
  for (const int variable : variables)
    message.gradient.push_back(gradient[variable]);
  return message;
}
}  // namespace gpu_planning_scene::core
