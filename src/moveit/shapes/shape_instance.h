#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include <moveit/collision_detection/collision_common.h>
#include <moveit/robot_state/attached_body.h>
#include <Eigen/Geometry>

#include "moveit/shapes/collision_shape.h"

namespace gpu_planning_scene::detector
{
/// A link, an attached object or a world object.
struct Body
{
  collision_detection::BodyType type;
  const std::string* name;
  const moveit::core::LinkModel* link;         ///< the link, or the link that carries the object; null in the world
  const moveit::core::AttachedBody* attached;  ///< null unless the object is attached
};

inline bool sameBody(const Body& a, const Body& b)
{
  return a.type == b.type &&
         (a.type == collision_detection::BodyTypes::WORLD_OBJECT ? *a.name == *b.name
                                                                 : a.link == b.link && a.attached == b.attached);
}

/// A shape of a body at its place in the planning frame.
struct ShapeInstance
{
  const CollisionShape* shape;
  const Eigen::Isometry3d* pose;
  Eigen::AlignedBox3d bounds;  ///< contains the shape with its padding; without limits if it is not a solid
  double padding;              ///< metres
  Body body;
};

/// The names of the bodies of two shape instances in ascending order: the key of MoveIt's results.
inline std::pair<std::string, std::string> keyOf(const ShapeInstance& a, const ShapeInstance& b)
{
  return std::minmax(*a.body.name, *b.body.name);
}

/// Makes a shape instance, with its bounds. A pose or a padding that is not finite, or above 1000 km, makes it faulty.
ShapeInstance makeShapeInstance(const CollisionShape& shape, const Eigen::Isometry3d& pose, double padding,
                                const Body& body);
}  // namespace gpu_planning_scene::detector
