// Part of the lane kernel, see lane_kernel_body.h: the balls of two covers, in one state, eight balls side by side.
#pragma once

#include "collision/cpu/lanes/lane_distances.h"

namespace gpu_planning_scene::core::lanes
{
namespace
{
/// The distance between arrays of coordinates of placed balls.
constexpr std::ptrdiff_t kAxis = kBalls;

/// The balls of the instances in one lane, in the planning frame.
class PlacedBalls
{
 public:
  PlacedBalls(const Model& model, const Scratch& scratch, int lane) : model_(model), scratch_(scratch), lane_(lane)
  {
    for (std::uint32_t b = 0; b < model.instances.count; ++b)
      scratch.placed[b] = 0;
  }

  /// Coordinates x, y, z in arrays of kBalls: the outer balls, then the inner ones.
  const float* of(std::uint32_t instance, int level) const
  {
    float* placed = scratch_.balls + std::size_t{kBallNumbers} * instance;
    if ((scratch_.placed[instance] & (1 << level)) == 0)
    {
      const Instance& shape = model_.instances[instance];
      place(shape.frame, shape.outer_balls, level, placed);
      if (!shape.same_centers)
        place(shape.frame, shape.inner_balls, level, placed + 3 * kAxis);
      scratch_.placed[instance] = static_cast<std::uint8_t>(scratch_.placed[instance] | (1 << level));
    }
    return placed;
  }
  const float* innerOf(std::uint32_t instance, int level) const
  {
    return of(instance, level) + (model_.instances[instance].same_centers ? 0 : 3 * kAxis);
  }

  float center(std::size_t instance, std::size_t axis) const
  {
    return group(scratch_.centers, 3 * instance + axis)[lane_];
  }

 private:
  void place(int frame, const Balls& balls, int level, float* placed) const
  {
    float pose[12];
    for (std::size_t k = 0; k < 12; ++k)
      pose[k] = group(scratch_.frames, 12 * static_cast<std::size_t>(frame) + k)[lane_];
    for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
    {
      const Floats x = load(balls.x + i);
      const Floats y = load(balls.y + i);
      const Floats z = load(balls.z + i);
      for (std::size_t row = 0; row < 3; ++row)
        store(pose[4 * row] * x + pose[4 * row + 1] * y + pose[4 * row + 2] * z + pose[4 * row + 3],
              placed + row * kAxis + i);
    }
  }

  const Model& model_;
  const Scratch& scratch_;
  int lane_;
};

inline Points pointsAt(const float* placed, int i)
{
  return {load(placed + i), load(placed + kAxis + i), load(placed + 2 * kAxis + i)};
}

inline Proof proveWorldPair(const Model& model, const WorldPair& pair, float margin, const PlacedBalls& balls,
                            int level)
{
  const Instance& instance = model.instances[pair.instance];
  const Object& object = model.objects[pair.object];
  const float* outer = balls.of(pair.instance, level);
  const float* inner = balls.innerOf(pair.instance, level);
  const float cover = pair.thresholds.cover + margin;
  Ints near = {};
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Floats squared = squaredDistanceTo(object, pointsAt(outer, i));
    const Floats apart = load(instance.outer_balls.radius + i) + cover;
    near |= ~(squared > apart * apart);
    if (object.kind == ObjectKind::BoundingBox)
      continue;
    const Floats within = load(instance.inner_balls.radius + i) + pair.thresholds.inner;
    const Floats squared_inner = instance.same_centers ? squared : squaredDistanceTo(object, pointsAt(inner, i));
    if (bits((within > 0.0F) & (squared_inner < within * within)) != 0)
      return Proof::Colliding;
  }
  return bits(near) == 0 ? Proof::Apart : Proof::None;
}

/// The balls of `b` on a level that are near the balls of `a` on the first level. Returns their number.
inline int nearBalls(const Instance& a, const float* balls_of_a, const Instance& b, const float* balls_of_b,
                     float threshold, int level, int* near)
{
  int count = 0;
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Points points = pointsAt(balls_of_b, i);
    const Floats reach = load(b.outer_balls.radius + i) + threshold;
    Ints is_near = {};
    for (int j = 0; j < kLevelBegin[1]; ++j)
    {
      const Points other = {all(balls_of_a[j]), all(balls_of_a[kAxis + j]), all(balls_of_a[2 * kAxis + j])};
      const Floats sum = reach + a.outer_balls.radius[j];
      is_near |= ~(squaredDistance(points, other) > sum * sum);
    }
    for (int left = bits(is_near); left != 0; left &= left - 1)
      near[count++] = i + __builtin_ctz(static_cast<unsigned>(left));
  }
  return count;
}

/// Proves a verdict with the balls of each instance that are near the other instance.
inline Proof proveSelfPair(const Model& model, const SelfPair& pair, float margin, const PlacedBalls& balls, int level)
{
  const Instance& a = model.instances[pair.a];
  const Instance& b = model.instances[pair.b];
  const float cover = pair.thresholds.cover + margin;
  const float* outer_a = balls.of(pair.a, level);
  const float* inner_a = balls.innerOf(pair.a, level);
  const float* outer_b = balls.of(pair.b, level);
  const float* inner_b = balls.innerOf(pair.b, level);
  const Points center_b = {all(balls.center(pair.b, 0)), all(balls.center(pair.b, 1)), all(balls.center(pair.b, 2))};

  int near_b[kMostBalls];
  const int near_count = nearBalls(a, balls.of(pair.a, 0), b, outer_b, cover, level, near_b);
  if (near_count == 0)
    return Proof::Apart;
  Ints near = {};
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Points points = pointsAt(outer_a, i);
    const Floats reach = load(a.outer_balls.radius + i) + (b.outer + cover);
    if (bits(~(squaredDistance(points, center_b) > reach * reach)) == 0)
      continue;
    const Points witnesses = a.same_centers ? points : pointsAt(inner_a, i);
    const Floats apart = load(a.outer_balls.radius + i) + cover;
    const Floats within = load(a.inner_balls.radius + i) + pair.thresholds.inner;
    for (int k = 0; k < near_count; ++k)
    {
      const int j = near_b[k];
      const Points other = {all(outer_b[j]), all(outer_b[kAxis + j]), all(outer_b[2 * kAxis + j])};
      const Floats squared = squaredDistance(points, other);
      const Floats sum = apart + b.outer_balls.radius[j];
      near |= ~(squared > sum * sum);
      const Floats inner_sum = within + b.inner_balls.radius[j];
      const Points other_witness = {all(inner_b[j]), all(inner_b[kAxis + j]), all(inner_b[2 * kAxis + j])};
      const Floats squared_inner =
          a.same_centers && b.same_centers ? squared : squaredDistance(witnesses, other_witness);
      if (bits((inner_sum > 0.0F) & (squared_inner < inner_sum * inner_sum)) != 0)
        return Proof::Colliding;
    }
  }
  return bits(near) == 0 ? Proof::Apart : Proof::None;
}

/// Whether a test is worthwhile: it decides the pair often enough, or too little is known, or it is time to try again.
/// A test takes about 1 / kWorth of the time of the exact test.
inline bool isWorthwhile(Trial& trial, int test)
{
  constexpr unsigned kWorth[kTests] = {20, 25, 6};
  constexpr unsigned kFewTrials = 32;
  constexpr unsigned kAgain = 64;
  return trial.tried < kFewTrials || trial.decided * kWorth[test] >= trial.tried || ++trial.left_out % kAgain == 0;
}

inline void record(bool decided, Trial& trial)
{
  constexpr unsigned kManyTrials = 4096;
  if (++trial.tried == kManyTrials)  // so that the latest trials count most
  {
    trial.tried /= 2;
    trial.decided /= 2;
  }
  trial.decided = static_cast<std::uint16_t>(trial.decided + (decided ? 1 : 0));
}
}  // namespace
}  // namespace gpu_planning_scene::core::lanes
