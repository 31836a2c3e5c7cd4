#include "collision/proofs/robot_proofs.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <utility>

#include "base/parallel_for.h"
#include "collision/proofs/joint_chain.h"

// A cover belongs to a shape. A table belongs to two shapes, their links and the joints between them. Proofs that are
// neither known nor in the cache are made on all cores. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMostTables = 1000;  // of a problem; a table takes up to 64 kB and some seconds

template <class T>
bool isSame(const std::weak_ptr<T>& a, const std::weak_ptr<T>& b)
{
  return !a.owner_before(b) && !b.owner_before(a);
}

/// Calls `work` for the numbers below `count` on all cores, until the work is stopped or paused. Returns whether all
/// calls were made and came to their end.
template <class Work>
bool forEachUntil(const Stopped& stopped, const Stopped& paused, std::size_t count, const Work& work)
{
  std::atomic<bool> is_complete{true};
  parallelFor(count, 1,
              [&](std::size_t i, std::size_t)
              {
                try
                {
                  if (!isStopped(stopped) && (i == 0 || !isStopped(paused)))
                    return work(i);
                }
                catch (const ProofsStopped&)
                {
                  // The proofs that the other threads have made are kept.
                }
                is_complete = false;
              });
  return is_complete;
}
}  // namespace

void RobotProver::forgetUnused()
{
  const auto is_unused = [](const KnownTable& known)
  { return known.robot.expired() || known.sides[0].tree.expired() || known.sides[1].tree.expired(); };
  tables_.erase(std::remove_if(tables_.begin(), tables_.end(), is_unused), tables_.end());
  const auto is_expired = [](const std::shared_ptr<const KnownShape>& known) { return known->tree.expired(); };
  shapes_.erase(std::remove_if(shapes_.begin(), shapes_.end(), is_expired), shapes_.end());
}

/// The record of a shape. It has a cover if the cover is known or in the cache.
std::shared_ptr<RobotProver::KnownShape> RobotProver::shape(const std::shared_ptr<const CpuTree>& tree, double sagitta,
                                                            const ProofCache& cache)
{
  const auto is_it = [&tree](const std::shared_ptr<KnownShape>& known) { return known->tree.lock() == tree; };
  auto found = std::find_if(shapes_.begin(), shapes_.end(), is_it);
  if (found == shapes_.end())
  {
    auto made = std::make_shared<KnownShape>(KnownShape{tree, shapeHash(tree->shape, sagitta), nullptr, {}});
    found = shapes_.insert(shapes_.end(), std::move(made));
  }
  KnownShape& known = **found;
  if (!known.cover)
    if (std::optional<BallCover> cover = cache.cover(coverKey(known.hash)))
      known.cover = std::make_shared<const BallCover>(std::move(*cover));
  return *found;
}

void RobotProver::makeCover(KnownShape& shape, const CpuTree& tree, double sagitta, const ProofCache& cache,
                            const Stopped& stopped)
{
  const ShapeSamples samples = samplesOf(tree, stopped);
  shape.cover = std::make_shared<const BallCover>(coverOf(tree, samples, sagitta, stopped));
  shape.depth.emplace(samples, sagitta);
  cache.store(coverKey(shape.hash), *shape.cover);
}

const RobotProver::KnownTable* RobotProver::known(const RobotModel& robot, const std::array<Side, 2>& sides) const
{
  const auto is_it = [&](const KnownTable& table)
  {
    const auto is_side = [&](std::size_t k)
    {
      return isSame(table.sides[k].tree, sides[k].tree) && table.sides[k].link == sides[k].link &&
             table.sides[k].pose.matrix() == sides[k].pose.matrix();
    };
    return table.robot.lock().get() == &robot && is_side(0) && is_side(1);
  };
  const auto found = std::find_if(tables_.begin(), tables_.end(), is_it);
  return found == tables_.end() ? nullptr : &*found;
}

/// Adds the tables of all self pairs to `found`. Attached objects have no tables: an object has a new pose after each
/// grasp, so its tables would seldom be used again.
void RobotProver::findTables(const RobotModel& robot, const CollisionProblem& problem, const CpuForest& forest,
                             const ProofCache& cache, Found& found)
{
  const auto is_of_link = [&](const ShapeInstance& instance)
  { return static_cast<std::size_t>(instance.body) < robot.links().size(); };
  std::size_t count = 0;
  for (const auto& [first, second] : problem.self_pairs)
  {
    std::shared_ptr<const JointTable>& table = found.proofs.tables.emplace_back();
    const ShapeInstance& a = problem.robot[first];
    const ShapeInstance& b = problem.robot[second];
    if (!is_of_link(a) || !is_of_link(b) || count == kMostTables)
      continue;
    const std::array<Side, 2> sides = {Side{forest.shared(a.tree), a.link, a.pose},
                                       Side{forest.shared(b.tree), b.link, b.pose}};
    if (const KnownTable* known_table = known(robot, sides))
    {
      table = known_table->table;
      count += table ? 1 : 0;
      continue;
    }
    const std::vector<ChainJoint> chain = jointsBetween(robot, a.link, b.link);
    const std::optional<std::vector<TableVariable>> variables = tableVariables(robot, chain);
    if (variables)
    {
      ++count;
      std::string key =
          tableKey(robot, chain, {found.shapes[first]->hash, a.pose}, {found.shapes[second]->hash, b.pose});
      std::optional<JointTable> loaded = cache.table(key, *variables);
      if (!loaded)
      {
        found.missing.push_back({found.proofs.tables.size() - 1, std::move(key)});
        continue;
      }
      table = std::make_shared<const JointTable>(std::move(*loaded));
    }
    tables_.push_back({robot.weak_from_this(), sides, table});
  }
}

/// Makes the missing tables of `found`. Returns whether all were made.
bool RobotProver::makeTables(const RobotModel& robot, const CollisionProblem& problem,
                             const std::shared_ptr<const CpuForest>& forest, const ProofCache& cache, Found& found,
                             const Stopped& stopped, const Stopped& paused)
{
  const auto sagitta_of = [&](const ShapeInstance& instance) { return problem.tessellations[instance.tree].sagitta; };
  std::map<KnownShape*, const ShapeInstance*> without_depth;
  for (const MissingTable& missing : found.missing)
    for (const std::uint32_t number : problem.self_pairs[missing.pair])
      if (!found.shapes[number]->depth)
        without_depth.emplace(found.shapes[number].get(), &problem.robot[number]);
  const std::vector<std::pair<KnownShape*, const ShapeInstance*>> shapes(without_depth.begin(), without_depth.end());
  const auto sample = [&](std::size_t i)
  {
    const auto& [shape, instance] = shapes[i];
    shape->depth.emplace(samplesOf(forest->tree(instance->tree), stopped), sagitta_of(*instance));
  };
  if (!forEachUntil(stopped, paused, shapes.size(), sample))
    return false;

  const CpuShapePair pairs(forest);
  const auto side = [&](std::uint32_t number)
  {
    const ShapeInstance& instance = problem.robot[number];
    const KnownShape& shape = *found.shapes[number];
    return TableInstance{&instance, &forest->tree(instance.tree), shape.cover.get(), &*shape.depth,
                         sagitta_of(instance)};
  };
  std::vector<std::shared_ptr<const JointTable>> made(found.missing.size());
  const auto make = [&](std::size_t i)
  {
    const auto [first, second] = problem.self_pairs[found.missing[i].pair];
    made[i] =
        std::make_shared<const JointTable>(makeJointTable(robot, side(first), side(second), pairs, stopped).value());
    cache.store(found.missing[i].key, *made[i]);
  };
  const bool is_complete = forEachUntil(stopped, paused, found.missing.size(), make);
  for (std::size_t i = 0; i < made.size(); ++i)
    if (made[i])
    {
      const auto [first, second] = problem.self_pairs[found.missing[i].pair];
      const ShapeInstance& a = problem.robot[first];
      const ShapeInstance& b = problem.robot[second];
      tables_.push_back({robot.weak_from_this(),
                         {Side{forest->shared(a.tree), a.link, a.pose}, Side{forest->shared(b.tree), b.link, b.pose}},
                         made[i]});
      found.proofs.tables[found.missing[i].pair] = std::move(made[i]);
    }
  return is_complete;
}

void RobotProver::load(const RobotModel& robot, const CollisionProblem& problem,
                       const std::shared_ptr<const CpuForest>& forest, const ProofCache& cache, const Publish& publish,
                       const Stopped& stopped)
{
  forgetUnused();
  Found found;
  for (const ShapeInstance& instance : problem.robot)
  {
    if (isStopped(stopped))
      return;
    found.shapes.push_back(shape(forest->shared(instance.tree), problem.tessellations[instance.tree].sagitta, cache));
    if (!found.shapes.back()->cover)
      return;
    found.proofs.covers.push_back(found.shapes.back()->cover);
  }
  findTables(robot, problem, *forest, cache, found);
  found.proofs.has_all_tables = found.missing.empty();
  if (found.proofs.has_all_tables)
    publish(std::move(found.proofs));
}

bool RobotProver::prove(const RobotModel& robot, const CollisionProblem& problem,
                        const std::shared_ptr<const CpuForest>& forest, const ProofCache& cache, const Publish& publish,
                        const Stopped& stopped, const Stopped& paused, const RobotProofs* published)
{
  forgetUnused();
  Found found;
  std::map<KnownShape*, const ShapeInstance*> without_cover;
  for (const ShapeInstance& instance : problem.robot)
  {
    if (isStopped(stopped))
      return false;
    found.shapes.push_back(shape(forest->shared(instance.tree), problem.tessellations[instance.tree].sagitta, cache));
    if (!found.shapes.back()->cover)
      without_cover.emplace(found.shapes.back().get(), &instance);
  }
  const std::vector<std::pair<KnownShape*, const ShapeInstance*>> shapes(without_cover.begin(), without_cover.end());
  const auto cover = [&](std::size_t i)
  {
    const auto& [shape, instance] = shapes[i];
    makeCover(*shape, forest->tree(instance->tree), problem.tessellations[instance->tree].sagitta, cache, stopped);
  };
  if (!forEachUntil(stopped, paused, shapes.size(), cover))
    return false;
  for (const std::shared_ptr<KnownShape>& shape : found.shapes)
    found.proofs.covers.push_back(shape->cover);
  findTables(robot, problem, *forest, cache, found);
  bool is_complete = found.missing.empty();
  found.proofs.has_all_tables = is_complete;
  // A checker that gets other proofs makes its lanes again.
  if (!published || !published->isSame(found.proofs))
    publish(found.proofs);
  if (!is_complete)
  {
    const RobotProofs before = found.proofs;
    is_complete = makeTables(robot, problem, forest, cache, found, stopped, paused);
    found.proofs.has_all_tables = is_complete;
    if (!found.proofs.isSame(before))
      publish(std::move(found.proofs));
  }
  if (!shapes.empty() || !found.missing.empty())
    cache.removeOldest();
  return is_complete;
}
}  // namespace gpu_planning_scene::core
