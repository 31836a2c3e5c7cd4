#include "sphere_audit/scene_audit.h"

#include <algorithm>
#include <set>

#include "benchmark/geometric_error.h"
#include "collision/bounds/problem_maker.h"
#include "collision/exact/exact_checker.h"
#include "collision/trees/binned_sah.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
/// All pairs of bodies that collide in a state, by the exact checker's tests.
class CollidingPairs
{
 public:
  explicit CollidingPairs(PlanningScene scene)
    : scene_(std::move(scene)),
      problem_(std::make_shared<const CollisionProblem>(makeProblem(scene_, "", nullptr))),
      exact_(problem_, std::make_shared<const CpuForest>(*problem_, buildBinnedSah(problem_->tessellations)))
  {
  }

  std::vector<std::pair<std::string, std::string>> of(const double* state)
  {
    std::vector<Eigen::Isometry3d> poses(scene_.robot->links().size());
    scene_.robot->linkPoses(state, poses.data());
    std::vector<std::pair<std::string, std::string>> names;
    for (const BodyPair& pair : exact_.allCollisions(poses.data(), scratch_))
      names.emplace_back(scene_.bodyName(pair[0]), scene_.bodyName(pair[1]));
    return names;
  }

 private:
  PlanningScene scene_;
  std::shared_ptr<const CollisionProblem> problem_;
  ExactChecker exact_;
  ExactChecker::Scratch scratch_;
};

/// Finds the causes of wrong answers in one scene. Each body is a link or an object of the world.
class Causes
{
 public:
  Causes(const PlanningScene& scene, const VampModel& model)
    : scene_(scene), model_(model), true_(scene), spheres_(withSpheres(scene, model))
  {
  }

  /// A colliding state that VAMP calls free.
  void addMissed(const double* state, WrongAnswers& wrong)
  {
    const auto pairs = true_.of(state);
    const bool checked = std::any_of(pairs.begin(), pairs.end(),
                                     [&](const auto& pair) { return isWithWorld(pair) || vampChecks(pair); });
    add(checked ? Cause::Spheres : Cause::Pairs, pairs, wrong);
  }

  /// A free state that VAMP calls colliding. If VAMP's spheres are free among the true objects, they collide only with
  /// a capsule or a box that replaces a cylinder.
  void addInvented(const double* state, WrongAnswers& wrong)
  {
    const auto pairs = spheres_.of(state);
    const bool in_matrix =
        std::any_of(pairs.begin(), pairs.end(),
                    [&](const auto& pair) { return !scene_.allowed_collisions.allowed(pair.first, pair.second); });
    add(pairs.empty() ? Cause::Cylinders : in_matrix ? Cause::Spheres : Cause::Pairs, pairs, wrong);
  }

 private:
  using Pair = std::pair<std::string, std::string>;

  bool isWithWorld(const Pair& pair) const
  {
    return scene_.robot->linkIndex(pair.first) < 0 || scene_.robot->linkIndex(pair.second) < 0;
  }
  bool vampChecks(const Pair& pair) const { return model_.pairs.count(linkPair(pair.first, pair.second)) != 0; }

  std::string nameOf(const Pair& pair) const
  {
    if (!isWithWorld(pair))
      return pair.first + ", " + pair.second;
    return (scene_.robot->linkIndex(pair.first) < 0 ? pair.second : pair.first) + ", world";
  }

  void add(Cause cause, const std::vector<Pair>& pairs, WrongAnswers& wrong) const
  {
    ++wrong.by_cause[static_cast<std::size_t>(cause)];
    std::set<std::string> names;
    for (const Pair& pair : pairs)
      names.insert(nameOf(pair));
    for (const std::string& name : names)
      ++wrong.by_pair[name];
  }

  const PlanningScene& scene_;
  const VampModel& model_;
  CollidingPairs true_;
  CollidingPairs spheres_;
};

/// Evenly spread.
std::vector<std::size_t> someOf(const std::vector<std::size_t>& all, std::size_t most)
{
  const std::size_t count = std::min(all.size(), most);
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(all[i * all.size() / count]);
  return some;
}

void addTo(WrongAnswers& sum, const WrongAnswers& other)
{
  for (std::size_t i = 0; i < kCauses; ++i)
    sum.by_cause[i] += other.by_cause[i];
  for (const auto& [pair, count] : other.by_pair)
    sum.by_pair[pair] += count;
  sum.sizes.insert(sum.sizes.end(), other.sizes.begin(), other.sizes.end());
}
}  // namespace

void Audit::add(const Audit& other)
{
  states += other.states;
  free += other.free;
  addTo(missed, other.missed);
  addTo(invented, other.invented);
}

SceneAudit::SceneAudit(const std::shared_ptr<const PlanningScene>& first)
  : model_(loadVampModel(*first->robot)), truth_(first)
{
}

Audit SceneAudit::audit(const std::shared_ptr<const PlanningScene>& scene, VampCylinders cylinders,
                        const std::vector<double>& states, std::size_t measured)
{
  const std::size_t width = scene->robot->variables().size();
  Audit result;
  result.states = states.size() / width;
  truth_.setScene(scene);
  const std::vector<std::uint8_t> truth = truth_.check(states.data(), result.states);
  std::vector<std::uint8_t> vamp(result.states);
  VampCheck(*scene, cylinders).check(states.data(), result.states, vamp.data());
  result.free = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 1));

  std::vector<std::size_t> missed;
  std::vector<std::size_t> invented;
  for (std::size_t i = 0; i < result.states; ++i)
    if (vamp[i] != truth[i])
      (vamp[i] != 0 ? missed : invented).push_back(i);
  if (missed.empty() && invented.empty())
    return result;
  Causes causes(*scene, model_);
  for (const std::size_t i : missed)
    causes.addMissed(&states[i * width], result.missed);
  for (const std::size_t i : invented)
    causes.addInvented(&states[i * width], result.invented);
  GeometricError error(*scene);
  for (const std::size_t i : someOf(missed, measured))
    result.missed.sizes.push_back(error.depth(&states[i * width]));
  for (const std::size_t i : someOf(invented, measured))
    result.invented.sizes.push_back(error.clearance(&states[i * width]));
  return result;
}
}  // namespace gpu_planning_scene::core::benchmark
