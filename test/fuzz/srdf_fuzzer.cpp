// An arbitrary SRDF becomes groups and pairs of a known robot, or one line of error.

#include "fuzz/fuzz_target.h"
#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace gpu_planning_scene::core;
  static const std::string urdf = R"(<robot name="test">)" + armUrdf() + "</robot>";
  acceptOrRefuse(
      [&]
      {
        std::vector<std::string> warnings;
        const auto robot = RobotModel::fromXml(urdf, textOf(data, size), RobotModelOptions(), &warnings);
        useRobot(*robot);
        const PlanningScene scene(robot);  // makes a matrix from the SRDF's pairs
      });
  return 0;
}
