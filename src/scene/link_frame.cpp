#include "scene/link_frame.h"

#include <optional>

#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
LinkFrame linkFrame(const PlanningScene& scene, const std::string& name)
{
  const std::optional<LocatedFrame> located = locateFrame(scene, name);
  if (!located)
  {
    const std::string near = didYouMean(name, frameNames(scene));
    throw Error("the scene has no frame '" + name + "'" +
                (near.empty() ? "; name a link, a carried object, or OBJECT/SUBFRAME" : near));
  }
  if (located->link < 0)
    throw Error("frame '" + name +
                "' does not move with the robot; name a link, an object that a link carries, or OBJECT/SUBFRAME");
  return {located->link, located->object * located->subframe};
}
}  // namespace gpu_planning_scene::core
