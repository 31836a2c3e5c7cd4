#pragma once

namespace gpu_planning_scene::detector
{
/// The logger of the detector, as MoveIt names those of its own detectors.
constexpr char kLogName[] = "collision_detection.gpu_planning_scene";
}  // namespace gpu_planning_scene::detector
