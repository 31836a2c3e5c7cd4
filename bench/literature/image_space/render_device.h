#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "gpu/gl_thread.h"
#include "gpu_planning_scene/shapes.h"
#include "literature/image_space/draw_program.h"
#include "literature/image_space/mesh_buffers.h"
#include "literature/image_space/tile_atlas.h"

namespace gpu_planning_scene::core::literature
{
/// The OpenGL context, the atlas, the programs and the meshes that all image-space methods of a process share.
/// Thread-safe.
class RenderDevice : public std::enable_shared_from_this<RenderDevice>
{
 public:
  /// The device of this process: the first hardware device, else a software one. It exists while somebody holds it.
  /// Throws Error if there is no device.
  static std::shared_ptr<RenderDevice> shared();
  RenderDevice();
  ~RenderDevice();

  /// Runs a job on the context's thread, see GlThread::run.
  void run(const std::function<void()>& job) { thread_.run(job); }
  const Device& device() const { return thread_.device(); }

  /// Uploads a mesh, or returns its buffers if somebody still holds them.
  std::shared_ptr<const MeshBuffers> upload(const std::shared_ptr<const Mesh>& mesh);

  /// Used on the context's thread.
  TileAtlas& atlas() { return *atlas_; }
  /// Compiles a program when somebody needs it for the first time. Used on the context's thread. See DrawProgram.
  const DrawProgram& program(const std::string& vertex_text, const std::string& fragment_text);

 private:
  GlThread thread_;
  std::mutex mutex_;
  std::unique_ptr<TileAtlas> atlas_;
  std::map<std::string, DrawProgram> programs_;  // by their texts
  std::map<const Mesh*, std::weak_ptr<const MeshBuffers>> meshes_;
};
}  // namespace gpu_planning_scene::core::literature
