#pragma once

/// Bounds of the rounding errors of the lane kernel and of the device's proofs, which compute the same. They are
/// derived in docs/error_bounds.md, "The lane kernel".
namespace gpu_planning_scene::core::lanes
{
struct Rounding
{
  double unit;      ///< relative error of one operation
  double distance;  ///< of a distance, times the sum of all lengths
  /// 1: the balls of two links are compared in the frame of the first one, whose rotation error counts once more; 0: in
  /// the planning frame
  double relative;

  double turn() const { return 25.2 * unit; }        ///< of a vector of length 1 that a turning joint rotates
  double product() const { return 12.0 * unit; }     ///< of a vector of length 1, by the product of two rotations
  double sum() const { return 12.0 * unit; }         ///< of a transformed point, times its largest coordinates
  double axis() const { return 16.0 * unit; }        ///< of an axis of a box: a rounded constant, transformed
  double constant() const { return 4.0 * unit; }     ///< of a vector of length 1, by a rounded constant rotation
  double quaternion() const { return 64.0 * unit; }  ///< of a vector of length 1 that a quaternion rotates
};

constexpr Rounding kKernelRounding = {0x1p-24, 32.0 * 0x1p-24, 0.0};  ///< of the lane kernel, rounded to nearest
constexpr Rounding kDeviceRounding = {0x1p-23, 64.0 * 0x1p-23, 1.0};  ///< of shaders, in any rounding mode
}  // namespace gpu_planning_scene::core::lanes
