#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "render/drawing.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
/// RGBA pixels in rows from the bottom.
using Pixels = std::vector<std::uint8_t>;

/// Draws a Drawing with OpenGL. Lives on the thread of a GL context. The end of the context destroys its GL objects.
class GlPainter
{
 public:
  explicit GlPainter(const Drawing& drawing);

  /// A picture with light and shadows. Contact points that lie within `near_surface` metres behind a visible surface
  /// are drawn in full; contact points farther behind are drawn faintly. Parts of colliding links and
  /// attached objects that an object of the world hides are drawn faintly too.
  Pixels picture(const Camera& camera, int width, int height, double near_surface);

  /// A picture of the visible roles. The red channel has 1 + i % 255 for part i of Drawing::robot, the green channel
  /// shows the contact points, the blue channel the parts that collide. All other pixels are black.
  Pixels roles(const Camera& camera, int width, int height, double near_surface);

 private:
  void castShadows(const Eigen::Vector3d& lamp);
  void aim(const Camera& camera, int width, int height);
  void pullContacts(const Camera& camera, double distance);
  void drawBodies();
  template <typename Draw>
  void drawHidden(const BodyColor& color, Draw draw);
  void drawHiddenParts();
  void drawHiddenContacts();
  void drawRange(std::size_t begin, std::size_t end);

  const Drawing& drawing_;
  Buffer vertices_;
  unsigned int pipeline_ = 0;
  unsigned int vertex_stage_ = 0;
  unsigned int fragment_stage_ = 0;
  unsigned int shadow_map_ = 0;
};
}  // namespace gpu_planning_scene::core
