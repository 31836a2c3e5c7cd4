#include "literature/image_space/recode.h"

#include <epoxy/gl.h>

// G. Baciu, W. S.-K. Wong, H. Sun: RECODE: an image-based collision detection algorithm, 1999.
//
// Idea: along the line of sight of a pixel, a convex shape occupies one interval of depths, from its front to its
// back. The shapes collide if their intervals overlap at some pixel: the back of b lies behind the front of a, and
// the back of a lies behind the front of b. The first condition is kept in the stencil while the second is tested.
//
// Domain: closed convex shapes. Containment is found, because the intervals are those of the solids.
//
// Failures: a shape that is not convex occupies several intervals, but the method takes them and the gaps between
// them as one. So it reports linked tori that are apart, the more often the thicker their tubes are. It misses an
// overlap that is smaller than a pixel. With three views, all views have to agree. This adds misses, and removes few
// false hits.
namespace gpu_planning_scene::core::literature
{
Recode::Recode(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b, const ImageOptions& options)
  : ImageSpaceMethod(a, b, options)
{
}

void Recode::drawShape(const DrawProgram& drawing, unsigned number, std::size_t tiles)
{
  drawing.set(kShapeLocation, number);
  drawing.use();
  shape(number).drawTriangles(tiles);
  countPass(tiles * shape(number).triangleCount());
}

std::vector<std::uint8_t> Recode::draw(const std::vector<PlacedPair>& pairs)
{
  const std::size_t tiles = pairs.size() * views();
  const DrawProgram& depth = program(kMeshVertexShader, "");
  const DrawProgram& mark = program(kMeshVertexShader, kMarkShader);
  atlas().clearDepthAndStencil();
  glEnable(GL_CULL_FACE);

  glDisable(GL_STENCIL_TEST);
  glDepthFunc(GL_LESS);
  glCullFace(GL_BACK);
  drawShape(depth, 0, tiles);
  observe("fronts of a");

  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glCullFace(GL_FRONT);
  drawShape(depth, 1, tiles);
  observe("backs of b behind fronts of a");

  atlas().clearDepth();
  glDisable(GL_STENCIL_TEST);
  glDepthFunc(GL_LESS);
  glCullFace(GL_BACK);
  drawShape(depth, 1, tiles);
  observe("fronts of b");

  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 1, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);  // 2 at a hit, for pictures; a second back at the pixel is not needed
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glCullFace(GL_FRONT);
  drawShape(mark, 0, tiles);
  observe("backs of a behind fronts of b");
  return everyView(atlas().hits(), views());
}
}  // namespace gpu_planning_scene::core::literature
