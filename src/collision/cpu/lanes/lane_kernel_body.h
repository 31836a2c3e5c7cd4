// The source of the lane kernel, included once for each instruction set, see lane_kernel.h.
//
// Eight states are checked side by side (as in Thomason, Kingston and Kavraki, "Motions in microseconds via vectorized
// sampling-based planning", 2024), first by joint tables, enclosing balls and boxes. The few pairs that remain are
// checked one state at a time, with eight balls side by side.
#ifndef GPS_LANE_KERNEL
#error "define the kernel's name before this file is included"
#endif

#include "collision/cpu/lanes/lane_boxes.h"
#include "collision/cpu/lanes/lane_covers.h"

namespace gpu_planning_scene::core::lanes
{
namespace
{
/// The proofs of all lanes of a block, and the pairs that are still open.
struct Lanes
{
  int active;  ///< bits: lanes with a state that is not known to collide
  Block& block;
  OpenPair* open;
  std::uint32_t open_count = 0;
  Stage stage = Stage::JointTables;
  std::uint64_t since = 0;

  /// Begins a stage, and adds the time since the last call to the stage before it.
  void begin(Stage next)
  {
    if (block.clock)
    {
      const std::uint64_t now = block.clock();
      block.nanoseconds[static_cast<std::size_t>(stage)] += since == 0 ? 0 : now - since;
      since = now;
    }
    stage = next;
  }
  void collide(int lanes, std::uint32_t pair)
  {
    lanes &= active;
    active &= ~lanes;
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(static_cast<unsigned>(lanes));
      block.proof[lane] = Proof::Colliding;
      block.pair[lane] = pair;
      block.stage[lane] = stage;
    }
  }
  /// Without a branch, which would often be mispredicted.
  void keepOpen(int lanes, std::uint32_t pair)
  {
    lanes &= active;
    open[open_count] = {pair, static_cast<std::uint32_t>(lanes)};
    open_count += lanes != 0 ? 1 : 0;
  }
  /// Writes the open pairs of a lane.
  int listOpen(int lane, std::uint32_t* list) const
  {
    int count = 0;
    for (std::uint32_t k = 0; k < open_count; ++k)
    {
      list[count] = open[k].pair;
      count += static_cast<int>(open[k].lanes >> lane & 1U);
    }
    return count;
  }
};

inline Proof lookUp(const Table& table, const double* state)
{
  int cell = 0;
  for (int k = 0; k < table.variables; ++k)
  {
    const TableAxis& variable = table.variable[k];
    const double value = variable.wraps ? wrapped(state[variable.variable]) : state[variable.variable];
    const double place = (value - variable.lower) * variable.cells_per_unit;
    if (!(place >= 0.0 && place < variable.cells))
      return Proof::None;
    cell = cell * variable.cells + static_cast<int>(place);
  }
  return table.cells[cell];
}

inline void proveByTables(const Model& model, const double* states, Lanes& lanes)
{
  for (std::uint32_t t = 0; t < model.tables.count && lanes.active != 0; ++t)
  {
    const Table& table = model.tables[t];
    int colliding = 0;
    int open = 0;
    for (int left = lanes.active; left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(static_cast<unsigned>(left));
      const Proof proof = lookUp(table, states + static_cast<unsigned>(lane) * model.width);
      colliding |= (proof == Proof::Colliding ? 1 : 0) << lane;
      open |= (proof == Proof::None ? 1 : 0) << lane;
    }
    lanes.collide(colliding, table.pair);
    lanes.keepOpen(open, table.pair);
  }
}

inline float square(float x)
{
  return x * x;
}

/// Margins of the instances and self pairs, if there are any.
template <bool kGiven>
struct MarginRows
{
  const float* rows;

  /// The squared sum of a length and the margins of a row.
  Floats squaredSum(float length, std::size_t row) const
  {
    if constexpr (kGiven)
    {
      const Floats sum = length + load(group(rows, row));
      return sum * sum;
    }
    return all(square(length));
  }
  float of(std::size_t row, int lane) const { return kGiven ? group(rows, row)[lane] : 0.0F; }
  /// Of all lanes.
  Floats of(std::size_t row) const
  {
    if constexpr (kGiven)
      return load(group(rows, row));
    return Floats{};
  }
};

template <bool kWithMargins>
inline void proveSelfPairInAllLanes(const Model& model, const Scratch& scratch, std::uint32_t p,
                                    const MarginRows<kWithMargins>& margins, Lanes& lanes)
{
  const SelfPair& pair = model.self_pairs[p];
  const Instance& a = model.instances[pair.a];
  const Instance& b = model.instances[pair.b];
  const Floats squared = squaredDistance(centersOf(pair.a, scratch), centersOf(pair.b, scratch));
  const Floats apart = margins.squaredSum(a.outer + b.outer + pair.thresholds.enclosing, model.instances.count + p);
  const float inner = a.inner + b.inner + pair.thresholds.inner;
  if (a.inner >= 0.0F && b.inner >= 0.0F && inner > 0.0F)
    lanes.collide(bits(squared < square(inner)), p);
  int open = bits(~(squared > apart)) & lanes.active;
  Trial& trial = scratch.trials[std::size_t{kTests} * p + kBoxTest];
  if (open != 0 && isWorthwhile(trial, kBoxTest))
  {
    const int left = nearByBoxes(model, scratch, pair, margins.of(model.instances.count + p), open);
    record(left != open, trial);
    open = left;
  }
  lanes.keepOpen(open, p);
}

/// Proves self pairs by enclosing balls and boxes, for all lanes at once. Without margins, pairs with tables are left
/// out, and balls around clusters of instances leave out most other pairs.
template <bool kWithMargins>
inline void proveSelfPairsInAllLanes(const Model& model, const Scratch& scratch,
                                     const MarginRows<kWithMargins>& margins, Lanes& lanes)
{
  for (std::uint32_t p = 0; kWithMargins && p < model.tables.count && lanes.active != 0; ++p)
    proveSelfPairInAllLanes(model, scratch, p, margins, lanes);
  for (std::uint32_t g = 0; g < model.self_groups.count && lanes.active != 0; ++g)
  {
    const SelfGroup& group = model.self_groups[g];
    if (!kWithMargins && (bits(~(squaredDistance(centersOf(group.centers[0], scratch),
                                                 centersOf(group.centers[1], scratch)) > square(group.reach))) &
                          lanes.active) == 0)
      continue;
    for (std::uint32_t p = group.first; p < group.end && lanes.active != 0; ++p)
      proveSelfPairInAllLanes(model, scratch, p, margins, lanes);
  }
}

/// Whether a point is farther from a box than the margin along an axis. NaN is not.
inline Ints isBeyond(const FrameBox& box, const Points& point, const Floats& margin)
{
  return (magnitude(point.x - box.center[0]) - margin > box.half[0]) |
         (magnitude(point.y - box.center[1]) - margin > box.half[1]) |
         (magnitude(point.z - box.center[2]) - margin > box.half[2]);
}

/// Proves pairs with the world by boxes and enclosing balls, for all lanes at once.
template <bool kWithMargins>
inline void proveWorldPairsInAllLanes(const Model& model, const Scratch& scratch,
                                      const MarginRows<kWithMargins>& margins, Lanes& lanes)
{
  for (std::uint32_t g = 0; g < model.world_groups.count && lanes.active != 0; ++g)
  {
    const WorldGroup& group = model.world_groups[g];
    const Instance& instance = model.instances[group.instance];
    const Points center = centersOf(group.instance, scratch);
    const Floats to_group = squaredDistanceToBox(center.x - group.box.center[0], center.y - group.box.center[1],
                                                 center.z - group.box.center[2], group.box.half);
    if ((bits(~(to_group > margins.squaredSum(instance.outer, group.instance))) & lanes.active) == 0)
      continue;
    // The boxes of the pairs are tested without a branch, which would often be mispredicted.
    std::uint32_t near = 0;  // bits: pairs of the group
    for (std::uint32_t w = group.first; w < group.end; ++w)
    {
      const int inside = bits(~isBeyond(model.world_pairs[w].box, center, margins.of(group.instance)));
      near |= ((inside & lanes.active) != 0 ? 1U : 0U) << (w - group.first);
    }
    for (; near != 0 && lanes.active != 0; near &= near - 1)
    {
      const std::uint32_t w = group.first + static_cast<std::uint32_t>(__builtin_ctz(near));
      const WorldPair& pair = model.world_pairs[w];
      const Object& object = model.objects[pair.object];
      const std::uint32_t number = model.self_pairs.count + w;
      const Floats squared = squaredDistanceTo(object, center);
      const float inner = instance.inner + pair.thresholds.inner;
      if (instance.inner >= 0.0F && inner > 0.0F && object.kind != ObjectKind::BoundingBox)
        lanes.collide(bits(squared < square(inner)), number);
      const Floats apart = margins.squaredSum(instance.outer + pair.thresholds.enclosing, group.instance);
      lanes.keepOpen(bits(~(squared > apart)), number);
    }
  }
}

/// Room for the open pairs of one lane.
inline std::uint32_t* openOf(const Model& model, const Scratch& scratch, int lane)
{
  return scratch.open + static_cast<std::size_t>(lane) * (model.self_pairs.count + model.world_pairs.count);
}

/// Proves the open pairs of one lane by the balls of the covers, the coarse ones first.
template <bool kWithMargins>
inline void proveByCovers(const Model& model, const Scratch& scratch, const MarginRows<kWithMargins>& margins, int lane,
                          Lanes& lanes)
{
  const auto prove = [&](std::uint32_t number, const PlacedBalls& balls, int level)
  {
    if (number < model.self_pairs.count)
      return proveSelfPair(model, model.self_pairs[number], margins.of(model.instances.count + number, lane), balls,
                           level);
    const WorldPair& pair = model.world_pairs[number - model.self_pairs.count];
    return proveWorldPair(model, pair, margins.of(pair.instance, lane), balls, level);
  };
  const PlacedBalls balls(model, scratch, lane);
  std::uint32_t* open = openOf(model, scratch, lane);
  for (int level = 0; level < kLevels && lanes.block.open_count[lane] > 0; ++level)
  {
    lanes.begin(level == 0 ? Stage::FewBalls : Stage::ManyBalls);
    lanes.block.stage[lane] = lanes.stage;
    int kept = 0;
    for (int k = 0; k < lanes.block.open_count[lane]; ++k)
    {
      const std::uint32_t number = open[k];
      const int test = kBoxTest + 1 + level;
      Trial& trial = scratch.trials[std::size_t{kTests} * number + static_cast<std::size_t>(test)];
      if (!isWorthwhile(trial, test))
      {
        open[kept++] = number;
        continue;
      }
      const Proof proof = prove(number, balls, level);
      record(proof != Proof::None, trial);
      if (proof == Proof::Colliding)
        return lanes.collide(1 << lane, number);
      if (proof == Proof::None)
        open[kept++] = number;
    }
    lanes.block.open_count[lane] = kept;
  }
}

template <bool kWithMargins>
inline void proveBlock(const Model& model, const double* states, int count, const MarginRows<kWithMargins>& margins,
                       const Scratch& scratch, Block& block)
{
  Lanes lanes{(1 << count) - 1, block, scratch.open_pairs};
  for (int lane = 0; lane < kLanes; ++lane)
  {
    block.proof[lane] = Proof::Apart;
    block.open_count[lane] = 0;
    block.stage[lane] = Stage::EnclosingBalls;
  }
  lanes.begin(Stage::JointTables);
  if constexpr (!kWithMargins)
    proveByTables(model, states, lanes);
  lanes.begin(Stage::EnclosingBalls);
  if (lanes.active == 0)
    return;
  placeFrames(model, states, count, scratch);
  placeCenters(model, scratch);
  for (std::uint32_t i = 0; i < model.instances.count; ++i)
    scratch.placed_boxes[i] = 0;
  proveSelfPairsInAllLanes(model, scratch, margins, lanes);
  proveWorldPairsInAllLanes(model, scratch, margins, lanes);
  for (int left = lanes.active; left != 0; left &= left - 1)
  {
    const int lane = __builtin_ctz(static_cast<unsigned>(left));
    block.open_count[lane] = lanes.listOpen(lane, openOf(model, scratch, lane));
  }
  for (int lane = 0; lane < count; ++lane)
  {
    if ((lanes.active & (1 << lane)) == 0 || block.open_count[lane] == 0)
      continue;
    proveByCovers(model, scratch, margins, lane, lanes);
    if (block.proof[lane] != Proof::Colliding && block.open_count[lane] > 0)
    {
      block.proof[lane] = Proof::None;
      block.stage[lane] = Stage::ExactPairs;
    }
  }
  lanes.begin(Stage::ExactPairs);
}
}  // namespace

void GPS_LANE_KERNEL(const Model& model, const double* states, int count, const float* margins, const Scratch& scratch,
                     Block& block)
{
  if (margins)
    proveBlock(model, states, count, MarginRows<true>{margins}, scratch, block);
  else
    proveBlock(model, states, count, MarginRows<false>{nullptr}, scratch, block);
}
}  // namespace gpu_planning_scene::core::lanes
