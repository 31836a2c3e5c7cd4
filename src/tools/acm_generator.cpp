#include "tools/acm_generator.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "base/parallel_for.h"
#include "collision/bounds/reach.h"
#include "collision/exact/forest_cache.h"
#include "tools/pair_sampler.h"
#include "tools/progress_bar.h"
#include "tools/separation_proof.h"

// Counts in random states how often each pair of links collides, as MoveIt's Setup Assistant does (D. Coleman, I.
// Sucan, S. Chitta, N. Correll: Reducing the Barrier to Entry of Complex Robotic Software: a MoveIt! Case Study, 2014).
// The Assistant disables each pair that collides in no random state; here, such a pair also needs a proof.
namespace gpu_planning_scene::core
{
namespace
{
constexpr DisabledReason kReasons[] = {DisabledReason::Adjacent, DisabledReason::Default, DisabledReason::Always,
                                       DisabledReason::Never};

BodyPair ordered(int first, int second)
{
  return {std::min(first, second), std::max(first, second)};
}

std::set<BodyPair> adjacentPairs(const RobotModel& robot)
{
  std::set<BodyPair> pairs;
  for (const auto& [first, second] : robot.adjacentLinks())
    pairs.insert(ordered(first, second));
  return pairs;
}

/// Pairs that the SRDF enables, or disables by default or for a reason of the user's own.
std::set<BodyPair> usersPairs(const RobotModel& robot)
{
  const SrdfCollisions& srdf = robot.srdfCollisions();
  std::set<BodyPair> pairs;
  for (const LinkPair& pair : srdf.enabled)
    pairs.insert(ordered(pair.first, pair.second));
  for (const LinkPair& pair : srdf.disabled)
    if (isUsersReason(pair.reason))
      pairs.insert(ordered(pair.first, pair.second));
  AllowedCollisionMatrix defaults;
  for (const int link : srdf.disabled_by_default)
    defaults.setDefault(robot.links()[static_cast<std::size_t>(link)].name, true);
  for (const int link : srdf.disabled_by_default)
    for (int other = 0; other < static_cast<int>(robot.links().size()); ++other)
      if (other != link && defaults.allowed(robot.links()[static_cast<std::size_t>(link)].name,
                                            robot.links()[static_cast<std::size_t>(other)].name))
        pairs.insert(ordered(link, other));
  return pairs;
}

/// The pairs of links with collision shapes, ascending.
std::vector<BodyPair> pairsOf(const RobotModel& robot)
{
  std::vector<BodyPair> pairs;
  const int links = static_cast<int>(robot.links().size());
  for (int first = 0; first < links; ++first)
    for (int second = first + 1; second < links; ++second)
      if (!robot.links()[static_cast<std::size_t>(first)].shapes.empty() &&
          !robot.links()[static_cast<std::size_t>(second)].shapes.empty())
        pairs.push_back({first, second});
  return pairs;
}

/// The pairs of `candidates` that Reach proves apart.
std::set<BodyPair> provenByReach(const RobotModel& robot, const std::vector<BodyPair>& candidates)
{
  const Reach reach(robot);
  std::vector<SweptBody> swept;
  for (std::size_t link = 0; link < robot.links().size(); ++link)
    swept.push_back(reach.sweep(robot.links()[link].shapes, Eigen::Isometry3d::Identity(), static_cast<int>(link)));
  std::set<BodyPair> proven;
  for (const BodyPair& pair : candidates)
    if (!reach.mayMeet(swept[static_cast<std::size_t>(pair[0])], swept[static_cast<std::size_t>(pair[1])], 0.0))
      proven.insert(pair);
  return proven;
}

/// The pairs of the sampler, except those of `hits`, that SeparationProver proves apart, on all cores.
std::set<BodyPair> provenByJointRanges(const std::shared_ptr<const RobotModel>& robot, const PairSampler& sampler,
                                       const std::shared_ptr<const CpuForest>& forest, const HitCounts& hits,
                                       std::size_t most_tests)
{
  std::map<BodyPair, std::vector<InstancePair>> instances;
  for (const InstancePair& pair : sampler.problem().self_pairs)
    if (const BodyPair links = bodiesOf(sampler.problem(), pair); hits.count(links) == 0)
      instances[links].push_back(pair);
  const std::vector<std::pair<BodyPair, std::vector<InstancePair>>> candidates(instances.begin(), instances.end());
  std::set<BodyPair> proven;
  std::size_t done = 0;
  std::mutex mutex;  // guards `proven`, `done` and the progress bar
  ProgressBar progress("proving pairs apart", candidates.size());
  parallelFor(candidates.size(), 1,
              [&](std::size_t begin, std::size_t end)
              {
                SeparationProver prover(robot, sampler.problem(), forest);
                for (std::size_t i = begin; i < end; ++i)
                {
                  const auto& [links, pairs] = candidates[i];
                  const bool apart = std::all_of(pairs.begin(), pairs.end(),
                                                 [&, count = pairs.size()](const InstancePair& pair) {
                                                   return prover.prove(pair, most_tests / count) == Separation::Apart;
                                                 });
                  const std::lock_guard<std::mutex> lock(mutex);
                  if (apart)
                    proven.insert(links);
                  progress.update(++done);
                }
              });
  return proven;
}

constexpr std::size_t kStatesAtOnce = 1024;

/// Counts in random states. `first` checks the first kStatesAtOnce of them, `others` the others.
HitCounts countInRandomStates(const RobotModel& robot, const PairSampler& first, const PairSampler& others,
                              const GeneratorOptions& options)
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

/// Takes the decided pairs, with regard to the matrix of the robot's SRDF.
class MatrixBuilder
{
 public:
  MatrixBuilder(const RobotModel& robot, bool drop_checked)
    : robot_(robot), old_(AllowedCollisionMatrix::fromRobot(robot)), drop_checked_(drop_checked)
  {
    const SrdfCollisions& srdf = robot.srdfCollisions();
    for (const LinkPair& pair : srdf.unproven)
      old_.setEntry(robot.links()[static_cast<std::size_t>(pair.first)].name,
                    robot.links()[static_cast<std::size_t>(pair.second)].name, true);
    // An SRDF without disabled pairs has only groups and states. Nobody has decided which pairs to check.
    has_old_ = !srdf.disabled.empty() || !srdf.unproven.empty() || !srdf.disabled_by_default.empty();
  }

  void disable(const DisabledPair& pair)
  {
    const bool checked_before = has_old_ && !isDisabledBefore(pair.first, pair.second);
    if (checked_before)
      matrix_.checked_by_srdf.push_back(pair);
    if (checked_before && !drop_checked_)
      ++matrix_.remaining_pairs;
    else
      matrix_.disabled.push_back(pair);
  }

  void check(const BodyPair& pair, double colliding_share, std::size_t states)
  {
    ++matrix_.remaining_pairs;
    if (has_old_ && isDisabledBefore(pair[0], pair[1]))
      matrix_.no_longer_disabled.push_back({pair[0], pair[1], colliding_share, states});
  }

  GeneratedMatrix& matrix() { return matrix_; }

 private:
  bool isDisabledBefore(int first, int second) const
  {
    return old_.allowed(robot_.links()[static_cast<std::size_t>(first)].name,
                        robot_.links()[static_cast<std::size_t>(second)].name);
  }

  const RobotModel& robot_;
  AllowedCollisionMatrix old_;
  bool has_old_ = false;
  bool drop_checked_;
  GeneratedMatrix matrix_;
};
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

GeneratedMatrix generateMatrix(std::shared_ptr<const RobotModel> robot, const GeneratorOptions& options)
{
  const std::set<BodyPair> adjacent = adjacentPairs(*robot);
  const std::set<BodyPair> users = usersPairs(*robot);
  const std::vector<BodyPair> pairs = pairsOf(*robot);
  const std::set<BodyPair> unreachable = provenByReach(*robot, pairs);
  // Random states are checked for undecided pairs only: links that always touch take most of the time.
  AllowedCollisionMatrix decided;
  const auto decide = [&](const BodyPair& pair)
  {
    decided.setEntry(robot->links()[static_cast<std::size_t>(pair[0])].name,
                     robot->links()[static_cast<std::size_t>(pair[1])].name, true);
  };
  for (const std::set<BodyPair>* known : {&adjacent, &users, &unreachable})
    std::for_each(known->begin(), known->end(), decide);
  ForestCache trees;
  HitCounts in_default_state;
  const PairSampler undecided(robot, decided, trees);
  undecided.add(robot->defaultState(), 1, in_default_state);
  for (const auto& [pair, count] : in_default_state)
    decide(pair);
  const PairSampler others(robot, decided, trees);
  const HitCounts hits = countInRandomStates(*robot, undecided, others, options);
  const std::set<BodyPair> separated = provenByJointRanges(robot, others, trees.forest(), hits, options.proof_tests);
  // Pairs that collide in the default state are only checked in the first random states.
  const std::size_t first = std::min(kStatesAtOnce, options.samples);

  MatrixBuilder builder(*robot, options.drop_checked);
  for (const BodyPair& pair : pairs)
  {
    if (users.count(pair) != 0)
      continue;
    const auto hit = hits.find(pair);
    const bool at_default = in_default_state.count(pair) != 0;
    const std::size_t states = at_default ? first : options.samples;
    const double share = hit == hits.end() ? 0.0 : static_cast<double>(hit->second) / static_cast<double>(states);
    DisabledPair found{pair[0], pair[1], DisabledReason::Adjacent};
    found.free_share = 1.0 - share;
    if (adjacent.count(pair) != 0)
      builder.disable(found);
    else if (unreachable.count(pair) != 0 || separated.count(pair) != 0)
    {
      found.reason = DisabledReason::Never;
      found.proof = unreachable.count(pair) != 0 ? NeverProof::Reach : NeverProof::JointRanges;
      builder.disable(found);
    }
    else if (hit != hits.end() && share >= options.always_share)
    {
      found.reason = at_default ? DisabledReason::Default : DisabledReason::Always;
      builder.disable(found);
    }
    else
    {
      builder.check(pair, share, states);
      if (at_default)
        builder.matrix().colliding_in_default_state.push_back({pair[0], pair[1], share, states});
      else if (hit == hits.end())
        builder.matrix().unproven.emplace_back(pair[0], pair[1]);
    }
  }
  return std::move(builder.matrix());
}
}  // namespace gpu_planning_scene::core
