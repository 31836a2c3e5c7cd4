#pragma once
// MoveIt's messages as messages of this package. Both have the same layout (see layouts.h), so there is one conversion:
// the bytes of MoveIt's message are read as our message, and our message is written as MoveIt's.

#include <string>

#include <moveit_msgs/ApplyPlanningScene.h>
#include <moveit_msgs/AttachedCollisionObject.h>
#include <moveit_msgs/CollisionObject.h>
#include <moveit_msgs/GetPlanningScene.h>
#include <moveit_msgs/GetStateValidity.h>
#include <moveit_msgs/PlanningScene.h>
#include <moveit_msgs/PlanningSceneWorld.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <roscpp/Empty.h>

#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// A message of this package with the name, checksum and definition of MoveIt's message `Theirs`.
template <class Ours, class Theirs>
struct AsMoveIt
{
  Ours ours;
};

using MoveItScene = AsMoveIt<PlanningSceneMessage, moveit_msgs::PlanningScene>;
using MoveItObject = AsMoveIt<CollisionObject, moveit_msgs::CollisionObject>;
using MoveItAttachedObject = AsMoveIt<AttachedCollisionObject, moveit_msgs::AttachedCollisionObject>;
using MoveItWorld = AsMoveIt<PlanningSceneWorld, moveit_msgs::PlanningSceneWorld>;

// Services: as the structs that ROS generates, with a request and a response. A message with a single field has the
// layout of this field.

struct MoveItGetScene
{
  using Request = AsMoveIt<GetPlanningScene::Request, moveit_msgs::GetPlanningScene::Request>;
  using Response = AsMoveIt<PlanningSceneMessage, moveit_msgs::GetPlanningScene::Response>;
};

struct MoveItApplyScene
{
  using Request = AsMoveIt<PlanningSceneMessage, moveit_msgs::ApplyPlanningScene::Request>;
  using Response = moveit_msgs::ApplyPlanningScene::Response;
};

/// The request of moveit_msgs/GetStateValidity, with our RobotState.
struct StateValidityRequest
{
  RobotState robot_state;
  std::string group_name;
  moveit_msgs::Constraints constraints;
};
struct MoveItStateValidity
{
  using Request = AsMoveIt<StateValidityRequest, moveit_msgs::GetStateValidity::Request>;
  using Response = moveit_msgs::GetStateValidity::Response;
};

/// std_srvs/Empty, of MoveIt's clear_octomap. roscpp, which the node needs anyway, has an equal service.
struct MoveItEmpty
{
  using Request = roscpp::Empty::Request;
  using Response = roscpp::Empty::Response;
};

/// Passes the fields of a message that MoveIt's message has to the stream, in MoveIt's order.
template <class Stream, class Message>
void passFields(Stream& stream, Message& message)
{
  using Plain = std::remove_const_t<Message>;
  if constexpr (std::is_same_v<Plain, PlanningSceneMessage>)
  {
    // All fields before scene_revision: see layouts.cpp.
    stream.next(message.name);
    stream.next(message.robot_state);
    stream.next(message.robot_model_name);
    stream.next(message.fixed_frame_transforms);
    stream.next(message.allowed_collision_matrix);
    stream.next(message.link_padding);
    stream.next(message.link_scale);
    stream.next(message.object_colors);
    stream.next(message.world);
    stream.next(message.is_diff);
  }
  else if constexpr (std::is_same_v<Plain, StateValidityRequest>)
  {
    stream.next(message.robot_state);
    stream.next(message.group_name);
    stream.next(message.constraints);
  }
  else
    stream.next(message);
}
}  // namespace gpu_planning_scene::core

namespace ros
{
namespace message_traits
{
template <class Ours, class Theirs>
struct IsMessage<gpu_planning_scene::core::AsMoveIt<Ours, Theirs>> : TrueType
{
};
template <class Ours, class Theirs>
struct MD5Sum<gpu_planning_scene::core::AsMoveIt<Ours, Theirs>>
{
  static const char* value() { return MD5Sum<Theirs>::value(); }
  static const char* value(const gpu_planning_scene::core::AsMoveIt<Ours, Theirs>&) { return value(); }
};
template <class Ours, class Theirs>
struct DataType<gpu_planning_scene::core::AsMoveIt<Ours, Theirs>>
{
  static const char* value() { return DataType<Theirs>::value(); }
  static const char* value(const gpu_planning_scene::core::AsMoveIt<Ours, Theirs>&) { return value(); }
};
template <class Ours, class Theirs>
struct Definition<gpu_planning_scene::core::AsMoveIt<Ours, Theirs>>
{
  static const char* value() { return Definition<Theirs>::value(); }
  static const char* value(const gpu_planning_scene::core::AsMoveIt<Ours, Theirs>&) { return value(); }
};
}  // namespace message_traits

namespace serialization
{
template <class Ours, class Theirs>
struct Serializer<gpu_planning_scene::core::AsMoveIt<Ours, Theirs>>
{
  template <class Stream, class T>
  static void allInOne(Stream& stream, T message)
  {
    gpu_planning_scene::core::passFields(stream, message.ours);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};
}  // namespace serialization

namespace service_traits
{
template <>
struct MD5Sum<gpu_planning_scene::core::MoveItGetScene> : MD5Sum<moveit_msgs::GetPlanningScene>
{
};
template <>
struct DataType<gpu_planning_scene::core::MoveItGetScene> : DataType<moveit_msgs::GetPlanningScene>
{
};
template <>
struct MD5Sum<gpu_planning_scene::core::MoveItApplyScene> : MD5Sum<moveit_msgs::ApplyPlanningScene>
{
};
template <>
struct DataType<gpu_planning_scene::core::MoveItApplyScene> : DataType<moveit_msgs::ApplyPlanningScene>
{
};
template <>
struct MD5Sum<gpu_planning_scene::core::MoveItStateValidity> : MD5Sum<moveit_msgs::GetStateValidity>
{
};
template <>
struct DataType<gpu_planning_scene::core::MoveItStateValidity> : DataType<moveit_msgs::GetStateValidity>
{
};
template <>
struct MD5Sum<gpu_planning_scene::core::MoveItEmpty> : MD5Sum<roscpp::Empty>
{
};
template <>
struct DataType<gpu_planning_scene::core::MoveItEmpty>
{
  static const char* value() { return "std_srvs/Empty"; }
};
}  // namespace service_traits
}  // namespace ros
