#pragma once

#include <cstddef>
#include <cstdint>

namespace gpu_planning_scene::core::benchmark
{
// The functions of the library vamp_ur5, which has VAMP's check of the ur5. The whole library is compiled for AVX2, so
// only plain data crosses its boundary: the programs must not use its copies of inline functions of the C++ library or
// of Eigen. Lengths are in metres, angles in radians, poses in VAMP's world, which is the planning frame of the
// ur5's URDF.

constexpr std::size_t kVampJoints = 6;
constexpr std::size_t kVampLanes = 8;  ///< states of a block

struct VampSphere
{
  float center[3];
  float radius;
};

/// All points within `radius` of a segment.
struct VampCapsule
{
  float ends[2][3];
  float radius;
};

struct VampBox
{
  float center[3];
  float axes[3][3];  ///< three unit vectors
  float half[3];     ///< half the edge length along each axis
};

struct VampShapes
{
  const VampSphere* spheres;
  std::size_t sphere_count;
  const VampCapsule* capsules;
  std::size_t capsule_count;
  const VampBox* boxes;
  std::size_t box_count;
};

struct VampWorld;  ///< immutable

struct VampLibrary
{
  /// Names in the order of the values of a state.
  const char* joint_names[kVampJoints];
  VampWorld* (*make_world)(const VampShapes& shapes);
  void (*delete_world)(VampWorld* world);
  /// `states`: count x kVampJoints values. `valid`: one byte per state: 1 free, 0 in collision. Thread-safe.
  void (*check)(const VampWorld& world, const float* states, std::size_t count, std::uint8_t* valid);
};
}  // namespace gpu_planning_scene::core::benchmark

/// The only symbol of the library. Its name is also in vamp_library.map.
extern "C" const gpu_planning_scene::core::benchmark::VampLibrary& gpsVampLibrary();
