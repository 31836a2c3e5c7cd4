#include "model/kinematics.h"

#include "base/sine.h"

// Forward kinematics with precomputed constants for each joint: see Kinematics::Step. The pose of a link is the pose of
// its parent times the pose of its joint. Rotations use Rodrigues' formula (K. M. Lynch, F. C. Park: Modern Robotics,
// 2017, chapters 3 and 4).
namespace gpu_planning_scene::core
{
namespace
{
Eigen::Matrix3d crossProductMatrix(const Eigen::Vector3d& a)
{
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

// The motion of a planar joint. The columns of `directions` are the two directions and the normal of the plane.
Eigen::Matrix4d planarMotion(const Eigen::Matrix3d& directions, const double* variables)
{
  Eigen::Matrix4d motion = Eigen::Matrix4d::Identity();
  motion.topRightCorner<3, 1>() = directions.leftCols<2>() * Eigen::Vector2d(variables[0], variables[1]);
  const Eigen::Vector3d normal = directions.col(2);
  const Eigen::Matrix3d along = normal * normal.transpose();
  const auto [sine, cosine] = sineCosine(variables[2]);
  motion.topLeftCorner<3, 3>() =
      along + cosine * (Eigen::Matrix3d::Identity() - along) + sine * crossProductMatrix(normal);
  return motion;
}

Eigen::Matrix4d floatingMotion(const double* variables)
{
  Eigen::Matrix4d motion = Eigen::Matrix4d::Identity();
  motion.topRightCorner<3, 1>() = Eigen::Map<const Eigen::Vector3d>(variables);
  // Divides by the largest coefficient first, so that squares of very large or very small numbers neither overflow nor
  // vanish.
  Eigen::Vector4d coefficients = Eigen::Map<const Eigen::Vector4d>(variables + 3);
  const double largest = coefficients.cwiseAbs().maxCoeff();
  if (largest > 0.0)
  {
    coefficients /= largest;
    coefficients.normalize();
    motion.topLeftCorner<3, 3>() = Eigen::Quaterniond(coefficients).toRotationMatrix();
  }
  return motion;
}
}  // namespace

Eigen::Matrix3d planarDirections(const Eigen::Vector3d& normal)
{
  // The coordinate axis nearest to the normal is skipped; x is the axis after it, projected into the plane. For a
  // normal along x, y or z, (x, y) of the joint are (y, z), (z, x) or (x, y).
  int nearest;
  normal.cwiseAbs().maxCoeff(&nearest);
  const Eigen::Vector3d next = Eigen::Vector3d::Unit((nearest + 1) % 3);
  Eigen::Matrix3d directions;
  directions.col(0) = (next - next.dot(normal) * normal).normalized();
  directions.col(1) = normal.cross(directions.col(0));
  directions.col(2) = normal;
  return directions;
}

Kinematics::Kinematics(const std::vector<Link>& links, const std::vector<Joint>& joints)
{
  for (const Link& link : links)
  {
    Step step;
    if (link.parent_joint >= 0)
    {
      const Joint& joint = joints[link.parent_joint];
      const Eigen::Matrix3d origin = joint.origin.linear();
      const Eigen::Vector3d& axis = joint.axis;
      step.constant = joint.origin.matrix();
      step.multiplier = joint.multiplier;
      step.offset = joint.offset;
      step.parent = joint.parent_link;
      step.variable = joint.first_variable;
      step.type = joint.type;
      if (joint.type == JointType::Revolute || joint.type == JointType::Continuous)
      {
        const Eigen::Matrix3d along = axis * axis.transpose();
        step.constant.topLeftCorner<3, 3>() = origin * along;
        step.first.topLeftCorner<3, 3>() = origin * (Eigen::Matrix3d::Identity() - along);
        step.second.topLeftCorner<3, 3>() = origin * crossProductMatrix(axis);
      }
      else if (joint.type == JointType::Prismatic)
      {
        step.first.topRightCorner<3, 1>() = origin * axis;
      }
      else if (joint.type == JointType::Planar)
      {
        step.first.topLeftCorner<3, 3>() = planarDirections(axis);
      }
    }
    steps_.push_back(step);
  }
}

Eigen::Matrix4d Kinematics::relativePose(const Step& step, const double* state)
{
  switch (step.type)
  {
    case JointType::Revolute:
    case JointType::Continuous:
    {
      const auto [sine, cosine] = sineCosine(step.multiplier * state[step.variable] + step.offset);
      return step.constant + cosine * step.first + sine * step.second;
    }
    case JointType::Prismatic:
      return step.constant + (step.multiplier * state[step.variable] + step.offset) * step.first;
    case JointType::Planar:
      return step.constant * planarMotion(step.first.topLeftCorner<3, 3>(), state + step.variable);
    case JointType::Floating:
      return step.constant * floatingMotion(state + step.variable);
    case JointType::Fixed:
      break;
  }
  return step.constant;
}

void Kinematics::place(const Step& step, const double* state, Eigen::Isometry3d* poses, Eigen::Isometry3d& pose)
{
  // Eigen vectorises products of 4x4 matrices. The last row stays exactly 0 0 0 1.
  if (step.parent < 0)
    pose.matrix() = relativePose(step, state);
  else if (step.type == JointType::Fixed)
    pose.matrix().noalias() = poses[step.parent].matrix() * step.constant;
  else
    pose.matrix().noalias() = poses[step.parent].matrix() * relativePose(step, state);
}

void Kinematics::linkPoses(const double* state, Eigen::Isometry3d* poses) const
{
  for (std::size_t i = 0; i < steps_.size(); ++i)
    place(steps_[i], state, poses, poses[i]);
}

void Kinematics::computeLinkPose(const double* state, int link, Eigen::Isometry3d* poses, std::uint8_t* known) const
{
  if (link < 0 || known[link] != 0)
    return;
  const Step& step = steps_[static_cast<std::size_t>(link)];
  computeLinkPose(state, step.parent, poses, known);
  place(step, state, poses, poses[link]);
  known[link] = 1;
}
}  // namespace gpu_planning_scene::core
