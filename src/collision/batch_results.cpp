#include "collision/batch_results.h"

namespace gpu_planning_scene
{
void append(const BatchResult& part, BatchResult& all)
{
  all.valid.insert(all.valid.end(), part.valid.begin(), part.valid.end());
  all.colliding.insert(all.colliding.end(), part.colliding.begin(), part.colliding.end());
  all.revision = part.revision;
  all.seconds += part.seconds;
  all.undecided_states += part.undecided_states;
  all.undecided_seconds += part.undecided_seconds;
}
}  // namespace gpu_planning_scene
