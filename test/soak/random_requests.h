#pragma once

#include <random>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "node/messages/messages.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
/// `count` random states, one row per state.
inline std::vector<double> randomStates(const RobotModel& robot, std::size_t count, std::mt19937_64& generator)
{
  const std::size_t width = robot.variables().size();
  std::vector<double> states(count * width);
  for (std::size_t i = 0; i < states.size(); i += width)
    robot.randomState(generator, states.data() + i);
  return states;
}

/// Adds the object to the change. One of ten changes attaches or detaches the object of this name instead.
inline void addObject(PlanningSceneMessage& change, const CollisionObject& object, const std::string& link,
                      std::mt19937_64& generator)
{
  if (generator() % 10 != 0)
  {
    change.world.collision_objects.push_back(object);
    return;
  }
  AttachedCollisionObject attached;
  attached.link_name = link;
  attached.object = objectOperation(object.id, generator() % 2 == 0 ? CollisionObject::ADD : CollisionObject::REMOVE);
  change.robot_state.attached_collision_objects.push_back(attached);
}

/// Takes the first joint out of a request for all variables. The joint then has its value in the scene's current state.
inline void leaveOutFirstJoint(CheckStates::Request& request)
{
  const std::size_t width = request.joint_names.size();
  std::vector<double> positions;
  for (std::size_t i = 0; i < request.positions.size(); ++i)
    if (i % width != 0)
      positions.push_back(request.positions[i]);
  request.joint_names.erase(request.joint_names.begin());
  request.positions = positions;
}
}  // namespace gpu_planning_scene::core
