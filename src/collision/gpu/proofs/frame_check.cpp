#include "collision/gpu/proofs/frame_check.h"

#include <cmath>
#include <random>

#include "collision/gpu/proofs/proof_names.h"
#include "shader_constants.h"

// A driver may compile the generated shader wrongly. Each entry of a frame is compared with the robot model in double,
// with the bounds on which the proofs rely (docs/error_bounds.md). Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Whether the rows of a frame in a state are those of `pose`, within its bounds. A row of a state follows that of the
/// state before.
bool isNear(const float* rows, const Eigen::Isometry3d& pose, const LaneFrameError& error)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
    {
      const float found =
          rows[4 * kFrameCheckStates * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)];
      const double allowed = column == 3 ? error.position_error : error.rotation_error;
      if (!(std::abs(static_cast<double>(found) - pose(row, column)) <= allowed))
        return false;
    }
  return true;
}
}  // namespace

std::vector<double> statesOfFrameCheck(const RobotModel& robot)
{
  std::mt19937_64 generator(20043);
  const std::size_t width = robot.variables().size();
  std::vector<double> states(kFrameCheckStates * width);
  for (std::size_t i = 0; i < kFrameCheckStates; ++i)
    robot.randomState(generator, states.data() + i * width);
  return states;
}

std::string findFrameFault(const RobotModel& robot, const LaneScene& scene, const std::vector<double>& states,
                           const std::vector<float>& rows, const std::vector<std::uint32_t>& verdicts)
{
  const std::size_t width = robot.variables().size();
  const std::vector<int> places = placesOfFrames(scene.model());
  std::vector<Eigen::Isometry3d> links(robot.links().size());
  for (std::size_t state = 0; state < kFrameCheckStates; ++state)
  {
    if (verdicts[state] != VERDICT_FREE && verdicts[state] != VERDICT_OPEN)
      continue;
    robot.linkPoses(states.data() + state * width, links.data());
    for (std::size_t link = 0; link < links.size(); ++link)
    {
      const int frame = scene.frames().ofLink(link);
      const int place = places[static_cast<std::size_t>(frame)];
      if (place < 0)
        continue;
      Eigen::Isometry3d pose = links[link];
      pose.translation() -= scene.origin();
      pose = pose * scene.frames().poseInFrame(link).inverse();
      const std::size_t first = 4 * (3 * kFrameCheckStates * static_cast<std::size_t>(place) + state);
      if (!isNear(rows.data() + first, pose, scene.frames().error(frame)))
        return "link '" + robot.links()[link].name + "' is elsewhere than the robot model says";
    }
  }
  return {};
}
}  // namespace gpu_planning_scene::core
