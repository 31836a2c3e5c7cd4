#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/inverse_kinematics/degrees_of_freedom.h"
#include "model/inverse_kinematics/descent.h"
#include "model/inverse_kinematics/start_states.h"

namespace gpu_planning_scene::core
{
/// A search for states that fulfil constraints, one after the other: see InverseKinematics::solve. Not thread-safe.
class IkSearch
{
 public:
  /// `state`: one value per variable of the robot. `kinematics` must outlive this object.
  IkSearch(const InverseKinematics& kinematics, const double* state, const IkOptions& options);

  /// The next distinct solution; no value: the attempts have ended, or `stop` returned true.
  std::optional<std::vector<double>> next(const std::function<bool()>& stop = {});

  std::size_t attempts() const { return attempts_; }
  /// The state of a failed attempt that came nearest to fulfilling the constraints; empty if none failed.
  const std::vector<double>& nearest() const { return nearest_; }

 private:
  bool isDistinct(const std::vector<double>& state) const;

  const InverseKinematics& kinematics_;
  const IkOptions options_;
  const DegreesOfFreedom freedoms_;
  Descent descent_;
  const std::vector<double> given_;  // within the ranges of the constraints
  StartStates starts_;
  std::vector<std::vector<double>> found_;
  std::size_t attempts_ = 0;
  std::vector<double> nearest_;
  double least_error_ = std::numeric_limits<double>::infinity();
};
}  // namespace gpu_planning_scene::core
