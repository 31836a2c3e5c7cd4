#include "tools/acm_generator.h"

#include <algorithm>
#include <map>
#include <set>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/parallel_for.h"
#include "collision/problem/collision_problem.h"
#include "tools/progress_bar.h"

// Counts in random states how often each pair of links collides, as MoveIt's Setup Assistant does (D. Coleman, I.
// Sucan, S. Chitta, N. Correll: Reducing the Barrier to Entry of Complex Robotic Software: a MoveIt! Case Study, 2014).
// Pairs that are adjacent or collide in the default state are decided first and not sampled.
namespace gpu_planning_scene::core
{
namespace
{
using HitCounts = std::map<BodyPair, std::size_t>;

constexpr DisabledReason kReasons[] = {DisabledReason::Adjacent, DisabledReason::Default, DisabledReason::Always,
                                       DisabledReason::Never};

BodyPair ordered(int first, int second)
{
  return {std::min(first, second), std::max(first, second)};
}

/// Counts for each pair of links in how many states it collides. A StateChecker reports only one pair per state, so
/// this class uses the exact checker's traversal, which finds all pairs.
class PairSampler
{
 public:
  /// Leaves out the pairs that `decided` allows. `trees` keeps the trees of the links for the next sampler.
  PairSampler(std::shared_ptr<const RobotModel> robot, const AllowedCollisionMatrix& decided, ForestCache& trees)
    : robot_(std::move(robot))
  {
    PlanningScene scene(robot_);
    scene.allowed_collisions = decided;
    traversal_ = trees.traversalOf(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr)));
  }

  void add(const std::vector<double>& states, std::size_t count, HitCounts& counts) const
  {
    const std::size_t width = robot_->variables().size();
    std::vector<std::vector<BodyPair>> hits(count);
    parallelFor(count, 16,
                [&, scratch = CpuTraversal::Scratch(), poses = std::vector<Eigen::Isometry3d>(robot_->links().size())](
                    std::size_t begin, std::size_t end) mutable
                {
                  for (std::size_t i = begin; i < end; ++i)
                  {
                    robot_->linkPoses(states.data() + i * width, poses.data());
                    hits[i] = traversal_->allCollisions(poses.data(), scratch);
                  }
                });
    for (const auto& pairs : hits)
      for (const BodyPair& pair : pairs)
        ++counts[ordered(pair[0], pair[1])];
  }

 private:
  std::shared_ptr<const RobotModel> robot_;
  std::unique_ptr<const CpuTraversal> traversal_;
};

constexpr std::size_t kStatesAtOnce = 1024;

/// Counts in random states. `first` checks the first kStatesAtOnce of them, `others` the others.
HitCounts countInRandomStates(const RobotModel& robot, const PairSampler& first, const PairSampler& others,
                              const SamplingOptions& options)
{
  const std::size_t width = robot.variables().size();
  HitCounts counts;
  std::mt19937_64 generator(options.seed);
  ProgressBar progress("sampling", options.samples);
  for (std::size_t done = 0; done < options.samples;)
  {
    const std::size_t count = std::min(kStatesAtOnce, options.samples - done);
    std::vector<double> states(count * width);
    for (std::size_t i = 0; i < count; ++i)
      robot.randomState(generator, states.data() + i * width);
    (done == 0 ? first : others).add(states, count, counts);
    done += count;
    progress.update(done);
  }
  return counts;
}

/// Pairs that the SRDF enables, or disables for a reason of the user's own.
std::set<BodyPair> usersPairs(const SrdfCollisions& srdf)
{
  std::set<BodyPair> pairs;
  for (const LinkPair& pair : srdf.enabled)
    pairs.insert(ordered(pair.first, pair.second));
  for (const LinkPair& pair : srdf.disabled)
    if (isUsersReason(pair.reason))
      pairs.insert(ordered(pair.first, pair.second));
  return pairs;
}
}  // namespace

const char* nameOf(DisabledReason reason)
{
  switch (reason)
  {
    case DisabledReason::Adjacent:
      return "Adjacent";
    case DisabledReason::Default:
      return "Default";
    case DisabledReason::Always:
      return "Always";
    case DisabledReason::Never:
      break;
  }
  return "Never";
}

bool isUsersReason(const std::string& reason)
{
  return std::none_of(
      std::begin(kReasons), std::end(kReasons), [&](DisabledReason r) { return reason == nameOf(r); });
}

GeneratedMatrix generateMatrix(std::shared_ptr<const RobotModel> robot, const SamplingOptions& options)
{
  const auto adjacent_links = robot->adjacentLinks();
  const std::set<std::pair<int, int>> adjacent(adjacent_links.begin(), adjacent_links.end());
  const std::set<BodyPair> users = usersPairs(robot->srdfCollisions());
  // Random states are checked for undecided pairs only: links that always touch take most of the time.
  AllowedCollisionMatrix decided;
  const auto decide = [&](int first, int second)
  { decided.setEntry(robot->links()[first].name, robot->links()[second].name, true); };
  for (const auto& [first, second] : adjacent)
    decide(first, second);
  for (const auto& [first, second] : users)
    decide(first, second);
  ForestCache trees;
  HitCounts in_default_state;
  const PairSampler undecided(robot, decided, trees);
  undecided.add(robot->defaultState(), 1, in_default_state);
  for (const auto& [pair, count] : in_default_state)
    decide(pair[0], pair[1]);
  const HitCounts hits = countInRandomStates(*robot, undecided, PairSampler(robot, decided, trees), options);
  const double always = options.always_share * static_cast<double>(options.samples);
  // Pairs that collide in the default state are only checked in the first random states.
  const double always_of_first = options.always_share * static_cast<double>(std::min(kStatesAtOnce, options.samples));

  GeneratedMatrix matrix;
  const int links = static_cast<int>(robot->links().size());
  for (int first = 0; first < links; ++first)
  {
    for (int second = first + 1; second < links; ++second)
    {
      if (robot->links()[first].shapes.empty() || robot->links()[second].shapes.empty() ||
          users.count({first, second}) != 0)
        continue;
      const auto hit = hits.find({first, second});
      if (adjacent.count({first, second}) != 0)
        matrix.disabled.push_back({first, second, DisabledReason::Adjacent});
      else if (in_default_state.count({first, second}) != 0)
      {
        const double count = hit == hits.end() ? 0.0 : static_cast<double>(hit->second);
        if (count >= always_of_first)
          matrix.disabled.push_back({first, second, DisabledReason::Default});
        else
          matrix.colliding_in_default_state.emplace_back(first, second);
      }
      else if (hit == hits.end())
        matrix.disabled.push_back({first, second, DisabledReason::Never});
      else if (static_cast<double>(hit->second) >= always)
        matrix.disabled.push_back({first, second, DisabledReason::Always});
      else
        ++matrix.remaining_pairs;
    }
  }
  matrix.remaining_pairs += matrix.colliding_in_default_state.size();
  return matrix;
}
}  // namespace gpu_planning_scene::core
