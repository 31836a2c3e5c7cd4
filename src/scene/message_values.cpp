#include "scene/message_values.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
void requireDimensions(const std::vector<double>& dimensions, std::size_t count, const char* meaning)
{
  const auto surplus = dimensions.begin() + static_cast<std::ptrdiff_t>(std::min(count, dimensions.size()));
  if (dimensions.size() < count || std::any_of(surplus, dimensions.end(), [](double d) { return d != 0.0; }))
    throw Error("expected the dimensions " + std::string(meaning) + ", found " + std::to_string(dimensions.size()) +
                (dimensions.size() == 1 ? " number" : " numbers"));
}
}  // namespace

Shape primitiveOf(PrimitiveType type, const std::vector<double>& dimensions)
{
  switch (type)
  {
    case PrimitiveType::Box:
      requireDimensions(dimensions, 3, "[x, y, z]");
      return Box{Eigen::Vector3d(dimensions.data())};
    case PrimitiveType::Sphere:
      requireDimensions(dimensions, 1, "[radius]");
      return Sphere{dimensions[0]};
    case PrimitiveType::Cylinder:
      requireDimensions(dimensions, 2, "[height, radius]");
      return Cylinder{dimensions[1], dimensions[0]};
    case PrimitiveType::Cone:
      requireDimensions(dimensions, 2, "[height, radius]");
      return Cone{dimensions[1], dimensions[0]};
  }
  throw Error("unknown primitive type " + std::to_string(static_cast<int>(type)) +
              "; known are box (1), sphere (2), cylinder (3) and cone (4)");
}

HalfSpace halfSpaceBehind(const Eigen::Vector4d& plane)
{
  const Eigen::Vector3d normal = plane.head<3>();
  const double length = normal.stableNorm();
  const double offset = -plane[3] / length;
  if (length == 0.0 || !std::isfinite(length) || !std::isfinite(offset))
    throw Error("the plane [a, b, c, d] has no direction; a, b and c are its normal and cannot all be 0");
  return {Eigen::Vector3d(normal / length).normalized(), offset};
}

std::vector<double> variablesAt(const Joint& joint, const Eigen::Isometry3d& pose)
{
  if (joint.type == JointType::Planar)
  {
    const Eigen::Matrix3d directions = planarDirections(joint.axis);
    const Eigen::Vector3d position = directions.transpose() * pose.translation();
    const Eigen::Matrix3d rotation = directions.transpose() * pose.linear() * directions;
    constexpr double kTolerance = 1e-6;  // metres, radians: rounding errors in a message can be as large
    if (std::abs(position.z()) > kTolerance || rotation(2, 2) < 1.0 - 0.5 * kTolerance * kTolerance)
      throw Error("the transform leaves the plane of the planar joint '" + joint.name + "'");
    return {position.x(), position.y(), std::atan2(rotation(1, 0), rotation(0, 0))};
  }
  const Eigen::Quaterniond rotation(pose.linear());
  const Eigen::Vector3d& position = pose.translation();
  return {position.x(), position.y(), position.z(), rotation.x(), rotation.y(), rotation.z(), rotation.w()};
}

Eigen::Isometry3d poseOfVariables(const Joint& joint, const double* values)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (joint.type == JointType::Planar)
  {
    const Eigen::Matrix3d directions = planarDirections(joint.axis);
    pose.translation() = directions * Eigen::Vector3d(values[0], values[1], 0.0);
    pose.linear() =
        directions * Eigen::AngleAxisd(values[2], Eigen::Vector3d::UnitZ()).toRotationMatrix() * directions.transpose();
    return pose;
  }
  pose.translation() = Eigen::Vector3d(values);
  pose.linear() = Eigen::Quaterniond(values[6], values[3], values[4], values[5]).normalized().toRotationMatrix();
  return pose;
}
}  // namespace gpu_planning_scene::core
