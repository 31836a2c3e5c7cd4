#include "collision/filter/robot_proofs.h"

#include <algorithm>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMostTables = 1000;  // of a problem; a table takes up to 64 kB and a second

template <class T>
bool isSame(const std::weak_ptr<T>& a, const std::weak_ptr<T>& b)
{
  return !a.owner_before(b) && !b.owner_before(a);
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

std::shared_ptr<const RobotProver::KnownShape> RobotProver::shape(const std::shared_ptr<const CpuTree>& tree,
                                                                  double sagitta)
{
  for (const auto& known : shapes_)
    if (known->tree.lock() == tree)
      return known;
  const ShapeSamples samples = samplesOf(*tree);
  shapes_.push_back(std::make_shared<const KnownShape>(
      KnownShape{tree, std::make_shared<const BallCover>(coverOf(*tree, samples, sagitta)), {samples, sagitta}}));
  return shapes_.back();
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

void RobotProver::prove(const RobotModel& robot, const CollisionProblem& problem,
                        const std::shared_ptr<const CpuForest>& forest, const std::function<void(RobotProofs)>& publish,
                        const std::function<bool()>& stopped)
{
  forgetUnused();
  RobotProofs proofs;
  std::vector<std::shared_ptr<const KnownShape>> shapes;  // of each instance
  for (const ShapeInstance& instance : problem.robot)
  {
    if (stopped())
      return;
    shapes.push_back(shape(forest->shared(instance.tree), problem.tessellations[instance.tree].sagitta));
    proofs.covers.push_back(shapes.back()->cover);
  }
  const auto side = [&](std::uint32_t number)
  {
    const ShapeInstance& instance = problem.robot[number];
    return Side{forest->shared(instance.tree), instance.link, instance.pose};
  };
  // A carried object has a new pose after each grasp, so its tables would seldom be used again.
  const auto is_of_link = [&](std::uint32_t number)
  { return static_cast<std::size_t>(problem.robot[number].body) < robot.links().size(); };
  std::vector<std::size_t> unknown;
  for (const auto& [first, second] : problem.self_pairs)
  {
    const KnownTable* table = known(robot, {side(first), side(second)});
    if (!table && is_of_link(first) && is_of_link(second) && unknown.size() < kMostTables)
      unknown.push_back(proofs.tables.size());
    proofs.tables.push_back(table ? table->table : nullptr);
  }
  publish(proofs);
  if (unknown.empty())
    return;
  const CpuShapePair pairs(forest);
  const auto body = [&](std::uint32_t number)
  {
    const ShapeInstance& instance = problem.robot[number];
    return TableBody{&instance, &forest->tree(instance.tree), shapes[number]->cover.get(), &shapes[number]->depth,
                     problem.tessellations[instance.tree].sagitta};
  };
  for (const std::size_t p : unknown)
  {
    if (stopped())
      return;
    const auto [first, second] = problem.self_pairs[p];
    std::optional<JointTable> made = makeJointTable(robot, body(first), body(second), pairs);
    if (made)
      proofs.tables[p] = std::make_shared<const JointTable>(std::move(*made));
    tables_.push_back({robot.weak_from_this(), {side(first), side(second)}, proofs.tables[p]});
  }
  publish(std::move(proofs));
}
}  // namespace gpu_planning_scene::core
