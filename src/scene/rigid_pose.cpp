#include "scene/rigid_pose.h"

#include <Eigen/SVD>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
namespace
{
constexpr double kTolerance = 1e-6;
constexpr double kRounding = 1e-15;  // rotations that are as good as doubles get stay as they are
}  // namespace

Eigen::Isometry3d rigid(const Eigen::Isometry3d& pose, const std::string& where)
{
  const Eigen::Matrix3d rotation = pose.linear();
  const Eigen::Matrix3d excess = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (!pose.matrix().allFinite() || excess.cwiseAbs().maxCoeff() > kTolerance || rotation.determinant() < 0.0)
    throw Error(where + ": a pose is not finite or not a rotation and a translation");
  if (excess.cwiseAbs().maxCoeff() <= kRounding)
    return pose;
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d result = pose;
  result.linear() = parts.matrixU() * parts.matrixV().transpose();
  return result;
}

Eigen::Isometry3d rigidProduct(const Eigen::Isometry3d& body, const Eigen::Isometry3d& shape)
{
  return rigid(body, "a body's pose") * rigid(shape, "a shape's pose");
}
}  // namespace gpu_planning_scene
