#pragma once

#include <cstdint>
#include <string>

#include <moveit_msgs/MoveItErrorCodes.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::pipeline
{
using moveit_msgs::MoveItErrorCodes;

/// A request that cannot be planned, with MoveIt's error code.
class Refusal : public core::Error
{
 public:
  Refusal(std::int32_t code, const std::string& what) : core::Error(what), code_(code) {}

  std::int32_t code() const { return code_; }

 private:
  std::int32_t code_;
};

/// The logger of the planner.
constexpr char kLogName[] = "gpu_planning_scene_planner";
}  // namespace gpu_planning_scene::pipeline
