#pragma once

#include "literature/image_space/draw_program.h"
#include "literature/image_space/image_space_method.h"

namespace gpu_planning_scene::core::literature
{
/// CInDeR: edges inside solids (see cinder.cpp). With three views, a pair collides if any view reports it.
class Cinder : public ImageSpaceMethod
{
 public:
  Cinder(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options);

 protected:
  std::vector<std::uint8_t> draw(const std::vector<PlacedPair>& pairs) override;

 private:
  void findEdgesInside(unsigned edges_of, unsigned solid, std::size_t tiles);
};
}  // namespace gpu_planning_scene::core::literature
