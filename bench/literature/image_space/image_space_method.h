#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "literature/image_space/render_device.h"
#include "literature/image_space/view.h"
#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
struct ImageOptions
{
  int resolution = 256;  ///< pixels along each side of a view: 64 to 512
  int views = 1;         ///< 1, 2 or 3: see viewAxes
  /// The views are along the axes of a frame that has this orientation in the frame of shape a.
  Eigen::Quaterniond view_frame = Eigen::Quaterniond::Identity();
  /// Called with the name of each pass and the pixels of the first tile after it. Used for pictures.
  std::function<void(const std::string& pass, const TilePixels& pixels)> observe;
};

/// A pose at which the bounding boxes overlap, with the views in which it is drawn.
struct PlacedPair
{
  Eigen::Isometry3d b_in_a;
  ViewVolume volume;      ///< in the frame of the views
  std::vector<int> axes;  ///< one for each view
};

/// Draws pairs into the tiles of an atlas, as many poses at a time as the atlas holds. The views of a pose follow each
/// other. Poses at which the bounding boxes are apart are not drawn.
class ImageSpaceMethod : public Method
{
 public:
  ImageSpaceMethod(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, ImageOptions options);

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) final;
  WorkCounts work() const override;

 protected:
  /// Whether each pair collides. Called on the context's thread after `atlas().begin` for the tiles of the pairs.
  virtual std::vector<std::uint8_t> draw(const std::vector<PlacedPair>& pairs) = 0;

  TileAtlas& atlas() const { return device_->atlas(); }
  const ImageOptions& options() const { return options_; }
  const MeshBuffers& shape(unsigned number) const { return number == 0 ? *a_ : *b_; }
  std::size_t views() const { return static_cast<std::size_t>(options_.views); }

  /// A program that all methods share. Used on the context's thread. See DrawProgram.
  const DrawProgram& program(const std::string& vertex_text, const std::string& fragment_text) const
  {
    return device_->program(vertex_text, fragment_text);
  }
  RenderDevice& device() const { return *device_; }
  /// Runs a job on the context's thread.
  void run(const std::function<void()>& job) const { device_->run(job); }
  /// Reports the pixels after a pass, if somebody observes.
  void observe(const std::string& pass) const;
  /// Counts a pass that draws `primitives` triangles or lines in all.
  void countPass(std::size_t primitives);

 private:
  std::vector<Tile> tilesOf(const std::vector<PlacedPair>& pairs) const;

  std::shared_ptr<RenderDevice> device_;
  std::shared_ptr<const MeshBuffers> a_;
  std::shared_ptr<const MeshBuffers> b_;
  ImageOptions options_;
  Eigen::Isometry3d a_in_view_;
  Eigen::AlignedBox3d bounds_a_;
  double tiles_ = 0.0;
  double passes_ = 0.0;
  double primitives_ = 0.0;
};

/// Bits of an answer: for each pair, whether any of its tiles, or all of its tiles, were hit.
std::vector<std::uint8_t> anyView(const std::vector<std::uint32_t>& hits, std::size_t views);
std::vector<std::uint8_t> everyView(const std::vector<std::uint32_t>& hits, std::size_t views);
}  // namespace gpu_planning_scene::core::literature
