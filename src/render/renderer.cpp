#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <epoxy/gl.h>

#include "gpu/buffer.h"
#include "gpu/gl_check.h"
#include "gpu/gl_thread.h"
#include "gpu/program.h"
#include "gpu_planning_scene/error.h"
#include "render/drawing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kSamples = 2;     // drawn pixels per pixel and axis: they smooth the edges
constexpr int kLargest = 4096;  // pixels
constexpr std::array<float, 4> kBackground{0.965F, 0.97F, 0.98F, 1.0F};

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

/// The transform from the planning frame to the clip space of OpenGL.
Eigen::Matrix4f projection(const Camera& camera, double aspect, double near, double far)
{
  const Eigen::Vector3d back = (camera.eye - camera.target).normalized();
  const Eigen::Vector3d right = camera.up.cross(back).normalized();
  if (!back.allFinite() || !right.allFinite() || right.norm() < 0.5)
    throw Error(
        "the camera looks along its upward direction, or its eye and its target coincide; choose another --camera");
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right;
  view.block<1, 3>(1, 0) = back.cross(right);
  view.block<1, 3>(2, 0) = back;
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * camera.eye;
  const double scale = 1.0 / std::tan(0.5 * camera.field_of_view);
  Eigen::Matrix4d lens = Eigen::Matrix4d::Zero();
  lens(0, 0) = scale / aspect;
  lens(1, 1) = scale;
  lens(2, 2) = (far + near) / (near - far);
  lens(2, 3) = 2.0 * far * near / (near - far);
  lens(3, 2) = -1.0;
  return (lens * view).cast<float>();
}

/// A colour buffer and a depth buffer of the given size, bound for drawing.
class Target
{
 public:
  Target(int width, int height)
  {
    glCreateRenderbuffers(2, buffers_.data());
    glNamedRenderbufferStorage(buffers_[0], GL_RGBA8, width, height);
    glNamedRenderbufferStorage(buffers_[1], GL_DEPTH_COMPONENT32F, width, height);
    glCreateFramebuffers(1, &frame_);
    glNamedFramebufferRenderbuffer(frame_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[0]);
    glNamedFramebufferRenderbuffer(frame_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers_[1]);
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

/// Returns RGBA pixels in rows from the bottom. Runs on the context's thread. The end of its context destroys the
/// objects that remain.
std::vector<std::uint8_t> draw(const Drawing& drawing, const Eigen::Matrix4f& matrix, const Camera& camera, int width,
                               int height)
{
  const std::string folder = shaderFolder();
  const Target target(width, height);
  GLuint pipeline = 0;
  glCreateProgramPipelines(1, &pipeline);
  const GLuint vertex_stage = compileStage(GL_VERTEX_SHADER, folder, "draw/draw.vert");
  glUseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, vertex_stage);
  const GLuint fragment_stage = compileStage(GL_FRAGMENT_SHADER, folder, "draw/draw.frag");
  glUseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, fragment_stage);
  glBindProgramPipeline(pipeline);
  glProgramUniformMatrix4fv(vertex_stage, 0, 1, GL_FALSE, matrix.data());
  const Eigen::Vector3f eye = camera.eye.cast<float>();
  const Eigen::Vector3f up = camera.up.cast<float>();
  glProgramUniform3fv(fragment_stage, 0, 1, eye.data());
  glProgramUniform3fv(fragment_stage, 1, 1, up.data());

  Buffer buffer(std::max<std::size_t>(1, drawing.vertices.size()) * sizeof(DrawnVertex));
  buffer.write(drawing.vertices);
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  glVertexArrayVertexBuffer(array, 0, buffer.id(), 0, sizeof(DrawnVertex));
  bindAttribute(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, position));
  bindAttribute(array, 1, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, normal));
  bindAttribute(array, 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(DrawnVertex, color));
  glBindVertexArray(array);

  glClearColor(kBackground[0], kBackground[1], kBackground[2], kBackground[3]);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(drawing.bodies_end));
  glClear(GL_DEPTH_BUFFER_BIT);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(drawing.bodies_end),
               static_cast<GLsizei>(drawing.vertices.size() - drawing.bodies_end));
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  checkGl("drawing a picture");
  return pixels;
}

/// Averages kSamples x kSamples drawn pixels for each pixel of the picture.
Image reduced(const std::vector<std::uint8_t>& pixels, int width, int height)
{
  Image image{width, height, {}};
  image.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel)
      {
        int sum = 0;
        for (int row = 0; row < kSamples; ++row)
          for (int column = 0; column < kSamples; ++column)
          {
            const std::size_t at =
                static_cast<std::size_t>(y * kSamples + row) * static_cast<std::size_t>(width * kSamples) +
                static_cast<std::size_t>(x * kSamples + column);
            sum += pixels[4 * at + static_cast<std::size_t>(channel)];
          }
        image.rgb.push_back(static_cast<std::uint8_t>(sum / (kSamples * kSamples)));
      }
  return image;
}
}  // namespace

Image render(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
             const std::vector<Eigen::Vector3d>& contact_points, const Camera& camera, int width, int height,
             const std::string& device)
{
  if (width < 1 || height < 1 || width > kLargest || height > kLargest)
    throw Error("the picture has " + std::to_string(width) + "x" + std::to_string(height) +
                " pixels; width and height must be from 1 to " + std::to_string(kLargest));
  const Drawing drawing = drawingOf(scene, state, colliding, contact_points);
  double far = 0.0;
  for (const DrawnVertex& vertex : drawing.vertices)
    far = std::max(far, (Eigen::Vector3f(vertex.position.data()).cast<double>() - camera.eye).norm());
  const double distance = (camera.target - camera.eye).norm();
  const Eigen::Matrix4f matrix =
      projection(camera, static_cast<double>(width) / height, 0.01 * distance, std::max(2.0 * distance, 1.01 * far));
  std::vector<std::uint8_t> pixels;
  GlThread thread(device);
  thread.run([&] { pixels = draw(drawing, matrix, camera, width * kSamples, height * kSamples); });
  return reduced(pixels, width, height);
}
}  // namespace gpu_planning_scene::core
