// depth_pictures: draws what image-space methods see in cases in which they are wrong; see --help. Needs no ROS.

#include <algorithm>
#include <array>
#include <iostream>

#include "command_line/command_line.h"
#include "literature/image_space/cinder.h"
#include "literature/image_space/failure_cases.h"
#include "literature/image_space/recode.h"
#include "render/renderer.h"

using namespace gpu_planning_scene::core;
using namespace gpu_planning_scene::core::literature;

namespace
{
using Color = std::array<std::uint8_t, 3>;

constexpr Color kEmpty{255, 255, 255};
constexpr Color kHit{224, 45, 45};
constexpr int kMeetingIntervals = 1;  // hits of RECODE have a stencil above this value
constexpr int kEdgeInside = 0x80;     // hits of CInDeR have a stencil above this value
constexpr int kBorder = 8;            // pixels between two passes

/// From dark (near) to light (far), in the range of depths of a picture.
Color depthColor(float depth, float nearest, float farthest)
{
  const float share = (depth - nearest) / std::max(1e-6F, farthest - nearest);
  const auto channel = [share](float from, float to) { return static_cast<std::uint8_t>(from + share * (to - from)); };
  return {channel(20.0F, 200.0F), channel(50.0F, 215.0F), channel(110.0F, 235.0F)};
}

/// The passes of a method, side by side. Pixels with a stencil above `hit` are red.
class Strip
{
 public:
  void add(const TilePixels& pixels, int hit)
  {
    float nearest = 1.0F;
    float farthest = 0.0F;
    for (const float depth : pixels.depth)
      if (depth < 1.0F)
      {
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
      }
    std::vector<Color> panel;
    for (std::size_t i = 0; i < pixels.depth.size(); ++i)
      panel.push_back(pixels.stencil[i] > hit   ? kHit
                      : pixels.depth[i] >= 1.0F ? kEmpty
                                                : depthColor(pixels.depth[i], nearest, farthest));
    panels_.push_back(panel);
    side_ = pixels.resolution;
  }

  Image image() const
  {
    Image image;
    image.width = static_cast<int>(panels_.size()) * (side_ + kBorder) - kBorder;
    image.height = side_;
    for (int y = side_ - 1; y >= 0; --y)
      for (std::size_t panel = 0; panel < panels_.size(); ++panel)
      {
        for (int x = 0; x < side_; ++x)
          append(panels_[panel][static_cast<std::size_t>(y * side_ + x)], image);
        for (int x = 0; x < kBorder && panel + 1 < panels_.size(); ++x)
          append({128, 128, 128}, image);
      }
    return image;
  }

 private:
  static void append(const Color& color, Image& image)
  {
    image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  }

  std::vector<std::vector<Color>> panels_;
  int side_ = 0;
};

/// Draws all passes of the first view of a method, and prints their names and the answer. `hit`: see Strip::add.
template <class Drawn>
void drawPasses(const std::string& path, const FailureCase& failure, int resolution, int views, int hit)
{
  Strip strip;
  ImageOptions options;
  options.resolution = resolution;
  options.views = views;
  std::cout << path << ", from left to right:";
  options.observe = [&](const std::string& pass, const TilePixels& pixels)
  {
    std::cout << (pass.empty() ? "" : " ") << pass << ';';
    strip.add(pixels, hit);
  };
  Drawn method(failure.a, failure.b, options);
  const bool collides = method.collide({failure.b_in_a})[0] != 0;
  std::cout << " answer: " << (collides ? "collision" : "free") << '\n';
  writePng(strip.image(), path);
}

void run(const CommandLine& arguments)
{
  const std::string folder = arguments.required("--out");
  const int resolution = static_cast<int>(arguments.integer("--resolution", 256, 64, 512));
  drawPasses<Recode>(folder + "/recode_linked_tori.png", linkedTori(), resolution, 1, kMeetingIntervals);
  drawPasses<Cinder>(folder + "/cinder_from_above.png", blockInPlate(), resolution, 1, kEdgeInside);
  drawPasses<Cinder>(folder + "/cinder_from_the_side.png", blockInPlate(), resolution, 3, kEdgeInside);
}
}  // namespace

int main(int argc, char** argv)
{
  return runTool({"depth_pictures",
                  "--out DIR [--resolution N]",
                  "Draws the depth buffers of RECODE for linked tori that are apart, and of CInDeR for a block in a\n"
                  "plate. Dark pixels are near, light ones far, white ones empty. Red: the pixels of the stencil that\n"
                  "the method counts as a hit. Prints the passes and the answers. They are wrong, except for CInDeR\n"
                  "with three views, the first of which is from the side.",
                  {{"--out", "DIR", "folder for the pictures; it must exist"},
                   {"--resolution", "N", "pixels along each side, 64 to 512 (default 256)"}},
                  run},
                 argc, argv);
}
