#pragma once

#include "literature/image_space/cullide.h"

namespace gpu_planning_scene::core::literature
{
/// CULLIDE with fattened triangles (see fattened_cullide.cpp).
class FattenedCullide : public Cullide
{
 public:
  FattenedCullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                  const ImageOptions& options);
};
}  // namespace gpu_planning_scene::core::literature
