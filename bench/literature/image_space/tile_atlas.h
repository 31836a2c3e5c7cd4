#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core::literature
{
/// The projections of shapes a and b into the cube of a tile, row by row. They apply to coordinates relative to the
/// centre of the shape's mesh (MeshBuffers::center), so that float32 keeps its digits far from the origin.
struct Tile
{
  std::array<float, 12> a;
  std::array<float, 12> b;
  /// In units of a pixel: half of the width and of the depth by which triangles are fattened (width along x, width
  /// along y, depth), and half of the depth of the cube.
  std::array<float, 4> fattening;
};

/// The pixels of a tile in rows from the bottom.
struct TilePixels
{
  int resolution = 0;
  std::vector<float> depth;  ///< 0 (near) to 1 (empty)
  std::vector<std::uint8_t> stencil;
};

/// A buffer of depth (24 bits) and stencil (8 bits) that is divided into square tiles, one for each view of a pair.
/// Used on the context's thread.
class TileAtlas
{
 public:
  TileAtlas();
  ~TileAtlas();
  TileAtlas(const TileAtlas&) = delete;
  TileAtlas& operator=(const TileAtlas&) = delete;

  /// The number of tiles with `resolution` pixels along each side.
  static std::size_t capacity(int resolution);

  /// Uploads the tiles, sets all hits to 0, and makes the atlas the target of all drawing. `hits`: the number of words
  /// that shaders may set.
  void begin(int resolution, const std::vector<Tile>& tiles, std::size_t hits);
  void clearDepth() const;
  void clearDepthAndStencil() const;

  std::vector<std::uint32_t> hits() const;
  void clearHits(std::size_t count);
  TilePixels read(std::size_t tile) const;

 private:
  std::array<unsigned, 2> objects_{};  // a buffer of depth and stencil, and its frame
  int resolution_ = 0;
  std::size_t hit_count_ = 0;
  Buffer tiles_;
  Buffer hits_;
};
}  // namespace gpu_planning_scene::core::literature
