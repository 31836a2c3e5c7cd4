#include "gpu/egl_context.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "gpu/driver_fault.h"
#include "gpu/gl_debug.h"
#include "gpu/staging_ring.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string glString(GLenum name)
{
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "unknown";
}

bool isSoftware(const std::string& renderer)
{
  const std::string name = lower(renderer);
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
         name.find("swrast") != std::string::npos || name.find("software") != std::string::npos;
}

bool isNumber(const std::string& text)
{
  return !text.empty() && text.size() < 7 &&
         std::all_of(
             text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// The EGL displays without a window system: one per device, or Mesa's surfaceless platform if EGL lists no devices.
std::vector<EGLDisplay> displays()
{
  std::vector<EGLDisplay> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base"))
  {
    EGLint count = 0;
    if (eglQueryDevicesEXT(0, nullptr, &count) && count > 0)
    {
      std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
      eglQueryDevicesEXT(count, devices.data(), &count);
      for (EGLint i = 0; i < count; ++i)
        found.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  if (found.empty() && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return found;
}

void destroy(EGLDisplay display, EGLContext context)
{
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
}

/// Makes an OpenGL 4.5 context current. On failure it returns EGL_NO_CONTEXT and writes the reason to `why_not`.
EGLContext makeContext(EGLDisplay display, std::string* why_not)
{
  EGLint major = 0;
  EGLint minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor))
  {
    *why_not = "EGL cannot be initialised on it";
    return EGL_NO_CONTEXT;
  }
  if (!eglBindAPI(EGL_OPENGL_API))
  {
    *why_not = "no desktop OpenGL";
    return EGL_NO_CONTEXT;
  }
  const std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       4,
                                       EGL_CONTEXT_MINOR_VERSION,       5,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       EGL_CONTEXT_OPENGL_DEBUG,        wantsDebugContext() ? EGL_TRUE : EGL_FALSE};
  const auto create = [&](std::vector<EGLint> list)
  {
    list.push_back(EGL_NONE);
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, list.data());
  };
  // Requests notification of resets if the driver offers it. refuseLostContext() then detects a lost device.
  std::vector<EGLint> with_notification = attributes;
  with_notification.insert(with_notification.end(),
                           {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  EGLContext context = create(with_notification);
  if (context == EGL_NO_CONTEXT)
    context = create(attributes);
  if (context == EGL_NO_CONTEXT)
  {
    *why_not = "no OpenGL 4.5 core context";
    return EGL_NO_CONTEXT;
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
  {
    eglDestroyContext(display, context);
    *why_not = "the context cannot be made current without a surface";
    return EGL_NO_CONTEXT;
  }
  reportDriverMessages();
  return context;
}

struct Candidate
{
  EGLDisplay display;
  Device device;
  std::string why_not;  // empty if the device is usable
};

/// libepoxy ends the process if one of these libraries is missing, so they are looked for first.
void requireLibraries()
{
  const bool has_gl = dlopen("libOpenGL.so.0", RTLD_LAZY) != nullptr || dlopen("libGL.so.1", RTLD_LAZY) != nullptr;
  if (!epoxy_has_egl() || !has_gl)
    throw Error(
        std::string("this machine has no ") + (has_gl ? "libEGL.so.1" : "libOpenGL.so.0 or libGL.so.1") +
        "; install its GPU driver, or Mesa for software rendering (Debian: libegl1, libopengl0, libgl1-mesa-dri)");
}

std::vector<Candidate> probe()
{
  requireLibraries();
  std::vector<Candidate> candidates;
  int index = 0;
  for (EGLDisplay display : displays())
  {
    Candidate candidate{display, {}, {}};
    candidate.device.index = index++;
    const EGLContext context = makeContext(display, &candidate.why_not);
    if (context != EGL_NO_CONTEXT)
    {
      candidate.device.renderer = glString(GL_RENDERER);
      candidate.device.version = glString(GL_VERSION);
      candidate.device.software = isSoftware(candidate.device.renderer);
      candidate.why_not = driverFault(candidate.device.renderer);
      destroy(display, context);
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

const Candidate* choose(const std::vector<Candidate>& candidates, const std::string& selector)
{
  const auto first = [&](auto&& fits) -> const Candidate*
  {
    for (const Candidate& candidate : candidates)
      if (candidate.why_not.empty() && fits(candidate.device))
        return &candidate;
    return nullptr;
  };
  if (selector == "auto")
  {
    const Candidate* hardware = first([](const Device& device) { return !device.software; });
    return hardware ? hardware : first([](const Device&) { return true; });
  }
  if (selector == "software")
    return first([](const Device& device) { return device.software; });
  if (isNumber(selector))
    return first([&](const Device& device) { return device.index == std::stoi(selector); });
  return first([&](const Device& device) { return lower(device.renderer).find(lower(selector)) != std::string::npos; });
}

std::string describe(const std::vector<Candidate>& candidates)
{
  if (candidates.empty())
    return "EGL lists no device; install a GPU driver, or Mesa for software rendering";
  std::string text = "devices:";
  for (const Candidate& candidate : candidates)
    text += " [" + std::to_string(candidate.device.index) + "] " +
            (candidate.why_not.empty() ? candidate.device.renderer : "unusable: " + candidate.why_not) + ";";
  text.pop_back();
  return text;
}
}  // namespace

EglContext::EglContext(const std::string& selector)
{
  const std::vector<Candidate> candidates = probe();
  const Candidate* chosen = choose(candidates, selector);
  if (!chosen)
    throw Error("no usable EGL device for '" + selector + "' (" + describe(candidates) + ")");
  std::string why_not;
  context_ = makeContext(chosen->display, &why_not);
  if (!context_)
    throw Error("EGL device " + chosen->device.renderer + " failed: " + why_not);
  display_ = chosen->display;
  device_ = chosen->device;
}

EglContext::~EglContext()
{
  StagingRing::ofThisThread().release();
  destroy(display_, context_);
}

std::vector<Device> listDevices()
{
  std::vector<Device> devices;
  for (const Candidate& candidate : probe())
    if (candidate.why_not.empty())
      devices.push_back(candidate.device);
  return devices;
}
}  // namespace gpu_planning_scene::core
