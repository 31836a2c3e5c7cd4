#include "render/renderer.h"

#include <algorithm>
#include <array>

#include "gpu/gl_thread.h"
#include "gpu_planning_scene/error.h"
#include "render/drawing.h"
#include "render/gl_painter.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kSamples = 2;     // drawn pixels per pixel and axis: they smooth the edges
constexpr int kLargest = 4096;  // pixels

// Contact points mostly lie inside of bodies. A point at most this share of the scene's size behind a surface counts as
// a point of this surface.
constexpr double kNearSurface = 0.03;

// The small pictures in which views are compared.
constexpr int kTrialWidth = 240;
constexpr int kTrialHeight = 180;
constexpr double kPreference = 1.15;  // the first view is taken unless another view is better by this factor

/// Averages kSamples x kSamples drawn pixels for each pixel of the picture.
Image reduced(const Pixels& pixels, int width, int height)
{
  Image image{width, height, {}};
  image.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel)
      {
        int sum = 0;
        for (int row = 0; row < kSamples; ++row)
          for (int column = 0; column < kSamples; ++column)
          {
            const std::size_t at =
                static_cast<std::size_t>(y * kSamples + row) * static_cast<std::size_t>(width * kSamples) +
                static_cast<std::size_t>(x * kSamples + column);
            sum += pixels[4 * at + static_cast<std::size_t>(channel)];
          }
        image.rgb.push_back(static_cast<std::uint8_t>(sum / (kSamples * kSamples)));
      }
  return image;
}

double nearSurface(const PlanningScene& scene, const double* state)
{
  return kNearSurface * nearRobot(scene, state).diagonal().norm();
}

/// The pixels of a view, see GlPainter::roles.
struct Visible
{
  explicit Visible(const Pixels& pixels)
  {
    for (std::size_t at = 0; at < pixels.size(); at += 4)
    {
      parts[pixels[at]] += 1.0;
      contacts += pixels[at + 1] != 0 ? 1.0 : 0.0;
      colliding += pixels[at + 2] != 0 ? 1.0 : 0.0;
    }
  }
  std::array<double, 256> parts{};  // of each part of the robot, from 1 on
  double contacts = 0.0;
  double colliding = 0.0;
};

/// The pixels in a view as a share of those in the view that shows most. 0 if no view shows any.
template <typename Count>
double shareOf(const std::vector<Visible>& views, std::size_t view, const Count& count)
{
  double most = 0.0;
  for (const Visible& other : views)
    most = std::max(most, count(other));
  return most == 0.0 ? 0.0 : count(views[view]) / most;
}

/// The score of a view, relative to the best of all views: the robot, its colliding parts and the contacts have equal
/// weight. Within the robot, each link has the same weight, because a gripper is small, but must be seen. A view that
/// shows half of the contacts is good enough.
double scoreOf(const std::vector<Visible>& views, std::size_t view)
{
  double parts = 0.0;
  double visible_parts = 0.0;
  for (std::size_t number = 1; number < views[view].parts.size(); ++number)
  {
    const auto pixels = [number](const Visible& one) { return one.parts[number]; };
    parts += shareOf(views, view, pixels);
    visible_parts += std::any_of(views.begin(), views.end(), [&](const Visible& one) { return pixels(one) > 0.0; });
  }
  return parts / std::max(1.0, visible_parts) + shareOf(views, view, [](const Visible& one) { return one.colliding; }) +
         std::min(0.5, shareOf(views, view, [](const Visible& one) { return one.contacts; }));
}
}  // namespace

Camera clearestView(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
                    const std::vector<Eigen::Vector3d>& contact_points, const Eigen::Vector3d& up,
                    const std::string& device)
{
  const std::vector<Camera> views = viewsOf(scene, state, up);
  const Drawing drawing = drawingOf(scene, state, colliding, contact_points, up);
  std::vector<Visible> visible;
  GlThread thread(device);
  thread.run(
      [&]
      {
        GlPainter painter(drawing);
        for (const Camera& view : views)
          visible.emplace_back(painter.roles(view, kTrialWidth, kTrialHeight, nearSurface(scene, state)));
      });
  std::size_t best = 0;
  double best_score = kPreference * scoreOf(visible, 0);
  for (std::size_t view = 1; view < views.size(); ++view)
    if (const double score = scoreOf(visible, view); score > best_score)
    {
      best = view;
      best_score = score;
    }
  return views[best];
}

Image render(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
             const std::vector<Eigen::Vector3d>& contact_points, const Camera& camera, int width, int height,
             const std::string& device)
{
  if (width < 1 || height < 1 || width > kLargest || height > kLargest)
    throw Error("the picture has " + std::to_string(width) + "x" + std::to_string(height) +
                " pixels; width and height must be from 1 to " + std::to_string(kLargest));
  const Drawing drawing = drawingOf(scene, state, colliding, contact_points, camera.up);
  Pixels pixels;
  GlThread thread(device);
  thread.run(
      [&]
      { pixels = GlPainter(drawing).picture(camera, width * kSamples, height * kSamples, nearSurface(scene, state)); });
  return reduced(pixels, width, height);
}
}  // namespace gpu_planning_scene::core
