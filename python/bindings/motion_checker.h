#pragma once

#include <string>

#include "bindings/arguments.h"
#include "gpu_planning_scene/motion_checker.h"

namespace gpu_planning_scene::python
{
/// The options of a motion rule. `resolution`: radians. `translation_resolution`: metres.
core::MotionCheckerOptions motionOptionsFrom(const Arg<std::string>& rule, Arg<double> resolution,
                                             Arg<double> translation_resolution, Arg<std::size_t> max_samples);
}  // namespace gpu_planning_scene::python
