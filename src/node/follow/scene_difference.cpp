#include "node/follow/scene_difference.h"

namespace gpu_planning_scene::core
{
SceneChange differenceTo(SceneChange full, const SceneStore& store, const SceneStore::Lookup& lookup)
{
  const Snapshot now = store.snapshot();
  dropMeasured(now, full);
  const SceneStore::Preview wanted = store.preview({full}, lookup);
  SceneChange change = diffOf(*now.scene, *wanted.snapshot.scene);
  change.state.variables.clear();
  for (const auto& [name, value] : full.state.variables)
  {
    const int index = now.scene->robot->variableIndex(name);
    const auto variable = static_cast<std::size_t>(index);
    if (index >= 0 && (!now.known[variable] || now.state[variable] != value))
      change.state.variables[name] = value;
  }
  return change;
}
}  // namespace gpu_planning_scene::core
