#include "literature/image_space/fattened_cullide.h"

#include <algorithm>
#include <vector>

#include <epoxy/gl.h>

// N. K. Govindaraju, M. C. Lin, D. Manocha: Fast and reliable collision culling using graphics hardware, 2004.
//
// Idea: CULLIDE on fattened triangles. The box of a triangle, grown by half a pixel on all sides, covers the centre
// of each pixel in which the triangle has a point. Two triangles with a common point then both have fragments at the
// centre of this point's pixel, and their boxes overlap there in depth. So neither is discarded.
//
// Domain: all meshes, also open ones. Only surfaces are compared, so containment is missed.
//
// Failures: none for surfaces, within float32: the boxes are grown by more than the rounding error (Tile::fattening).
// The price is the number of triangles that are left for the exact tests, and twelve triangles drawn for each one.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kBoxes = 16384;  // drawn by one call
constexpr std::size_t kBoxIndices = 36;

// The vertices are the eight corners of boxes. A box has the directions of its triangle, in units of a pixel. Depths
// are scaled to pixels of mean width.
const char* const kBoxShader = R"(
void main()
{
  uint entry;
  uint triangle;
  if (!triangleOf(uint(gl_VertexID) / 8u, entry, triangle))
  {
    discardVertex();
    return;
  }
  hit = entry;
  uint tile = parts[entry].x;
  vec4 fattening = tile_rows[7u * tile + 6u];
  vec3 to_pixels = vec3(0.5 * float(grid.x), 0.5 * float(grid.x), fattening.w);
  vec3 origin = to_pixels * corner(entry, triangle, 0u);
  vec3 b = to_pixels * corner(entry, triangle, 1u) - origin;
  vec3 c = to_pixels * corner(entry, triangle, 2u) - origin;

  // u: along the longest edge. w: the normal. Any axes would do, but these make the smallest box.
  vec3 u = dot(b, b) > dot(c, c) ? b : c;
  u = dot(c - b, c - b) > dot(u, u) ? c - b : u;
  u = dot(u, u) > 0.0 ? normalize(u) : vec3(1.0, 0.0, 0.0);
  vec3 w = cross(b, c);
  w -= dot(w, u) * u;
  if (dot(w, w) <= 1e-12 * dot(b, b) * dot(c, c))
    w = abs(u.x) < 0.5 ? cross(u, vec3(1.0, 0.0, 0.0)) : cross(u, vec3(0.0, 1.0, 0.0));
  w = normalize(w);
  mat3 axes = mat3(u, cross(w, u), w);

  vec3 at_b = b * axes;
  vec3 at_c = c * axes;
  vec3 growth = fattening.xyz * mat3(abs(axes[0]), abs(axes[1]), abs(axes[2]));
  vec3 low = min(vec3(0.0), min(at_b, at_c)) - growth;
  vec3 high = max(vec3(0.0), max(at_b, at_c)) + growth;
  uint number = uint(gl_VertexID) % 8u;
  vec3 chosen = vec3((number & 1u) != 0u ? high.x : low.x, (number & 2u) != 0u ? high.y : low.y,
                     (number & 4u) != 0u ? high.z : low.z);
  place(tile, (origin + axes * chosen) / to_pixels);
}
)";

/// Two triangles for each side of a box. Bit i of a corner's number: the corner is on the upper side along axis i.
std::vector<std::uint32_t> boxIndices()
{
  std::vector<std::uint32_t> indices;
  for (std::uint32_t box = 0; box < kBoxes; ++box)
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t side = 0; side < 2; ++side)
      {
        const std::uint32_t x = 1U << (axis + 1) % 3;
        const std::uint32_t y = 1U << (axis + 2) % 3;
        const std::uint32_t first = 8 * box + (side << axis);
        for (const std::uint32_t offset : {0U, x, x + y, 0U, x + y, y})
          indices.push_back(first + offset);
      }
  return indices;
}

class BoxPainter : public PartPainter
{
 public:
  explicit BoxPainter(RenderDevice& device)
    : PartPainter(device, kBoxShader), indices_(kBoxes * kBoxIndices * sizeof(std::uint32_t))
  {
    indices_.write(boxIndices());
    glVertexArrayElementBuffer(array(), indices_.id());
  }

 protected:
  void drawTriangles(const DrawProgram& program, std::size_t triangles) override
  {
    // A box may reach beyond the depths of the tile. Without its front, its partner would seem to be fully visible.
    glEnable(GL_DEPTH_CLAMP);
    for (std::size_t first = 0; first < triangles; first += kBoxes)
    {
      program.set(kFirstTriangleLocation, static_cast<unsigned>(first));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(kBoxIndices * std::min(kBoxes, triangles - first)),
                     GL_UNSIGNED_INT, nullptr);
    }
    glDisable(GL_DEPTH_CLAMP);
  }

 private:
  Buffer indices_;
};
}  // namespace

FattenedCullide::FattenedCullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                                 const ImageOptions& options)
  : Cullide(a, b, options, [](RenderDevice& device) { return std::make_unique<BoxPainter>(device); })
{
}
}  // namespace gpu_planning_scene::core::literature
