#include "collision/bounds/rigid_pairs.h"

#include <algorithm>
#include <iterator>

// Two links are fixed to each other if the same link is their anchor. The exact checker decides each pair once, with
// the link poses in the frames of the anchors. Own method: it follows from the definition of a rigid pair.
namespace gpu_planning_scene::core
{
namespace
{
/// The uppermost link that this link is fixed to. -1: the planning frame.
int anchorOf(const RobotModel& robot, int link)
{
  for (;;)
  {
    const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    if (joint < 0)
      return -1;
    if (robot.joints()[static_cast<std::size_t>(joint)].type != JointType::Fixed)
      return link;
    link = robot.joints()[static_cast<std::size_t>(joint)].parent_link;
    if (link < 0)
      return -1;
  }
}

/// The pose of each link in the frame of its anchor. Two links with the same anchor have the same relative pose in all
/// states. Poses in the anchor's frame avoid the rounding of the anchor's own pose.
std::vector<Eigen::Isometry3d> posesInAnchors(const RobotModel& robot)
{
  std::vector<Eigen::Isometry3d> poses;
  for (const Link& link : robot.links())
  {
    const Joint* joint = link.parent_joint < 0 ? nullptr : &robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (joint != nullptr && joint->type == JointType::Fixed)
      pose =
          joint->parent_link < 0 ? joint->origin : poses[static_cast<std::size_t>(joint->parent_link)] * joint->origin;
    poses.push_back(pose);
  }
  return poses;
}
}  // namespace

CheckedPairs RigidPairs::take(const RobotModel& robot, const std::vector<RobotBody>& bodies, CheckedPairs& pairs)
{
  std::vector<int> anchors;
  for (const RobotBody& body : bodies)
    anchors.push_back(anchorOf(robot, body.link));
  CheckedPairs rigid;
  takePairs(
      pairs.self, rigid.self, [&](const CheckedPair& pair) { return anchors[pair.body] == anchors[pair.other]; });
  takePairs(pairs.world, rigid.world, [&](const CheckedPair& pair) { return anchors[pair.body] == -1; });
  return rigid;
}

std::unique_ptr<const ExactChecker> RigidPairs::exactCheckerOf(const PlanningScene& scene,
                                                               const std::vector<RobotBody>& bodies,
                                                               const CheckedPairs& pairs, ForestCache& forest)
{
  return forest.exactCheckerOf(
      std::make_shared<const CollisionProblem>(problemOf(scene, bodies, pairs, true, tessellations_)));
}

/// The relative pose of a rigid pair is the same in all states, up to rounding. Rounding can change the verdict only if
/// the distance is within the checker's slack of the required distance, and there the contract allows both verdicts.
std::vector<BodyPair> RigidPairs::collisions(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                             CheckedPairs rigid)
{
  if (robot_ != scene.robot)
  {
    links_collide_.clear();
    robot_ = scene.robot;
  }
  const auto of_links = [&](const CheckedPair& pair)
  { return !bodies[pair.body].attached && !bodies[pair.other].attached; };
  const auto names = [&](const CheckedPair& pair) { return BodyPair{bodies[pair.body].body, bodies[pair.other].body}; };
  const auto not_moved = [](const CheckedPair& pair) { return !pair.moved; };
  std::vector<CheckedPair> left_out;
  takePairs(rigid.self, left_out, not_moved);
  takePairs(rigid.world, left_out, not_moved);
  std::vector<CheckedPair> links;
  takePairs(rigid.self, links, of_links);

  CheckedPairs unknown;
  std::copy_if(links.begin(), links.end(), std::back_inserter(unknown.self),
               [&](const CheckedPair& pair) { return links_collide_.count(names(pair)) == 0; });
  const std::vector<Eigen::Isometry3d> poses = posesInAnchors(*scene.robot);
  if (!unknown.self.empty())
  {
    ForestCache forest;
    ExactChecker::Scratch scratch;
    const std::vector<BodyPair> found =
        exactCheckerOf(scene, bodies, unknown, forest)->allCollisions(poses.data(), scratch);
    for (const CheckedPair& pair : unknown.self)
      links_collide_[names(pair)] = std::find(found.begin(), found.end(), names(pair)) != found.end();
  }
  std::vector<BodyPair> colliding;
  if (!rigid.self.empty() || !rigid.world.empty())
  {
    ExactChecker::Scratch scratch;
    colliding = exactCheckerOf(scene, bodies, rigid, forest_)->allCollisions(poses.data(), scratch);
  }
  for (const CheckedPair& pair : links)
    if (links_collide_[names(pair)])
      colliding.push_back(names(pair));
  std::sort(colliding.begin(), colliding.end());
  return colliding;
}
}  // namespace gpu_planning_scene::core
