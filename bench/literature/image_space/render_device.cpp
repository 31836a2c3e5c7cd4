#include "literature/image_space/render_device.h"

namespace gpu_planning_scene::core::literature
{
std::shared_ptr<RenderDevice> RenderDevice::shared()
{
  static std::mutex mutex;
  static std::weak_ptr<RenderDevice> kept;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<RenderDevice> device = kept.lock();
  if (!device)
  {
    device = std::make_shared<RenderDevice>();
    kept = device;
  }
  return device;
}

RenderDevice::RenderDevice() : thread_("auto")
{
  run([this] { atlas_ = std::make_unique<TileAtlas>(); });
}

RenderDevice::~RenderDevice()
{
  run(
      [this]
      {
        atlas_.reset();
        programs_.clear();
      });
}

const DrawProgram& RenderDevice::program(const std::string& vertex_text, const std::string& fragment_text)
{
  const std::string key = vertex_text + '\0' + fragment_text;
  const auto kept = programs_.find(key);
  if (kept != programs_.end())
    return kept->second;
  return programs_.emplace(key, DrawProgram(vertex_text, fragment_text)).first->second;
}

std::shared_ptr<const MeshBuffers> RenderDevice::upload(const std::shared_ptr<const Mesh>& mesh)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::weak_ptr<const MeshBuffers>& kept = meshes_[mesh.get()];
  if (std::shared_ptr<const MeshBuffers> buffers = kept.lock())
    return buffers;
  MeshBuffers* made = nullptr;
  run([&] { made = new MeshBuffers(mesh); });
  // OpenGL objects can only be deleted on the context's thread.
  const std::shared_ptr<const MeshBuffers> buffers(
      made, [device = shared_from_this()](const MeshBuffers* old) { device->run([old] { delete old; }); });
  kept = buffers;
  return buffers;
}
}  // namespace gpu_planning_scene::core::literature
