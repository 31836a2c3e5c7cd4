#include "render/gl_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu/program.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// Shadows come from a map of the depths that the lamp sees (L. Williams: Casting curved shadows on curved surfaces.
// SIGGRAPH 1978). A stencil marks the pixels of the world's objects, so that colliding links behind them can be drawn
// faintly.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::array<float, 3> kBackground{0.965F, 0.97F, 0.98F};
constexpr int kShadowSize = 1024;    // pixels of the shadow map in each direction
constexpr double kSoftness = 0.010;  // half the width of a shadow's edge, as a share of the shadow map
constexpr float kHiddenOpacity = 0.3F;

GLuint compileStage(GLenum stage, const std::string& folder, const char* name)
{
  const std::string text = "#version 450\n" + readShader(folder, name);
  const char* source = text.c_str();
  const GLuint program = glCreateShaderProgramv(stage, 1, &source);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good)
  {
    std::array<char, 1024> log{};
    glGetProgramInfoLog(program, log.size(), nullptr, log.data());
    throw Error(std::string("shader ") + name + " does not compile: " + log.data());
  }
  return program;
}

/// The transform from the planning frame to the camera: x to the right, y up, z towards the viewer.
Eigen::Matrix4d viewFrom(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up)
{
  const Eigen::Vector3d back = (eye - target).normalized();
  const Eigen::Vector3d right = up.cross(back).normalized();
  if (!back.allFinite() || !right.allFinite() || right.norm() < 0.5)
    throw Error(
        "the camera looks along its upward direction, or its eye and its target coincide; choose another --camera");
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right;
  view.block<1, 3>(1, 0) = back.cross(right);
  view.block<1, 3>(2, 0) = back;
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * eye;
  return view;
}

/// The transform from the planning frame to the clip space of OpenGL.
Eigen::Matrix4f projection(const Camera& camera, double aspect, double near, double far)
{
  const double scale = 1.0 / std::tan(0.5 * camera.field_of_view);
  Eigen::Matrix4d lens = Eigen::Matrix4d::Zero();
  lens(0, 0) = scale / aspect;
  lens(1, 1) = scale;
  lens(2, 2) = (far + near) / (near - far);
  lens(2, 3) = 2.0 * far * near / (near - far);
  lens(3, 2) = -1.0;
  return (lens * viewFrom(camera.eye, camera.target, camera.up)).cast<float>();
}

/// A colour buffer and a buffer of depth and stencil of the given size, bound for drawing.
class Target
{
 public:
  Target(int width, int height)
  {
    glCreateRenderbuffers(2, buffers_.data());
    glNamedRenderbufferStorage(buffers_[0], GL_RGBA8, width, height);
    glNamedRenderbufferStorage(buffers_[1], GL_DEPTH32F_STENCIL8, width, height);
    glCreateFramebuffers(1, &frame_);
    glNamedFramebufferRenderbuffer(frame_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[0]);
    glNamedFramebufferRenderbuffer(frame_, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers_[1]);
    const bool complete = glCheckNamedFramebufferStatus(frame_, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    if (!complete)
      throw Error("the device cannot draw a picture of that size; choose a smaller size");
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glViewport(0, 0, width, height);
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target()
  {
    glDeleteFramebuffers(1, &frame_);
    glDeleteRenderbuffers(2, buffers_.data());
  }

 private:
  std::array<GLuint, 2> buffers_{};
  GLuint frame_ = 0;
};

void bindAttribute(GLuint array, GLuint index, GLint count, GLenum type, GLboolean normalised, std::size_t offset)
{
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, count, type, normalised, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, 0);
}

Pixels readPixels(int width, int height)
{
  Pixels pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  checkGl("drawing a picture");
  return pixels;
}

Eigen::Vector3f positionOf(const DrawnVertex& vertex)
{
  return Eigen::Vector3f(vertex.position.data());
}
}  // namespace

GlPainter::GlPainter(const Drawing& drawing)
  : drawing_(drawing), vertices_(std::max<std::size_t>(1, drawing.vertices.size()) * sizeof(DrawnVertex))
{
  const std::string folder = shaderFolder();
  glCreateProgramPipelines(1, &pipeline_);
  vertex_stage_ = compileStage(GL_VERTEX_SHADER, folder, "draw/draw.vert");
  glUseProgramStages(pipeline_, GL_VERTEX_SHADER_BIT, vertex_stage_);
  fragment_stage_ = compileStage(GL_FRAGMENT_SHADER, folder, "draw/draw.frag");
  glUseProgramStages(pipeline_, GL_FRAGMENT_SHADER_BIT, fragment_stage_);
  glBindProgramPipeline(pipeline_);
  glProgramUniform3fv(fragment_stage_, LOCATION_BACKGROUND, 1, kBackground.data());

  vertices_.write(drawing.vertices);
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  glVertexArrayVertexBuffer(array, 0, vertices_.id(), 0, sizeof(DrawnVertex));
  bindAttribute(array, ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, position));
  bindAttribute(array, ATTRIBUTE_NORMAL, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, normal));
  bindAttribute(array, ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(DrawnVertex, color));
  glBindVertexArray(array);
  glEnable(GL_DEPTH_TEST);
}

void GlPainter::drawRange(std::size_t begin, std::size_t end)
{
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(begin), static_cast<GLsizei>(end - begin));
}

/// Draws the depths of the bodies as the lamp sees them, orthographically.
void GlPainter::castShadows(const Eigen::Vector3d& lamp)
{
  Eigen::AlignedBox3f bounds;
  for (std::size_t i = 0; i < drawing_.bodies_end; ++i)
    bounds.extend(positionOf(drawing_.vertices[i]));
  if (bounds.isEmpty())
    bounds.extend(Eigen::Vector3f::Zero());
  const Eigen::Vector3d center = bounds.center().cast<double>();
  // A margin, so that the softened edge of a shadow stays inside of the map.
  const double radius = std::max(1e-3, 0.55 * bounds.diagonal().cast<double>().norm());
  const Eigen::Matrix4d view = viewFrom(center + lamp, center, lamp.unitOrthogonal());
  const Eigen::Vector3d middle = view.block<3, 3>(0, 0) * center + view.block<3, 1>(0, 3);
  Eigen::Matrix4d lens = Eigen::Matrix4d::Identity();
  lens.block<3, 3>(0, 0) = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  lens.block<3, 1>(0, 3) = Eigen::Vector3d(-middle.x(), -middle.y(), middle.z());
  lens.topRows<3>() /= radius;
  const Eigen::Matrix4d to_clip_space = lens * view;
  Eigen::Matrix4d to_map = Eigen::Matrix4d::Identity();
  to_map.topLeftCorner<3, 3>() *= 0.5;
  to_map.topRightCorner<3, 1>().setConstant(0.5);

  glCreateTextures(GL_TEXTURE_2D, 1, &shadow_map_);
  glTextureStorage2D(shadow_map_, 1, GL_DEPTH_COMPONENT32F, kShadowSize, kShadowSize);
  glTextureParameteri(shadow_map_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(shadow_map_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(shadow_map_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(shadow_map_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(shadow_map_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const std::array<float, 4> lit{1.0F, 1.0F, 1.0F, 1.0F};
  glTextureParameterfv(shadow_map_, GL_TEXTURE_BORDER_COLOR, lit.data());
  GLuint frame = 0;
  glCreateFramebuffers(1, &frame);
  glNamedFramebufferTexture(frame, GL_DEPTH_ATTACHMENT, shadow_map_, 0);
  glNamedFramebufferDrawBuffer(frame, GL_NONE);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glViewport(0, 0, kShadowSize, kShadowSize);
  glClear(GL_DEPTH_BUFFER_BIT);
  const Eigen::Matrix4f matrix = to_clip_space.cast<float>();
  glProgramUniformMatrix4fv(vertex_stage_, LOCATION_TO_CLIP_SPACE, 1, GL_FALSE, matrix.data());
  drawRange(0, drawing_.bodies_end);
  glDeleteFramebuffers(1, &frame);

  const Eigen::Matrix4f to_lamp = (to_map * to_clip_space).cast<float>();
  const Eigen::Vector3f direction = lamp.cast<float>();
  glProgramUniformMatrix4fv(fragment_stage_, LOCATION_TO_LAMP, 1, GL_FALSE, to_lamp.data());
  glProgramUniform3fv(fragment_stage_, LOCATION_LAMP, 1, direction.data());
  glProgramUniform1f(fragment_stage_, LOCATION_SOFTNESS, static_cast<float>(kSoftness));
  glProgramUniform1f(fragment_stage_, LOCATION_LIFT, static_cast<float>(2.0 * radius * kSoftness));
  glBindTextureUnit(UNIT_SHADOW_MAP, shadow_map_);
}

void GlPainter::aim(const Camera& camera, int width, int height)
{
  double far = 0.0;
  for (const DrawnVertex& vertex : drawing_.vertices)
    far = std::max(far, (positionOf(vertex).cast<double>() - camera.eye).norm());
  const double distance = (camera.target - camera.eye).norm();
  const Eigen::Matrix4f matrix =
      projection(camera, static_cast<double>(width) / height, 0.01 * distance, std::max(2.0 * distance, 1.01 * far));
  glProgramUniformMatrix4fv(vertex_stage_, LOCATION_TO_CLIP_SPACE, 1, GL_FALSE, matrix.data());
  const Eigen::Vector3f eye = camera.eye.cast<float>();
  glProgramUniform3fv(fragment_stage_, LOCATION_EYE, 1, eye.data());
}

/// Draws the next triangles as if they were nearer to the eye by `distance` metres, in depth only.
void GlPainter::pullContacts(const Camera& camera, double distance)
{
  const Eigen::Vector3f eye = camera.eye.cast<float>();
  glProgramUniform4f(vertex_stage_, LOCATION_PULL, eye.x(), eye.y(), eye.z(), static_cast<float>(distance));
}

/// Draws the bodies. Then the stencil is 1 where an object of the world is in front, and 0 elsewhere.
void GlPainter::drawBodies()
{
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilFunc(GL_ALWAYS, 0, 1);
  drawRange(0, drawing_.links_end);
  drawRange(drawing_.objects_end, drawing_.bodies_end);
  glStencilFunc(GL_ALWAYS, 1, 1);
  drawRange(drawing_.links_end, drawing_.objects_end);
  glDisable(GL_STENCIL_TEST);
}

/// Draws faintly, and in one colour, what is behind the surfaces that are already drawn.
template <typename Draw>
void GlPainter::drawHidden(const BodyColor& color, Draw draw)
{
  const auto channel = [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; };
  glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, channel(color[0]), channel(color[1]), channel(color[2]),
                     kHiddenOpacity);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  draw();
  glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, 0.0F, 0.0F, 0.0F, 0.0F);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

/// Links and attached objects that collide behind an object of the world, for example inside a shelf.
void GlPainter::drawHiddenParts()
{
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 1, 1);
  glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);  // each pixel is blended once
  drawHidden(kCollidingColor,
             [this]
             {
               for (const RobotPart& part : drawing_.robot)
                 if (part.collides)
                   drawRange(part.begin, part.end);
             });
  glDisable(GL_STENCIL_TEST);
}

void GlPainter::drawHiddenContacts()
{
  glEnable(GL_CULL_FACE);  // each pixel of a point is blended once
  drawHidden(kContactColor, [this] { drawRange(drawing_.bodies_end, drawing_.contacts_end); });
  glDisable(GL_CULL_FACE);
}

Pixels GlPainter::picture(const Camera& camera, int width, int height, double near_surface)
{
  const Eigen::Vector3d back = (camera.eye - camera.target).normalized();
  const Eigen::Vector3d lamp = (camera.up + 0.25 * back + 0.3 * camera.up.cross(back)).normalized();
  castShadows(lamp);
  const Target target(width, height);
  aim(camera, width, height);
  glClearColor(kBackground[0], kBackground[1], kBackground[2], 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  drawBodies();
  // From below, the floor would hide the scene.
  const Floor& floor = drawing_.floor;
  if (floor.radius > 0.0 && (camera.eye - floor.center).dot(camera.up) > 0.0)
  {
    const Eigen::Vector3f center = floor.center.cast<float>();
    glProgramUniform4f(fragment_stage_, LOCATION_GROUND, center.x(), center.y(), center.z(),
                       static_cast<float>(floor.radius));
    drawRange(drawing_.contacts_end, drawing_.vertices.size());
    glProgramUniform4f(fragment_stage_, LOCATION_GROUND, 0.0F, 0.0F, 0.0F, 0.0F);
  }
  drawHiddenParts();
  pullContacts(camera, near_surface);
  drawHiddenContacts();
  drawRange(drawing_.bodies_end, drawing_.contacts_end);
  pullContacts(camera, 0.0);
  return readPixels(width, height);
}

Pixels GlPainter::roles(const Camera& camera, int width, int height, double near_surface)
{
  const Target target(width, height);
  aim(camera, width, height);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  for (std::size_t i = 0; i < drawing_.robot.size(); ++i)
  {
    const RobotPart& part = drawing_.robot[i];
    const float number = static_cast<float>(1 + i % 255) / 255.0F;
    glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, number, 0.0F, part.collides ? 1.0F : 0.0F, 1.0F);
    drawRange(part.begin, part.end);
  }
  glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, 0.0F, 0.0F, 0.0F, 1.0F);
  drawRange(drawing_.links_end, drawing_.objects_end);
  glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, 0.0F, 1.0F, 0.0F, 1.0F);
  pullContacts(camera, near_surface);
  drawRange(drawing_.bodies_end, drawing_.contacts_end);
  pullContacts(camera, 0.0);
  glProgramUniform4f(fragment_stage_, LOCATION_FLAT_COLOR, 0.0F, 0.0F, 0.0F, 0.0F);
  return readPixels(width, height);
}
}  // namespace gpu_planning_scene::core
