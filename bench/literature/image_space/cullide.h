#pragma once

#include <array>

#include "literature/image_space/image_space_method.h"
#include "literature/image_space/part_painter.h"
#include "literature/image_space/triangle_survivors.h"

namespace gpu_planning_scene::core::literature
{
/// CULLIDE: potentially colliding sets by visibility (see cullide.cpp). With three views, a part of a shape is
/// discarded if one view shows all of it.
class Cullide : public ImageSpaceMethod
{
 public:
  Cullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options);
  ~Cullide() override;
  WorkCounts work() const override;

 protected:
  using MakePainter = std::function<std::unique_ptr<PartPainter>(RenderDevice& device)>;
  Cullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options,
          const MakePainter& make_painter);

  std::vector<std::uint8_t> draw(const std::vector<PlacedPair>& pairs) final;

 private:
  /// The parts of shapes a and b that may collide.
  using Survivors = std::array<std::vector<std::uint32_t>, 2>;

  void prune(std::size_t part_size, std::vector<Survivors>& survivors);
  std::vector<std::uint32_t> hiddenParts(const std::array<PartList, 2>& lists);
  void drawParts(unsigned number, const PartList& list, bool mark, std::size_t first_hit);

  std::unique_ptr<PartPainter> painter_;
  TriangleSurvivors triangle_tests_;
  double rounds_ = 0.0;
};
}  // namespace gpu_planning_scene::core::literature
