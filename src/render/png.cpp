#include <png.h>

#include "gpu_planning_scene/error.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
void writePng(const Image& image, const std::string& path)
{
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&png, path.c_str(), 0, image.rgb.data(), 0, nullptr) == 0)
    throw Error(path + ": cannot write the picture: " + png.message);
}
}  // namespace gpu_planning_scene::core
