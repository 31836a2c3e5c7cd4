#pragma once

/// Bounds of the rounding errors of the lane kernel. They are derived in docs/error_bounds.md, "The lane kernel".
namespace gpu_planning_scene::core::lanes
{
constexpr double kUnit = 0x1p-24;                  ///< rounding unit of float
constexpr double kTurnError = 1.5e-6;              ///< of a vector of length 1 that a turning joint rotates
constexpr double kProductError = 12.0 * kUnit;     ///< of a vector of length 1, by the product of two rotations
constexpr double kSumError = 12.0 * kUnit;         ///< of a transformed point, times its largest coordinates
constexpr double kDistanceError = 32.0 * kUnit;    ///< of a distance, times the sum of all lengths
constexpr double kAxisError = 16.0 * kUnit;        ///< of an axis of a box: a rounded constant, transformed
constexpr double kConstantError = 4.0 * kUnit;     ///< of a vector of length 1, by a rounded constant rotation
constexpr double kQuaternionError = 64.0 * kUnit;  ///< of a vector of length 1 that a quaternion rotates
}  // namespace gpu_planning_scene::core::lanes
