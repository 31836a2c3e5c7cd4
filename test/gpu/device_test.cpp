// Devices are listed, selected by index or name, and unknown selectors are refused.

#include <algorithm>

#include <gtest/gtest.h>

#include "gpu/driver_fault.h"
#include "gpu/egl_context.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string errorFor(const std::string& selector)
{
  try
  {
    const EglContext context(selector);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}

TEST(Device, EveryListedOneCanBeChosenByItsIndexAndByPartOfItsRenderer)
{
  const std::vector<Device> devices = listDevices();
  ASSERT_FALSE(devices.empty()) << "no EGL device here; install Mesa";
  for (const Device& device : devices)
  {
    EXPECT_EQ(EglContext(std::to_string(device.index)).device().renderer, device.renderer);
    std::string part = device.renderer.substr(0, 6);
    std::transform(part.begin(), part.end(), part.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_EQ(EglContext(part).device().renderer.substr(0, 6), device.renderer.substr(0, 6));
  }
}

TEST(Device, AutoPrefersHardware)
{
  const std::vector<Device> devices = listDevices();
  const bool has_hardware =
      std::any_of(devices.begin(), devices.end(), [](const Device& device) { return !device.software; });
  EXPECT_EQ(EglContext("auto").device().software, !has_hardware);
}

TEST(Device, UnknownDeviceIsRefusedWithAListOfDevices)
{
  for (const std::string selector : {"no such renderer", "999", "99999999999999999999"})
  {
    const std::string error = errorFor(selector);
    EXPECT_NE(error.find("no usable EGL device for '" + selector + "'"), std::string::npos) << error;
    EXPECT_NE(error.find(listDevices().front().renderer), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

TEST(Device, IsRefusedIfItsDriverIsKnownToComputeWrongAnswers)
{
  EXPECT_NE(driverFault("zink (llvmpipe (LLVM 15.0.6, 256 bits))").find("zink"), std::string::npos);
  EXPECT_EQ(driverFault("llvmpipe (LLVM 15.0.6, 256 bits)"), "");
  EXPECT_EQ(driverFault("NVIDIA H200/PCIe/SSE2"), "");
}

TEST(GlThread, PassesOnWhatAJobThrowsAndGoesOn)
{
  GlThread thread("auto");
  EXPECT_THROW(thread.run([] { throw Error("from the job"); }), Error);
  int ran = 0;
  thread.run([&] { ++ran; });
  EXPECT_EQ(ran, 1);
}

TEST(GlThread, FailsToStartWithoutADevice)
{
  EXPECT_THROW(GlThread("no such renderer"), Error);
}
}  // namespace
}  // namespace gpu_planning_scene::core
