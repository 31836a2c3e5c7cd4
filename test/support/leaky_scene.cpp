#include "support/leaky_scene.h"

#include "support/damaged_mesh.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
TestScene leakyScene()
{
  TestScene made = testScene("kr5");
  made.name = "kr5, leaky objects";
  PlanningScene scene = *made.scene;
  std::mt19937_64 generator(kSeed);
  std::size_t next = 0;
  for (WorldObject& object : scene.objects)
    for (PlacedShape& placed : object.shapes)
      if (!std::holds_alternative<HalfSpace>(placed.shape))
      {
        const MeshDamage damage = allMeshDamages()[next++ % allMeshDamages().size()];
        placed.shape = damaged(*tessellate(placed.shape).mesh, damage, 0.1, generator);
      }
  made.scene = std::make_shared<const PlanningScene>(std::move(scene));
  return made;
}
}  // namespace gpu_planning_scene::core
