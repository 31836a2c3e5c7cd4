#pragma once

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// A queue is full; the caller should ask again later.
class Busy : public Error
{
 public:
  using Error::Error;
};
}  // namespace gpu_planning_scene::core
