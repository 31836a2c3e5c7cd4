#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
void BatchResult::append(const BatchResult& next)
{
  valid.insert(valid.end(), next.valid.begin(), next.valid.end());
  colliding.insert(colliding.end(), next.colliding.begin(), next.colliding.end());
  revision = next.revision;
  seconds += next.seconds;
  undecided_states += next.undecided_states;
  device_states += next.device_states;
}
}  // namespace gpu_planning_scene::core
