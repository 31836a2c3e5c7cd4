#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// Why a test that needs a software renderer cannot run; empty if this machine has one. A machine with a GPU may have
/// only the driver of its vendor.
inline std::string whyNoSoftwareDevice()
{
  std::vector<Device> devices;
  try
  {
    devices = listDevices();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  const bool is_there =
      std::any_of(devices.begin(), devices.end(), [](const Device& device) { return device.software; });
  return is_there ? "" : "this machine has no software renderer; install Mesa's llvmpipe (Debian: libgl1-mesa-dri)";
}

/// The tests of this fixture are skipped where there is no software renderer.
class OnSoftwareDevice : public testing::Test
{
 protected:
  void SetUp() override
  {
    if (const std::string why = whyNoSoftwareDevice(); !why.empty())
      GTEST_SKIP() << why;
  }
};
}  // namespace gpu_planning_scene::core
