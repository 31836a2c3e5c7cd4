#include "peers/vamp/vamp_library.h"

#include <algorithm>
#include <array>

#include <vamp/vector.hh>

#include <vamp/collision/factory.hh>
#include <vamp/robots/ur5.hh>

// VAMP's own check (Thomason, Kingston and Kavraki, "Motions in Microseconds via Vectorized Sampling-Based Planning",
// 2024), called as VAMP's Python module calls it: `validate` puts one state into all eight lanes, and a motion is
// checked in blocks of eight states. `fkcc` says only whether all eight states of a block are free.
namespace gpu_planning_scene::core::benchmark
{
using Robot = vamp::robots::UR5;
using Lanes = vamp::FloatVector<kVampLanes>;

struct VampWorld
{
  vamp::collision::Environment<Lanes> environment;
};

namespace
{
static_assert(Robot::dimension == kVampJoints && vamp::FloatVectorWidth == kVampLanes);

/// Axis-parallel shapes have lists and tests of their own, as in `add_cuboid` and `add_capsule` of VAMP's module.
VampWorld* makeWorld(const VampShapes& shapes)
{
  namespace factory = vamp::collision::factory;
  vamp::collision::Environment<float> made;
  for (std::size_t i = 0; i < shapes.sphere_count; ++i)
  {
    const VampSphere& s = shapes.spheres[i];
    made.spheres.push_back(factory::sphere::flat(s.center[0], s.center[1], s.center[2], s.radius));
  }
  for (std::size_t i = 0; i < shapes.capsule_count; ++i)
  {
    const VampCapsule& c = shapes.capsules[i];
    const auto capsule = factory::capsule::endpoints::flat(c.ends[0][0], c.ends[0][1], c.ends[0][2], c.ends[1][0],
                                                           c.ends[1][1], c.ends[1][2], c.radius);
    (capsule.xv == 0.0F && capsule.yv == 0.0F ? made.z_aligned_capsules : made.capsules).push_back(capsule);
  }
  for (std::size_t i = 0; i < shapes.box_count; ++i)
  {
    const VampBox& b = shapes.boxes[i];
    const vamp::collision::Cuboid<float> box(b.center[0], b.center[1], b.center[2], b.axes[0][0], b.axes[0][1],
                                             b.axes[0][2], b.axes[1][0], b.axes[1][1], b.axes[1][2], b.axes[2][0],
                                             b.axes[2][1], b.axes[2][2], b.half[0], b.half[1], b.half[2]);
    (box.axis_3_z == 1.0F ? made.z_aligned_cuboids : made.cuboids).push_back(box);
  }
  made.sort();
  return new VampWorld{vamp::collision::Environment<Lanes>(made)};
}

void deleteWorld(VampWorld* world)
{
  delete world;
}

bool isFree(const VampWorld& world, const float* state)
{
  Robot::ConfigurationBlock<kVampLanes> block;
  for (std::size_t joint = 0; joint < kVampJoints; ++joint)
    block[joint] = state[joint];
  return Robot::fkcc<kVampLanes>(world.environment, block);
}

bool areAllFree(const VampWorld& world, const float* states)
{
  Robot::ConfigurationBlock<kVampLanes> block;
  for (std::size_t joint = 0; joint < kVampJoints; ++joint)
  {
    alignas(vamp::FloatVectorAlignment) std::array<float, kVampLanes> values;
    for (std::size_t lane = 0; lane < kVampLanes; ++lane)
      values[lane] = states[lane * kVampJoints + joint];
    block[joint] = Lanes(values.data());
  }
  return Robot::fkcc<kVampLanes>(world.environment, block);
}

/// A check of a block saves time only if all eight states are free. This is likely after eight free states, as along a
/// motion. Most blocks of random states have a collision.
void check(const VampWorld& world, const float* states, std::size_t count, std::uint8_t* valid)
{
  std::size_t free_before = 0;
  for (std::size_t i = 0; i < count;)
  {
    const float* const next = states + i * kVampJoints;
    if (free_before >= kVampLanes && count - i >= kVampLanes && areAllFree(world, next))
    {
      std::fill_n(valid + i, kVampLanes, std::uint8_t{1});
      i += kVampLanes;
      continue;
    }
    // The states of a block with a collision are decided one by one.
    const std::size_t end = free_before >= kVampLanes ? std::min(count, i + kVampLanes) : i + 1;
    for (; i < end; ++i)
    {
      valid[i] = isFree(world, states + i * kVampJoints) ? 1 : 0;
      free_before = valid[i] != 0 ? free_before + 1 : 0;
    }
  }
}

const VampLibrary& library()
{
  // VAMP's names are string views of literals, so they end with a zero.
  static const VampLibrary made = {
      {Robot::joint_names[0].data(), Robot::joint_names[1].data(), Robot::joint_names[2].data(),
       Robot::joint_names[3].data(), Robot::joint_names[4].data(), Robot::joint_names[5].data()},
      makeWorld,
      deleteWorld,
      check};
  return made;
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

const gpu_planning_scene::core::benchmark::VampLibrary& gpsVampLibrary()
{
  return gpu_planning_scene::core::benchmark::library();
}
