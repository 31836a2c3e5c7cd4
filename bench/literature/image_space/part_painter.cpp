#include "literature/image_space/part_painter.h"

#include <algorithm>

#include <epoxy/gl.h>

namespace gpu_planning_scene::core::literature
{
namespace
{
const char* const kTriangleShader = R"(
void main()
{
  uint entry;
  uint triangle;
  if (triangleOf(uint(gl_VertexID) / 3u, entry, triangle))
  {
    hit = entry;
    place(parts[entry].x, corner(entry, triangle, uint(gl_VertexID) % 3u));
  }
  else
    discardVertex();
}
)";

class TrianglePainter : public PartPainter
{
 public:
  explicit TrianglePainter(RenderDevice& device) : PartPainter(device, kTriangleShader) {}

 protected:
  void drawTriangles(const DrawProgram& /*program*/, std::size_t triangles) override
  {
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * triangles));
  }
};
}  // namespace

const char* const kPartDeclarations = R"(
layout(location = 0) uniform uint shape;
layout(location = 2) uniform uint part_size;
layout(location = 3) uniform uint triangle_count;
layout(location = 4) uniform uint first_triangle;
layout(std430, binding = 2) readonly buffer Vertices { float coordinates[]; };
layout(std430, binding = 3) readonly buffer Triangles { uint indices[]; };
layout(std430, binding = 4) readonly buffer Parts { uvec2 parts[]; };  // tile and number of a part
layout(location = 0) flat out uint hit;

bool triangleOf(uint number, out uint entry, out uint triangle)
{
  entry = (first_triangle + number) / part_size;
  triangle = parts[entry].y * part_size + (first_triangle + number) % part_size;
  return triangle < triangle_count;
}

vec3 corner(uint entry, uint triangle, uint i)
{
  uint vertex = 3u * indices[3u * triangle + i];
  vec3 p = vec3(coordinates[vertex], coordinates[vertex + 1u], coordinates[vertex + 2u]);
  return projected(parts[entry].x, shape, p);
}

void discardVertex()
{
  hit = 0u;
  for (int i = 0; i < 4; ++i)
    gl_ClipDistance[i] = -1.0;
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
)";

PartPainter::PartPainter(RenderDevice& device, const char* vertex_shader)
  : depth_(device.program(std::string(kPartDeclarations) + vertex_shader, "")),
    mark_(device.program(std::string(kPartDeclarations) + vertex_shader, kMarkShader))
{
  glCreateVertexArrays(1, &array_);
}

PartPainter::~PartPainter()
{
  glDeleteVertexArrays(1, &array_);
}

void PartPainter::draw(const MeshBuffers& shape, unsigned number, const PartList& list, bool mark,
                       std::size_t first_hit)
{
  const DrawProgram& program = mark ? mark_ : depth_;
  entries_.reserve(list.entries.size() * sizeof(list.entries[0]));
  entries_.write(list.entries);
  entries_.bindStorage(kPartsBinding);
  shape.bindStorage();
  glBindVertexArray(array_);
  program.set(kShapeLocation, number);
  program.set(kPartSizeLocation, static_cast<unsigned>(list.part_size));
  program.set(kTriangleCountLocation, static_cast<unsigned>(shape.triangleCount()));
  program.set(kFirstTriangleLocation, 0);
  if (mark)
    program.set(kFirstHitLocation, static_cast<unsigned>(first_hit));
  program.use();
  drawTriangles(program, list.entries.size() * list.part_size);
}

std::unique_ptr<PartPainter> makeTrianglePainter(RenderDevice& device)
{
  return std::make_unique<TrianglePainter>(device);
}
}  // namespace gpu_planning_scene::core::literature
