// The states that the tool render draws.

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "scene/slider_robot.h"
#include "support/software_device.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
using RenderedStates = OnSoftwareDevice;

TEST_F(RenderedStates, AStateOutsideTheLimitsIsAWarning)
{
  const TemporaryFolder folder;
  const std::string urdf = folder.write("slider.urdf", sliderUrdf());
  const auto draw = [&](const std::string& state)
  {
    return runProgram(GPS_RENDER, {"--urdf", urdf, "--state", state, "--size", "64x48", "--device", "software", "--out",
                                   folder.path("picture.png")})
        .err;
  };
  EXPECT_EQ(0u,
            draw("slide=1,turn=90")
                .find("warning: --state: joint 'turn' is 90, outside its limits -3 to 3 rad; values are in radians, "
                      "and 90 degrees are 1.5708 rad\n"));
  EXPECT_EQ(std::string::npos, draw("slide=1,turn=1.5").find("warning"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
