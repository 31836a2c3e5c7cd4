#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "literature/image_space/draw_program.h"
#include "literature/image_space/mesh_buffers.h"
#include "literature/image_space/render_device.h"

namespace gpu_planning_scene::core::literature
{
/// Parts of a shape in tiles. A part is a run of triangles in the order of MeshBuffers.
struct PartList
{
  std::size_t part_size = 0;                               ///< triangles; the last part of a shape has the rest
  std::vector<std::array<std::uint32_t, 2>> entries = {};  ///< tile and number of a part
};

/// Draws parts of shapes. Used on the context's thread, while the device exists.
class PartPainter
{
 public:
  virtual ~PartPainter();
  PartPainter(const PartPainter&) = delete;
  PartPainter& operator=(const PartPainter&) = delete;

  /// Draws the parts of a shape. `number`: 0 for shape a, 1 for shape b. With `mark`, each fragment that passes the
  /// tests of depth and stencil sets the hit of its entry; the hit of the first entry has the number `first_hit`.
  void draw(const MeshBuffers& shape, unsigned number, const PartList& list, bool mark, std::size_t first_hit);

 protected:
  /// `vertex_shader`: reads the entries, the vertices and the triangles from storage buffers.
  PartPainter(RenderDevice& device, const char* vertex_shader);
  /// Draws `triangles` triangles with the given program, which is in use: part_size for each entry.
  virtual void drawTriangles(const DrawProgram& program, std::size_t triangles) = 0;
  unsigned array() const { return array_; }  ///< the bound vertex array, which has no attributes

 private:
  const DrawProgram& depth_;
  const DrawProgram& mark_;
  Buffer entries_;
  unsigned array_ = 0;
};

/// The vertex shaders of parts begin with this text. `triangleOf` finds the entry and the triangle of `number`, and
/// whether the part has so many triangles. `corner` is a point in the cube of the entry's tile.
extern const char* const kPartDeclarations;

/// Draws triangles as they are.
std::unique_ptr<PartPainter> makeTrianglePainter(RenderDevice& device);
}  // namespace gpu_planning_scene::core::literature
