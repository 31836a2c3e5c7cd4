#include "literature/image_space/draw_program.h"

#include <array>
#include <utility>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
/// grid: pixels along a side of a tile, tiles in a row of the atlas, pixels along a side of the atlas. A row of pixels
/// lies between neighbouring tiles. tile_rows: seven rows for each tile, see Tile.
const char* const kTileDeclarations = R"(
layout(std430, binding = 0) readonly buffer Tiles { uvec4 grid; vec4 tile_rows[]; };
)";

/// Places a vertex in its tile. `p`: in the cube from -1 to 1 of the tile's view. What lies beside the tile is clipped.
const char* const kVertexDeclarations = R"(
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[4]; };

vec3 projected(uint tile, uint shape, vec3 p)
{
  uint first = 7u * tile + 3u * shape;
  vec4 q = vec4(p, 1.0);
  return vec3(dot(tile_rows[first], q), dot(tile_rows[first + 1u], q), dot(tile_rows[first + 2u], q));
}

void place(uint tile, vec3 p)
{
  gl_ClipDistance[0] = 1.0 + p.x;
  gl_ClipDistance[1] = 1.0 - p.x;
  gl_ClipDistance[2] = 1.0 + p.y;
  gl_ClipDistance[3] = 1.0 - p.y;
  vec2 corner = vec2(tile % grid.y, tile / grid.y) * float(grid.x + 1u);
  vec2 pixel = corner + 0.5 * float(grid.x) * (p.xy + 1.0);
  gl_Position = vec4(2.0 / float(grid.z) * pixel - 1.0, p.z, 1.0);
}
)";

GLuint compiled(GLenum stage, const std::string& text)
{
  const char* source = text.c_str();
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good)
  {
    std::array<char, 2048> log{};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    glDeleteShader(shader);
    throw Error(std::string("a shader of the image-space methods does not compile: ") + log.data());
  }
  return shader;
}
}  // namespace

DrawProgram::DrawProgram(const std::string& vertex_text, const std::string& fragment_text)
{
  const std::string head = std::string("#version 450\n") + kTileDeclarations;
  const GLuint vertex = compiled(GL_VERTEX_SHADER, head + kVertexDeclarations + vertex_text);
  const GLuint fragment = fragment_text.empty() ? 0 : compiled(GL_FRAGMENT_SHADER, head + fragment_text);
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  if (fragment)
    glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (!good)
  {
    std::array<char, 2048> log{};
    glGetProgramInfoLog(id_, log.size(), nullptr, log.data());
    glDeleteProgram(id_);
    throw Error(std::string("the shaders of the image-space methods do not link: ") + log.data());
  }
  checkGl("compiling the shaders of the image-space methods");
}

DrawProgram::~DrawProgram()
{
  if (id_)
    glDeleteProgram(id_);
}

DrawProgram::DrawProgram(DrawProgram&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

void DrawProgram::use() const
{
  glUseProgram(id_);
}

void DrawProgram::set(int location, unsigned value) const
{
  glProgramUniform1ui(id_, location, value);
}

const char* const kMeshVertexShader = R"(
layout(location = 0) uniform uint shape;
layout(location = 0) in vec3 position;  // in the frame of the mesh, relative to its centre
layout(location = 0) flat out uint hit;

void main()
{
  hit = uint(gl_InstanceID);
  place(hit, projected(hit, shape, position));
}
)";

const char* const kScreenVertexShader = R"(
void main()
{
  for (int i = 0; i < 4; ++i)
    gl_ClipDistance[i] = 1.0;
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// Without early tests, a fragment shader that writes to a buffer also runs for fragments that fail the tests.
const char* const kMarkShader = R"(
layout(early_fragment_tests) in;
layout(location = 1) uniform uint first_hit;
layout(location = 0) flat in uint hit;
layout(std430, binding = 1) writeonly buffer Hits { uint hits[]; };

void main()
{
  hits[first_hit + hit] = 1u;
}
)";

const char* const kMarkPixelShader = R"(
layout(early_fragment_tests) in;
layout(std430, binding = 1) writeonly buffer Hits { uint hits[]; };

void main()
{
  uvec2 place = uvec2(gl_FragCoord.xy) / (grid.x + 1u);
  hits[place.y * grid.y + place.x] = 1u;
}
)";
}  // namespace gpu_planning_scene::core::literature
