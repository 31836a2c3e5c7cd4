#pragma once

#include <string>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core::literature
{
/// Bindings of storage buffers, locations of uniforms and of the vertices, for all programs of this folder.
constexpr unsigned kTilesBinding = 0;
constexpr unsigned kHitsBinding = 1;
constexpr unsigned kVerticesBinding = 2;
constexpr unsigned kTrianglesBinding = 3;
constexpr unsigned kPartsBinding = 4;
constexpr int kShapeLocation = 0;
constexpr int kFirstHitLocation = 1;
constexpr int kPartSizeLocation = 2;
constexpr int kTriangleCountLocation = 3;
constexpr int kFirstTriangleLocation = 4;
constexpr unsigned kPositionAttribute = 0;

/// A vertex shader, with a fragment shader unless its text is empty. Move-only; used on the context's thread. Both
/// texts are preceded by declarations of the tiles of the atlas, see draw_program.cpp.
class DrawProgram
{
 public:
  /// Throws Error with the compiler's log.
  DrawProgram(const std::string& vertex_text, const std::string& fragment_text);
  ~DrawProgram();
  DrawProgram(DrawProgram&& other) noexcept;
  DrawProgram& operator=(DrawProgram&&) = delete;

  void use() const;
  void set(int location, unsigned value) const;

 private:
  unsigned id_ = 0;
};

/// Vertices of a mesh, one instance for each tile. The uniform `shape` is 0 for shape a and 1 for shape b.
extern const char* const kMeshVertexShader;
/// One triangle that covers the atlas.
extern const char* const kScreenVertexShader;
/// Sets a hit to 1 for each fragment that passes the tests of depth and stencil. kMarkShader takes the number of the
/// hit from the vertex shader and adds the uniform `first_hit`. kMarkPixelShader takes the number of the pixel's tile.
extern const char* const kMarkShader;
extern const char* const kMarkPixelShader;
}  // namespace gpu_planning_scene::core::literature
