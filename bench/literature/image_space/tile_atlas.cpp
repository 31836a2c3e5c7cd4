#include "literature/image_space/tile_atlas.h"

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"
#include "literature/image_space/draw_program.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr int kAtlasSize = 2080;  // pixels: 32 x 32 tiles of 64 pixels with their borders, or 4 x 4 tiles of 512
constexpr std::size_t kGridBytes = 16;

int columnsOf(int resolution)
{
  return kAtlasSize / (resolution + 1);
}
}  // namespace

TileAtlas::TileAtlas()
{
  glCreateRenderbuffers(1, &objects_[0]);
  glNamedRenderbufferStorage(objects_[0], GL_DEPTH24_STENCIL8, kAtlasSize, kAtlasSize);
  glCreateFramebuffers(1, &objects_[1]);
  glNamedFramebufferRenderbuffer(objects_[1], GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, objects_[0]);
  glNamedFramebufferDrawBuffer(objects_[1], GL_NONE);
  glNamedFramebufferReadBuffer(objects_[1], GL_NONE);
  if (glCheckNamedFramebufferStatus(objects_[1], GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error("the device cannot draw into a buffer of depth and stencil without colours; choose another device");
  checkGl("making the atlas");
}

TileAtlas::~TileAtlas()
{
  glDeleteFramebuffers(1, &objects_[1]);
  glDeleteRenderbuffers(1, &objects_[0]);
}

std::size_t TileAtlas::capacity(int resolution)
{
  return static_cast<std::size_t>(columnsOf(resolution)) * static_cast<std::size_t>(columnsOf(resolution));
}

void TileAtlas::begin(int resolution, const std::vector<Tile>& tiles, std::size_t hits)
{
  const int columns = columnsOf(resolution);
  resolution_ = resolution;
  const std::array<std::uint32_t, 4> grid{static_cast<std::uint32_t>(resolution), static_cast<std::uint32_t>(columns),
                                          kAtlasSize, 0};
  tiles_.reserve(kGridBytes + tiles.size() * sizeof(Tile));
  tiles_.write(grid.data(), kGridBytes);
  tiles_.write(tiles.data(), tiles.size() * sizeof(Tile), kGridBytes);
  tiles_.bindStorage(kTilesBinding);
  clearHits(hits);

  glBindFramebuffer(GL_FRAMEBUFFER, objects_[1]);
  glViewport(0, 0, kAtlasSize, kAtlasSize);
  glEnable(GL_SCISSOR_TEST);  // for the clears: only the rows in use
  const int rows = (static_cast<int>(tiles.size()) + columns - 1) / columns;
  glScissor(0, 0, kAtlasSize, rows * (resolution + 1));
  for (unsigned i = 0; i < 4; ++i)
    glEnable(GL_CLIP_DISTANCE0 + i);
  glEnable(GL_DEPTH_TEST);
}

void TileAtlas::clearHits(std::size_t count)
{
  hit_count_ = count;
  hits_.reserve(count * sizeof(std::uint32_t));
  hits_.clear(0, count * sizeof(std::uint32_t));
  hits_.bindStorage(kHitsBinding);
}

void TileAtlas::clearDepth() const
{
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void TileAtlas::clearDepthAndStencil() const
{
  glDepthMask(GL_TRUE);
  glStencilMask(0xFF);
  glClearDepth(1.0);
  glClearStencil(0);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

std::vector<std::uint32_t> TileAtlas::hits() const
{
  std::vector<std::uint32_t> words(hit_count_);
  hits_.read(words.data(), words.size() * sizeof(std::uint32_t));
  checkGl("drawing into the atlas");
  return words;
}

TilePixels TileAtlas::read(std::size_t tile) const
{
  const auto columns = static_cast<std::size_t>(columnsOf(resolution_));
  const int x = static_cast<int>(tile % columns) * (resolution_ + 1);
  const int y = static_cast<int>(tile / columns) * (resolution_ + 1);
  const auto count = static_cast<std::size_t>(resolution_) * static_cast<std::size_t>(resolution_);
  TilePixels pixels{resolution_, std::vector<float>(count), std::vector<std::uint8_t>(count)};
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(x, y, resolution_, resolution_, GL_DEPTH_COMPONENT, GL_FLOAT, pixels.depth.data());
  glReadPixels(x, y, resolution_, resolution_, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, pixels.stencil.data());
  checkGl("reading a tile");
  return pixels;
}
}  // namespace gpu_planning_scene::core::literature
