#include "model/rigid_pose.h"

#include <limits>

#include <Eigen/SVD>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/shapes.h"

// The orthogonal matrix that is nearest to a matrix follows from its singular value decomposition U S V^T: it is U V^T
// (P. H. Schoenemann: A generalized solution of the orthogonal Procrustes problem. Psychometrika 31, 1966).
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kTolerance = 1e-6;
constexpr double kRounding = 1e-15;  // a rotation that is off by less is not changed

/// The deviation of the matrix from a rotation and a translation. Infinite if the pose is not finite, is a
/// reflection, or is too far away.
double excessOf(const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix3d rotation = pose.linear();
  if (!pose.matrix().allFinite() || pose.translation().cwiseAbs().maxCoeff() > kLargestLength ||
      rotation.determinant() < 0.0)
    return std::numeric_limits<double>::infinity();
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}
}  // namespace

bool isRigid(const Eigen::Isometry3d& pose)
{
  return excessOf(pose) <= kTolerance;
}

Eigen::Isometry3d nearestRigid(const Eigen::Isometry3d& pose, const std::string& where)
{
  const double excess = excessOf(pose);
  if (excess > kTolerance)
    throw Error(where + ": a pose is not finite, not a rotation and a translation, or farther than 1000 km away");
  if (excess <= kRounding)
    return pose;
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(pose.linear(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d result = pose;
  result.linear() = parts.matrixU() * parts.matrixV().transpose();
  return result;
}

Eigen::Isometry3d rigidProduct(const Eigen::Isometry3d& body, const Eigen::Isometry3d& shape)
{
  static const std::string of_body = "a body's pose";
  static const std::string of_shape = "a shape's pose";
  return nearestRigid(body, of_body) * nearestRigid(shape, of_shape);
}
}  // namespace gpu_planning_scene::core
