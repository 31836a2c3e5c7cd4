// Part of the lane kernel, see lane_kernel_body.h: the oriented boxes of two instances, in eight states side by side.
#pragma once

#include "collision/cpu/lanes/lane_kinematics.h"
#include "collision/geometry/eight_boxes.h"

namespace gpu_planning_scene::core::lanes
{
namespace
{
/// The scalar product, in all lanes.
inline Floats sumOfProducts(const Floats* a, const Floats* b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The box of an instance in all lanes: groups of kLanes floats, the axes one after another, then the centre. Computed
/// when it is first used in a block.
inline const float* placedBox(const Model& model, const Scratch& scratch, std::uint32_t instance)
{
  float* const placed = group(scratch.boxes, std::size_t{kBoxNumbers} * instance);
  if (scratch.placed_boxes[instance] != 0)
    return placed;
  scratch.placed_boxes[instance] = 1;
  const Box& box = model.instances[instance].box;
  const float* frame = group(scratch.frames, 12 * static_cast<std::size_t>(model.instances[instance].frame));
  for (std::size_t row = 0; row < 3; ++row)
  {
    const Floats x = load(group(frame, 4 * row));
    const Floats y = load(group(frame, 4 * row + 1));
    const Floats z = load(group(frame, 4 * row + 2));
    for (std::size_t i = 0; i < 3; ++i)
      store(x * box.axes[i][0] + y * box.axes[i][1] + z * box.axes[i][2], group(placed, 3 * i + row));
    store(x * box.center[0] + y * box.center[1] + z * box.center[2] + load(group(frame, 4 * row + 3)),
          group(placed, 9 + row));
  }
  return placed;
}

/// Tests the boxes of a pair, see eight_boxes.h. `margin`: the required distance, because two links have no padding.
/// Returns the lanes of `wanted` in which the instances may be near each other.
inline int nearByBoxes(const Model& model, const Scratch& scratch, const SelfPair& pair, const Floats& margin,
                       int wanted)
{
  const float* box_a = placedBox(model, scratch, pair.a);
  const float* box_b = placedBox(model, scratch, pair.b);
  const float* a = model.instances[pair.a].box.half;
  Floats b[3];
  Floats axes_b[3][3];
  Floats between[3];
  for (std::size_t k = 0; k < 3; ++k)
  {
    b[k] = model.instances[pair.b].box.half[k] + pair.boxes.growth + margin;
    between[k] = load(group(box_b, 9 + k)) - load(group(box_a, 9 + k));
    for (std::size_t j = 0; j < 3; ++j)
      axes_b[j][k] = load(group(box_b, 3 * j + k));
  }
  EightBoxPairs pairs;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Floats axis[3] = {load(group(box_a, 3 * i)), load(group(box_a, 3 * i + 1)), load(group(box_a, 3 * i + 2))};
    for (std::size_t j = 0; j < 3; ++j)
    {
      pairs.axes[i][j] = sumOfProducts(axis, axes_b[j]);
      pairs.magnitudes[i][j] = magnitude(pairs.axes[i][j]) + pair.boxes.parallel;
    }
    pairs.between[i] = sumOfProducts(axis, between);
  }
  wanted &= ~bits(pairs.apartByFaces(a, b));
  return wanted == 0 ? 0 : wanted & ~bits(pairs.apartByEdges(a, b));
}
}  // namespace
}  // namespace gpu_planning_scene::core::lanes
