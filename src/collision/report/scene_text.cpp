#include "collision/report/scene_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/text/one_line.h"
#include "collision/proofs/joint_chain.h"
#include "gpu_planning_scene/body_parts.h"
#include "model/robot_text.h"
#include "scene/body_link.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxListedPairs = 5;

std::string matrixText(MatrixSource source)
{
  switch (source)
  {
    case MatrixSource::Srdf:
      return "the SRDF allows";
    case MatrixSource::SceneFile:
      return "the scene's allowed-collision matrix allows";
    case MatrixSource::AdjacentLinks:
      break;
  }
  return "are adjacent (no SRDF was given)";
}

/// The first pairs by name, and the number of the others.
std::string pairList(const PlanningScene& scene, const std::vector<BodyPair>& pairs)
{
  std::string text;
  for (std::size_t i = 0; i < std::min(pairs.size(), kMaxListedPairs); ++i)
    text += (i == 0 ? "" : ", ") + scene.bodyName(pairs[i][0]) + " - " + scene.bodyName(pairs[i][1]);
  return pairs.size() <= kMaxListedPairs ? text
                                         : text + " and " + std::to_string(pairs.size() - kMaxListedPairs) + " more";
}

/// Whether no joint moves the two bodies relative to each other, so that they collide in all states or in none.
bool isRigid(const PlanningScene& scene, const BodyPair& pair)
{
  const std::vector<ChainJoint> joints =
      jointsBetween(*scene.robot, linkOfBody(scene, pair[0]), linkOfBody(scene, pair[1]));
  return std::all_of(joints.begin(), joints.end(),
                     [](const ChainJoint& part) { return part.joint->type == JointType::Fixed; });
}

/// Metres from the origin of the planning frame within which answers are exact (docs/error_bounds.md).
constexpr double kExactRange = 1000.0;

/// The name of a body with its origin beyond this range, in the current state or in the default state; empty: none.
std::string bodyOutOfRange(const PlanningScene& scene)
{
  const RobotModel& robot = *scene.robot;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  const std::vector<double> state = scene.current_state.empty() ? robot.defaultState() : scene.current_state;
  robot.linkPoses(state.data(), poses.data());
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!robot.links()[i].shapes.empty() && poses[i].translation().norm() > kExactRange)
      return robot.links()[i].name;
  for (const WorldObject& object : scene.objects)
    if (object.pose.translation().norm() > kExactRange)
      return object.id;
  return "";
}

/// Only a pair that collides in every state may be allowed without the risk that a collision is missed.
std::string remedyOfRigid(const PlanningScene& scene, const std::vector<BodyPair>& pairs)
{
  for (const BodyPair& pair : pairs)
    if (isRigid(scene, pair))
    {
      const std::string& first = scene.bodyName(pair[0]);
      const std::string& second = scene.bodyName(pair[1]);
      return "; no joint moves " + first + " and " + second +
             " apart, so this pair may also be allowed: allowed_collisions: [[" + first + ", " + second +
             "]] in a scene file";
    }
  return "";
}

/// "1000, 12.3 % by joint tables (15 ns), ...": the number of states, their shares, and the time of each stage per
/// state.
std::string decidedText(const std::vector<DecidedStates>& decided)
{
  double all = 0.0;
  for (const DecidedStates& stage : decided)
    all += static_cast<double>(stage.states);
  std::string text = std::to_string(std::llround(all));
  for (const DecidedStates& stage : decided)
  {
    char share[64];
    std::snprintf(share, sizeof share, ", %.1f %% by ", 100.0 * static_cast<double>(stage.states) / all);
    text += share + stage.by;
    if (stage.nanoseconds > 0.0)
      text += " (" + std::to_string(std::lround(stage.nanoseconds)) + " ns a state)";
  }
  return text;
}
}  // namespace

std::string counted(std::size_t count, const std::string& noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<std::string> describeScene(const PlanningScene& scene, const SceneReport& report, const std::string& device)
{
  const RobotModel& robot = *scene.robot;
  std::vector<std::string> lines;
  lines.push_back("device: " + device);
  lines.push_back("robot: " + robot.name() + ", " + counted(robot.links().size(), "link") + ", " +
                  counted(robot.variables().size(), "variable") + ", planning frame " + robot.planningFrame());
  for (std::string& line : describeLimitSources(robot))
    lines.push_back(std::move(line));
  lines.push_back("scene: " + counted(scene.objects.size(), "object") +
                  (scene.attached.empty() ? std::string() : ", " + counted(scene.attached.size(), "attached object")));
  lines.push_back("triangles: " + std::to_string(robot.triangleCount()) + " in the robot; " +
                  std::to_string(report.triangles) + " in the " + counted(report.trees, "different shape") +
                  " of robot and scene" +
                  (report.shared_trees ? ", to which " + counted(report.shared_trees, "further shape") +
                                             (report.shared_trees == 1 ? " is" : " are") + " equal"
                                       : ""));
  lines.push_back("checked pairs of bodies: " + std::to_string(report.self_pairs) + " of two links, " +
                  std::to_string(report.world_pairs) + " of a link and an object");
  lines.push_back("left out: " + counted(report.allowed_self_pairs + report.allowed_world_pairs, "pair") +
                  " of bodies that " + matrixText(scene.matrix_source) + ", " +
                  counted(report.links_without_shapes, "link") + " without collision shapes" +
                  (report.touch_pairs ? ", " + counted(report.touch_pairs, "pair") +
                                            " of an attached object and a body that it may touch"
                                      : std::string()) +
                  (report.pairs_outside_group
                       ? ", " + counted(report.pairs_outside_group, "pair") + " of bodies that the group does not move"
                       : std::string()));
  if (report.unreachable_self_pairs + report.unreachable_world_pairs != 0)
    lines.push_back("out of reach: " + counted(report.unreachable_self_pairs, "pair") + " of two links, " +
                    counted(report.unreachable_world_pairs, "pair") + " of a link and an object" +
                    (report.unreachable_objects ? ", which leaves out " + counted(report.unreachable_objects, "object")
                                                : std::string()));
  if (report.rigid_pairs != 0)
    lines.push_back("decided once, because no joint moves their bodies relative to each other: " +
                    counted(report.rigid_pairs, "pair") + " of bodies");
  if (report.always_colliding)
    lines.push_back("in collision in every state: " + scene.bodyName((*report.always_colliding)[0]) + " - " +
                    scene.bodyName((*report.always_colliding)[1]));
  if (!report.colliding_in_samples.empty())
    lines.push_back("in collision in each of " + std::to_string(kSampledStates) +
                    " random states: " + pairList(scene, report.colliding_in_samples));
  if (!report.decided.empty())
    lines.push_back("states decided on the CPU: " + decidedText(report.decided));
  for (const std::string& line : describeOpenParts(scene))
    lines.push_back(line);
  std::transform(lines.begin(), lines.end(), lines.begin(), onOneLine);
  return lines;
}

std::vector<std::string> warningsOfScene(const PlanningScene& scene, const SceneReport& report)
{
  const AllowedCollisionMatrix own = AllowedCollisionMatrix::fromRobot(*scene.robot);
  std::vector<BodyPair> lost;   // pairs that the robot's own matrix allows
  std::vector<BodyPair> other;  // all other pairs
  for (const BodyPair& pair : report.colliding_in_samples)
    (own.allowed(scene.bodyName(pair[0]), scene.bodyName(pair[1])) ? lost : other).push_back(pair);
  const std::string found =
      " in collision in each of " + std::to_string(kSampledStates) + " random states, so probably no state is valid: ";
  std::vector<std::string> lines;
  if (!lost.empty())
    lines.push_back(counted(lost.size(), "pair") + found + pairList(scene, lost) + "; the " +
                    (scene.robot->srdfCollisions().has_srdf ? "SRDF" : "robot's own matrix") +
                    " allows them, but an allowed_collision_matrix replaced it: in a scene file, use " +
                    "allowed_collisions, which adds pairs; in a message, send the matrix of get_planning_scene with "
                    "your entries added");
  if (!other.empty())
  {
    const auto links = static_cast<std::int32_t>(scene.robot->links().size());
    const bool are_links = std::all_of(other.begin(), other.end(),
                                       [links](const BodyPair& pair) { return pair[0] < links && pair[1] < links; });
    const std::int32_t first_carried = links + static_cast<std::int32_t>(scene.objects.size());
    const bool is_carried = std::any_of(other.begin(), other.end(),
                                        [first_carried](const BodyPair& pair) { return pair[1] >= first_carried; });
    const SrdfCollisions& srdf = scene.robot->srdfCollisions();
    // If OLD disables pairs at all, generate_acm keeps the pairs that it checks.
    const std::string old = !srdf.has_srdf                                   ? ""
                            : srdf.disabled.empty() && srdf.unproven.empty() ? "--srdf OLD "
                                                                             : "--srdf OLD --drop-checked ";
    lines.push_back(
        counted(other.size(), "pair") + found + pairList(scene, other) +
        (are_links ? "; these are links of the robot: generate_acm " + old +
                         "--out NEW makes an SRDF that allows the pairs that always collide"
                   : std::string("; move these bodies apart") +
                         (is_carried ? ", or name the links that hold a carried object in its touch_links" : "")) +
        remedyOfRigid(scene, other));
  }
  if (const std::string body = bodyOutOfRange(scene); !body.empty())
    lines.push_back("'" + body +
                    "' is more than 1 km from the origin of the planning frame, where answers are not guaranteed to be "
                    "exact, because doubles round poses more coarsely there; choose a planning frame near the robot's "
                    "work");
  std::transform(lines.begin(), lines.end(), lines.begin(), onOneLine);
  return lines;
}

void PairCounts::add(const BatchResult& result)
{
  for (std::size_t i = 0; i < result.valid.size(); ++i)
    if (!result.valid[i])
      ++counts_[std::minmax(result.colliding[i][0], result.colliding[i][1])];
}

std::vector<std::string> PairCounts::describe(const PlanningScene& scene, std::size_t limit) const
{
  if (counts_.empty())
    return {};
  std::vector<std::pair<std::size_t, std::pair<int, int>>> sorted;
  for (const auto& [pair, count] : counts_)
    sorted.push_back({count, pair});
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> lines{"states in collision, by the pair that was found first:"};
  std::size_t others = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (i < limit)
      lines.push_back("  " + scene.bodyName(sorted[i].second.first) + " - " + scene.bodyName(sorted[i].second.second) +
                      ": " + counted(sorted[i].first, "state"));
    else
      others += sorted[i].first;
  if (others != 0)
    lines.push_back("  other pairs: " + counted(others, "state"));
  return lines;
}
}  // namespace gpu_planning_scene::core
