#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "collision/cpu/lanes/lane_model.h"
#include "collision/cpu/lanes/lane_rounding.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Bounds for a frame of the lane kernel. Lengths are in metres.
struct LaneFrameError
{
  double step = 0.0;              ///< largest distance of the frame's origin from the origin of its parent
  double largest_distance = 0.0;  ///< largest distance of the frame's origin from the origin of coordinates
  double rotation_error = 0.0;    ///< of a rotated vector of length 1
  double position_error = 0.0;    ///< of the frame's origin
};

/// The frames of a robot in the form of the lane kernel, with bounds of the kernel's rounding errors. Links that are
/// rigidly connected share a frame. Immutable.
class LaneFrames
{
 public:
  /// The values of a variable for which the error bounds hold: those within `reach` of `middle`.
  struct Limit
  {
    double middle = 0.0;
    double reach = std::numeric_limits<double>::max();
  };

  /// `origin`: of the kernel's coordinates, in the planning frame. `rounding`: of the code that computes the frames.
  LaneFrames(const RobotModel& robot, const Eigen::Vector3d& origin, const lanes::Rounding& rounding);

  const std::vector<lanes::Frame>& frames() const { return frames_; }
  const lanes::Base& base() const { return base_; }
  int ofLink(std::size_t link) const { return frame_of_link_[link]; }
  /// The pose of a link in its frame.
  const Eigen::Isometry3d& poseInFrame(std::size_t link) const { return in_frame_[link]; }
  const LaneFrameError& error(int frame) const { return errors_[static_cast<std::size_t>(frame)]; }

  /// An upper bound of the distance between the origins of two frames, in metres: the sum of the steps between them.
  double distanceBetween(int a, int b) const;

  /// Whether the error bounds hold for a state: no value is too large for float arithmetic.
  bool isWithinBounds(const double* state) const;
  /// The bounds of each variable for isWithinBounds.
  const std::vector<Limit>& limits() const { return limits_; }

 private:
  /// A motion along an axis, by multiplier * variable + offset.
  struct Slide
  {
    Eigen::Vector3d axis;
    int variable;
    double middle;  // of the variable
    double reach;   // metres: the largest distance of the variable from the middle
    double multiplier = 1.0;
    double offset = 0.0;
  };

  int addFramesOf(const RobotModel& robot, const Joint& joint, int parent, const Eigen::Isometry3d& origin);
  int addTurn(const Joint& joint, int variable, int parent, const Eigen::Isometry3d& origin);
  int addSlide(const Slide& slide, int parent, const Eigen::Isometry3d& origin);
  int addQuaternion(int variable, int parent);
  int addFrame(lanes::Frame frame, int parent, double step, double rotation_error);
  void limit(int variable, const Limit& limit);

  lanes::Rounding rounding_;
  std::vector<int> frame_of_link_;
  std::vector<Eigen::Isometry3d> in_frame_;  // of each link
  std::vector<Limit> limits_;                // of each variable
  std::vector<lanes::Frame> frames_;
  lanes::Base base_{};
  std::vector<LaneFrameError> errors_;
};
}  // namespace gpu_planning_scene::core
