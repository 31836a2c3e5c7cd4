#include "stability/placing.h"

#include <utility>

#include "oracle/oracle.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
/// Half-spaces have no pose, so the plane itself is moved.
HalfSpace movedBy(const Eigen::Isometry3d& pose, const HalfSpace& half_space)
{
  const Eigen::Vector3d normal = (pose.linear() * half_space.normal).normalized();
  return {normal, half_space.offset + normal.dot(pose.translation())};
}
}  // namespace

Case placed(Random& random, Shape a, Shape b, const Eigen::Isometry3d& b_in_a, const Place& place)
{
  const bool aligned = random.below(3) == 0;
  Eigen::Isometry3d motion = aligned ? random.alignedMotion(place.distance) : random.motion(place.distance);
  motion.translation() += place.origin;
  Case made;
  Eigen::Isometry3d pose_a = motion;
  Eigen::Isometry3d pose_b = motion * b_in_a;
  if (!std::holds_alternative<HalfSpace>(b) && (std::holds_alternative<HalfSpace>(a) || random.coin()))
  {
    std::swap(a, b);
    std::swap(pose_a, pose_b);
  }
  if (const auto* half_space = std::get_if<HalfSpace>(&b))
  {
    b = movedBy(pose_b, *half_space);
    pose_b.setIdentity();
  }
  made.a = std::move(a);
  made.b = std::move(b);
  made.link_a = pose_a;
  made.pose_b = pose_b;
  if (!aligned && random.coin())
  {
    made.a_in_link = random.motion(0.3);
    made.link_a = pose_a * made.a_in_link.inverse();
  }
  return made;
}

Case withPadding(Random& random, Case made)
{
  const oracle::PreparedShape a(made.a);
  const oracle::PreparedShape b(made.b);
  const double apart =
      oracle::distance(a, oracle::Motion(made.link_a) * oracle::Motion(made.a_in_link), b, oracle::Motion(made.pose_b));
  const double offset = random.powerOfTen(3, 8);
  const double required = apart + offset > 0.0 ? apart + offset : apart + 1e-3;
  const double share = random.below(3) == 0 ? 1.0 : random.uniform(0.0, 1.0);
  made.padding_a = share * required;
  made.padding_b = required - made.padding_a;
  made.known.reset();
  return made;
}

Eigen::Isometry3d poseNearContact(const Shape& a, const Shape& b, const Eigen::Isometry3d& start,
                                  const Eigen::Vector3d& direction, double offset)
{
  const oracle::PreparedShape first(a);
  const oracle::PreparedShape second(b);
  const auto at = [&](double way)
  {
    Eigen::Isometry3d pose = start;
    pose.translation() += way * direction;
    return pose;
  };
  const auto apart = [&](double way)
  { return oracle::distance(first, {}, second, oracle::Motion(at(way)), 1e-15) > 0.0; };
  double touching = 0.0;
  double free = 1.0;
  while (!apart(free))
    free *= 2.0;
  for (int i = 0; i < 60 && touching + 1e-13 < free; ++i)
  {
    const double middle = 0.5 * (touching + free);
    (apart(middle) ? free : touching) = middle;
  }
  return at(free + offset);
}

Eigen::Isometry3d poseNearContact(Random& random, const Shape& a, const Eigen::Vector3d& point_a, const Shape& b,
                                  const Eigen::Vector3d& point_b, double offset)
{
  Eigen::Isometry3d start(random.rotation());
  start.translation() = point_a - start.linear() * point_b;
  return poseNearContact(a, b, start, random.direction(), offset);
}

Eigen::Vector3d innerPoint(Random& random, const Shape& shape)
{
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape);
  if (mesh == nullptr)
    return Eigen::Vector3d::Zero();
  const auto& triangles = (*mesh)->triangles;
  const auto& t = triangles[random.below(static_cast<int>(triangles.size()))];
  const double u = random.uniform(0.05, 0.45);
  const double v = random.uniform(0.05, 0.45);
  const auto& p = (*mesh)->vertices;
  return p[t[0]] + u * (p[t[1]] - p[t[0]]) + v * (p[t[2]] - p[t[0]]);
}
}  // namespace gpu_planning_scene::core::stability
