// Devices are listed, selected by index or name, and unknown selectors are refused.

#include <algorithm>
#include <cstdlib>
#include <iostream>

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

/// Prints the error for `selector`, and the number of usable devices, of a driver that says that it is zink.
[[noreturn]] void selectADeviceOfZink(const char* selector)
{
  setenv("force_gl_renderer", "zink (of a test)", 1);  // an option of Mesa's drivers: GL_RENDERER
  std::cerr << errorFor(selector) << "\n";
  const std::vector<Device> devices = listDevices();
  if (!devices.empty() && devices.front().version.find("Mesa") == std::string::npos)
    std::cerr << "only Mesa's drivers take another name\n";
  std::cerr << devices.size() << " devices\n";
  std::_Exit(0);
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
  // A display that a process has used keeps its name, so each selector gets a new process.
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  for (const char* selector : {"auto", "software", "0", "zink"})
    EXPECT_EXIT(selectADeviceOfZink(selector), testing::ExitedWithCode(0),
                "unusable: the driver of 'zink .of a test.' computes wrong answers.*\n0 devices"
                "|only Mesa's drivers take another name");
}

TEST(Device, ThatTranslatesToVulkanHasAFaultyDriver)
{
  EXPECT_NE(driverFault("zink (llvmpipe (LLVM 15.0.6, 256 bits))").find("zink"), std::string::npos);
  EXPECT_NE(driverFault("virgl (zink (NVIDIA GeForce RTX 4060))"), "");
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
