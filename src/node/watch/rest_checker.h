#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gpu_planning_scene/state_inspector.h"
#include "node/watch/watched.h"
#include "service/make_checker.h"

namespace gpu_planning_scene::core
{
/// Checks the rest of all watched trajectories, as one motion of the whole robot. Used by one thread.
class RestChecker
{
 public:
  using InspectorOf =
      std::function<std::shared_ptr<const StateInspector>(const std::shared_ptr<const PlanningScene>& scene)>;

  /// `make_checker`: makes the checker, when it is first needed. `inspector_of`: the inspector of a scene, for
  /// contacts.
  RestChecker(MakeChecker make_checker, InspectorOf inspector_of, const MotionCheckerOptions& options);

  /// Sets the verdict of `state`, and what belongs to it. `watched`: not empty, with the places of the robot.
  /// `with_contact`: whether a collision gets its contact. Throws Error if the rest cannot be checked, and Cancelled
  /// after `is_over` has returned true.
  void check(const Snapshot& scene, const std::vector<Watched>& watched, bool with_contact,
             const std::function<bool()>& is_over, WatchState& state);

 private:
  void takeScene(const std::shared_ptr<const PlanningScene>& scene);
  void checkStart(const Snapshot& scene, const std::vector<Watched>& watched, const TimedRows& rest,
                  const std::function<bool()>& is_over, WatchState& state) const;
  void addContact(const MotionOutlook& outlook, const PlanningScene& scene, WatchState& state) const;

  const MakeChecker make_checker_;
  const InspectorOf inspector_of_;
  const MotionCheckerOptions options_;
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const PlanningScene> scene_;  // of the checker; null: it has not taken the last one
};
}  // namespace gpu_planning_scene::core
