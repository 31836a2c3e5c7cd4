#include "collision/exact/sampled_collisions.h"

#include <algorithm>
#include <iterator>
#include <random>
#include <set>

#include "scene/body_link.h"

// Intersects the sets of colliding pairs of random states. MoveIt's Setup Assistant finds pairs that always collide in
// a similar way.
namespace gpu_planning_scene::core
{
namespace
{
/// The joints between a link and the planning frame whose values random states cannot stand for.
std::set<int> unsampledJointsAbove(const RobotModel& robot, int link)
{
  const auto is_passive = [&robot](const Joint& joint)
  {
    return std::any_of(robot.joints().begin(), robot.joints().end(),
                       [&joint](const Joint& other)
                       { return other.passive && other.first_variable == joint.first_variable; });
  };
  std::set<int> joints;
  while (link >= 0 && robot.links()[static_cast<std::size_t>(link)].parent_joint >= 0)
  {
    const int index = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    if (joint.type == JointType::Planar || joint.type == JointType::Floating ||
        (joint.type != JointType::Fixed && is_passive(joint)))
      joints.insert(index);
    link = joint.parent_link;
  }
  return joints;
}

/// Joints above both bodies do not move them relative to each other.
bool isSampled(const PlanningScene& scene, const BodyPair& pair)
{
  return unsampledJointsAbove(*scene.robot, linkOfBody(scene, pair[0])) ==
         unsampledJointsAbove(*scene.robot, linkOfBody(scene, pair[1]));
}
}  // namespace

std::vector<BodyPair> collidingInSamples(const PlanningScene& scene, const CollisionProblem& problem,
                                         const ExactChecker& exact)
{
  const RobotModel& robot = *scene.robot;
  std::mt19937_64 generator;  // the same states each time, so that the same scene has the same report
  std::vector<double> state(robot.variables().size());
  const std::vector<double> base = robot.defaultState();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  ExactChecker::Scratch scratch;
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < kSampledStates; ++i)
  {
    robot.randomState(generator, base.data(), state.data());
    if (!isValidFor(problem, state.data()))
      return {};
    robot.linkPoses(state.data(), poses.data());
    std::vector<BodyPair> found = exact.allCollisions(poses.data(), scratch);
    if (problem.always_colliding)
      found.erase(std::remove(found.begin(), found.end(), *problem.always_colliding), found.end());
    std::vector<BodyPair> in_all;
    if (i == 0)
      in_all = std::move(found);
    else
      std::set_intersection(pairs.begin(), pairs.end(), found.begin(), found.end(), std::back_inserter(in_all));
    pairs = std::move(in_all);
    if (pairs.empty())
      break;
  }
  pairs.erase(
      std::remove_if(pairs.begin(), pairs.end(), [&scene](const BodyPair& pair) { return !isSampled(scene, pair); }),
      pairs.end());
  return pairs;
}
}  // namespace gpu_planning_scene::core
