#include "literature/image_space/cinder.h"

#include <epoxy/gl.h>

// D. Knott, D. K. Pai: CInDeR: collision and interference detection in real-time using graphics hardware, 2003.
//
// Idea: two solids that collide have an edge of one with a point inside the other. A line of sight that ends at a
// point inside a solid enters the solid once more than it leaves it. The stencil counts this for the nearest edge of
// each pixel: front faces in front of the edge add 1, back faces subtract 1. Then the two shapes change their roles.
//
// Domain: closed solids, also concave ones. Containment is found.
//
// Failures: a pixel keeps only its nearest edge, so the edges behind it are lost. The pixels of a line are up to half
// a pixel away from the edge, so an edge near a surface is reported as inside, or missed. Where a face is missing,
// the count is wrong, and all edges behind the hole seem to be inside. Each further view finds edges that are hidden
// in other views, and adds false hits.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr int kEdge = 0x80;   // bit of the stencil: the pixel shows an edge
constexpr int kCount = 0x7F;  // bits of the stencil: front faces minus back faces
}  // namespace

Cinder::Cinder(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options)
  : ImageSpaceMethod(a, b, options)
{
}

std::vector<std::uint8_t> Cinder::draw(const std::vector<PlacedPair>& pairs)
{
  const std::size_t tiles = pairs.size() * views();
  glDisable(GL_CULL_FACE);
  glEnable(GL_STENCIL_TEST);
  findEdgesInside(0, 1, tiles);
  findEdgesInside(1, 0, tiles);
  return anyView(atlas().hits(), views());
}

void Cinder::findEdgesInside(unsigned edges_of, unsigned solid, std::size_t tiles)
{
  const std::string edge_name = edges_of == 0 ? "edges of a" : "edges of b";
  const DrawProgram& depth = program(kMeshVertexShader, "");
  atlas().clearDepthAndStencil();
  depth.use();
  glDepthFunc(GL_LESS);
  glStencilMask(kEdge);
  glStencilFunc(GL_ALWAYS, kEdge, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  depth.set(kShapeLocation, edges_of);
  shape(edges_of).drawEdges(tiles);
  countPass(tiles * shape(edges_of).edgeCount());
  observe(edge_name);

  glDepthMask(GL_FALSE);
  glStencilMask(kCount);
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
  depth.set(kShapeLocation, solid);
  shape(solid).drawTriangles(tiles);
  countPass(tiles * shape(solid).triangleCount());
  observe(edge_name + " inside the other shape");

  // A pixel with an edge and a count that is not 0 has a stencil above kEdge.
  program(kScreenVertexShader, kMarkPixelShader).use();
  glDisable(GL_DEPTH_TEST);
  glStencilFunc(GL_LESS, kEdge, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  shape(0).drawScreen();
  countPass(1);
  glEnable(GL_DEPTH_TEST);
}
}  // namespace gpu_planning_scene::core::literature
