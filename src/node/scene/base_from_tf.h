#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "node/scene/frame_lookup.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The robot's pose by tf: the value of a planar or floating virtual joint for which the root link is where tf has it
/// in the planning frame. Thread-safe.
class BaseFromTf
{
 public:
  /// Looks up a frame, and throws tf2::TransformException if tf does not know it.
  using Find = std::function<FrameLookup::Found(const StampedFrame& frame)>;
  /// The time now in nanoseconds, on the clock of the stamps.
  using Now = std::function<std::int64_t()>;

  BaseFromTf(const FrameLookup& frames, std::shared_ptr<const RobotModel> robot);
  BaseFromTf(Find find, Now now, std::shared_ptr<const RobotModel> robot);

  /// The pose at a time in nanoseconds, or the newest pose for 0. If tf no longer knows the root link, the newest pose
  /// is the last one that tf had, with a warning. No values: tf never had a pose. For another time than 0, throws
  /// NotKnownYet if tf has no pose of this time yet, and Error if it only has later ones.
  AssumedBase at(std::int64_t stamp);

 private:
  AssumedBase thatOf(std::int64_t stamp);
  AssumedBase newest();
  double ageOf(const FrameLookup::Found& found) const;
  std::string frames() const;  // for messages

  const Find find_;
  const Now now_;
  const std::shared_ptr<const RobotModel> robot_;
  const Joint* joint_ = nullptr;  // null: the robot has no virtual joint with variables
  std::string root_;
  std::mutex mutex_;
  std::optional<FrameLookup::Found> newest_;  // guarded by mutex_
};
}  // namespace gpu_planning_scene::core
