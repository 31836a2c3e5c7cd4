#pragma once

#include "literature/image_space/draw_program.h"
#include "literature/image_space/image_space_method.h"

namespace gpu_planning_scene::core::literature
{
/// RECODE: overlap of depth intervals (see recode.cpp). With three views, a pair collides if all views report it.
class Recode : public ImageSpaceMethod
{
 public:
  Recode(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options);

 protected:
  std::vector<std::uint8_t> draw(const std::vector<PlacedPair>& pairs) override;

 private:
  void drawShape(const DrawProgram& drawing, unsigned number, std::size_t tiles);
};
}  // namespace gpu_planning_scene::core::literature
