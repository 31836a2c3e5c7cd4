#include "node/sensors/measured_at.h"

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
MeasuredAt measuredAt(const std_msgs::Header& header, const SceneStore& store, const SceneStore::Lookup& lookup)
{
  if (header.frame_id.empty())
    throw Error("header.frame_id is empty; name the frame of the sensor");
  MeasuredAt measured;
  measured.now = store.snapshot();
  if (!measured.now.allKnown())
    throw Error(
        "the robot's state is not known yet, so points on the robot cannot be removed; publish joint_states first");
  // The history decides about values with stamps, if the measurement has one.
  std::vector<int> with_history;
  for (std::size_t i = 0; i < measured.now.stamps.size(); ++i)
    if (!header.stamp.isZero() && measured.now.stamps[i] != 0)
      with_history.push_back(static_cast<int>(i));
  if (const std::string fault = measured.now.endedVariable(with_history); !fault.empty())
    throw Error(fault);
  const StampedFrame frame{header.frame_id, static_cast<std::int64_t>(header.stamp.toNSec())};
  measured.state = store.stateAt(frame.stamp);
  const std::optional<Eigen::Isometry3d> known = measured.now.scene->frame(frame.name, measured.state.data());
  measured.sensor = known ? *known : lookup(frame);
  return measured;
}
}  // namespace gpu_planning_scene::core
