#include "moveit/shapes/shape_instance.h"

#include <limits>

#include "collision/exact/cpu_shape_pair.h"
#include "moveit/shapes/log.h"

namespace gpu_planning_scene::detector
{
namespace
{
const Eigen::AlignedBox3d& everything()
{
  static const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                                       Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()));
  return box;
}

/// Written so that NaN fails too.
bool isNear(const Eigen::Isometry3d& pose)
{
  return pose.translation().cwiseAbs().maxCoeff() <= core::kLargestLength && pose.linear().allFinite() &&
         pose.translation().allFinite();
}
}  // namespace

ShapeInstance makeShapeInstance(const CollisionShape& shape, const Eigen::Isometry3d& pose, double padding,
                                const Body& body)
{
  ShapeInstance instance{&shape, &pose, everything(), padding, body};
  if (!isNear(pose) || !(padding >= 0.0 && padding <= core::kLargestLength))
  {
    static LogLimit limit;
    if (limit.allows())
      ROS_ERROR_STREAM_NAMED(kLogName, "The pose or the padding of a shape of '"
                                           << *body.name
                                           << "' is not finite, above 1000 km, or negative. The shape counts as "
                                           << "colliding with every body that is checked against it.");
    instance.shape = &CollisionShape::faulty();
  }
  else if (shape.kind() == ShapeKind::Solid)
  {
    const Eigen::AlignedBox3d bounds = core::boundsOf(shape.tree(), pose);
    instance.bounds = {bounds.min().array() - padding, bounds.max().array() + padding};
  }
  return instance;
}
}  // namespace gpu_planning_scene::detector
