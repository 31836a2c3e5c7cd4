#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "model/full_states.h"
#include "service/state_history.h"

namespace gpu_planning_scene::core
{
/// The pose of the robot that is used while no state has set its virtual joint.
struct AssumedBase
{
  std::vector<double> values = {};  ///< of virtualVariables(); empty: the robot stands at the origin
  /// A warning about this pose in one line, or empty. If there are no values: the reason.
  std::string warning = {};
  double age = 0.0;  ///< seconds; 0: of a base that does not move
};

/// An immutable scene, and the robot's state at the same instant.
struct Snapshot
{
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> state;  ///< one value per variable
  std::vector<bool> known;    ///< one per variable; an unknown variable has its default value, or that of `base`
  std::vector<double> ages;   ///< one per variable: seconds since SceneStore::updateState has set it; else infinity
  AssumedBase base = {};
  /// Why the octomap may not be that of now, in one line (SceneStore::setOctomapFault). Empty: nothing is wrong with
  /// it.
  std::string octomap_fault = {};
  /// The oldest stamp (nanoseconds) of the known values; 0: a known value has no stamp, or no value is known.
  std::int64_t stamp = 0;
  std::vector<std::int64_t> stamps = {};  ///< of the values (nanoseconds), one per variable; 0: none

  /// Whether SceneStore::updateState has set the variable in the last second. This is longer than between two messages
  /// of a running robot's joints. A joint whose messages end takes values from others.
  bool isMeasured(int variable) const { return ages[static_cast<std::size_t>(variable)] <= 1.0; }
  /// A fault in one line if SceneStore::updateState has set a variable, but not in the last 2.5 s, or if the pose of
  /// `base` is older: the joint may be anywhere by now. Empty: there is no such variable. `others`: variables that do
  /// not count.
  std::string endedVariable(const std::vector<int>& others = {}) const;
  /// Whether all variables are known. The virtual joint counts as known if `base` has values. Passive joints always
  /// count as known.
  bool allKnown() const;
  /// The state with the variables that are known. The virtual joint always counts as known: without a value, the robot
  /// stands at the origin of the planning frame. Passive joints without a value have their default value.
  PartialState partialState() const;
  /// A warning if this pose of the robot is only assumed and `given` does not set the virtual joint; otherwise empty.
  std::string assumedBase(const std::vector<int>& given) const;
};

/// Removes from `change` the values of variables that are not known, for example of a base that only the BaseSource
/// knows.
void dropUnknown(const Snapshot& now, SceneChange& change);
/// Removes from `change` the values of measured variables (Snapshot::isMeasured), because a followed node may have
/// older ones.
void dropMeasured(const Snapshot& now, SceneChange& change);

/// The scene of a running service. A change is made completely or not at all. Thread-safe; readers never wait for a
/// change.
class SceneStore
{
 public:
  /// Returns the pose of the robot at a time in nanoseconds (0: the newest pose). It is called for each snapshot, while
  /// no state has set any variable of the virtual joint. It must be thread-safe, and must not wait. Throws Error if the
  /// pose of that time is no longer available, and NotKnownYet if it is not yet available; neither for 0.
  using BaseSource = std::function<AssumedBase(std::int64_t stamp)>;

  /// The robot's state starts as the current state of `scene`; without one, it is unknown. Without `base_source`, the
  /// robot stands at the origin of the planning frame until a state sets the virtual joint.
  SceneStore(PlanningScene scene, SceneDefaults defaults, SceneLimits limits, BaseSource base_source = {});

  Snapshot snapshot() const;
  const SceneLimits& limits() const { return limits_; }

  struct Applied
  {
    std::uint64_t revision = 0;  ///< of the scene after the change
    std::vector<std::string> warnings;
  };
  /// Returns the pose of a frame that the scene does not have. It may wait, because no lock is held. Throws Error if it
  /// does not find the frame.
  using Lookup = std::function<Eigen::Isometry3d(const StampedFrame&)>;
  /// Calls applyChange. Changes are made one after the other. Each change increases the revision by 1. If it throws,
  /// nothing has changed.
  Applied apply(const SceneChange& change, const Lookup& lookup);

  /// From now on, the ages of variables that updateState has set go on when a change sets them: the scene follows that
  /// of another node, whose values may be older than those that have ended here.
  void keepAges() { keeps_ages_ = true; }

  /// From now on, only sense() changes the octomap of the scene: apply() and clear() leave it, see keepingOctomap.
  void reserveOctomap() { octomap_is_sensed_ = true; }
  /// `find`: returns Snapshot::octomap_fault. It is called for each snapshot; it must be thread-safe, must not wait,
  /// and must not use the store. An empty function ends this, and is waited for.
  void setOctomapFault(std::function<std::string()> find);
  /// As apply(), for a change by sensors, which needs no frames.
  Applied sense(const SceneChange& change) { return make(change, {}, false); }

  struct Preview
  {
    Snapshot snapshot;  ///< its scene has the revision of the store's scene
    std::vector<std::string> warnings;
  };
  /// The scene and the state that apply() would leave after all these changes. The store stays as it is. Throws the
  /// errors of apply(). `from`: where the changes begin; no value: the store's newest scene.
  Preview preview(const std::vector<SceneChange>& changes, const Lookup& lookup,
                  const std::optional<Snapshot>& from = {}) const;

  /// Makes a change that another store has made. The scene gets the revision that it has there. The change must bring
  /// all its frames. If it throws, nothing has changed.
  void follow(const SceneChange& change, std::uint64_t revision);

  /// The scene of this revision, with the newest state of the robot. Waits until `until` for a revision that is above
  /// the newest one. Throws UnknownRevision if the scene does not come, or is no longer kept; ShuttingDown soon after
  /// `stop` returns true during the wait.
  Snapshot at(std::uint64_t revision, std::chrono::steady_clock::time_point until,
              const std::function<bool()>& stop = {}) const;
  /// Drops the earlier scenes that were replaced and used last before `time`. At most 64 are kept, with at most 200,000
  /// shapes. Those that at() has returned lately are kept longest.
  void forgetReplaced(std::chrono::steady_clock::time_point time);

  /// Removes all objects and attached objects with their entries in the allowed collision matrix, and all colours. The
  /// entries of the octomap stay. (After reserveOctomap(), the octomap stays too.) Warns if a removed entry forbade a
  /// contact that the default of the other body allows with a new object of that name.
  Applied clear();

  /// Sets the robot's variables, by name; names that the robot lacks are ignored. The revision stays the same.
  /// `stamp`: nanoseconds; 0: unknown. Returns a warning if a variable already has a value of a later time: the new
  /// value counts all the same, as in MoveIt. Otherwise returns an empty text. A variable whose value is not finite is
  /// unknown from then on: its old value may be wrong by now. After the others are set, it throws Error.
  std::string updateState(const std::map<std::string, double>& variables, std::int64_t stamp = 0);
  /// The state at `stamp` (nanoseconds; 0: the newest state), from the values before and after it. A variable without
  /// stamps has its newest value. Throws the errors of StateHistory::setAt and of BaseSource.
  std::vector<double> stateAt(std::int64_t stamp) const;

  /// Called after each change with the scenes before and after it, in the order of revisions. During the call, readers
  /// continue and other changes wait. A listener must not change the scene.
  using Listener = std::function<void(const std::shared_ptr<const PlanningScene>& before,
                                      const std::shared_ptr<const PlanningScene>& after)>;
  /// Each owner has one listener. An empty listener removes it.
  void setListener(const void* owner, Listener listener);

 private:
  /// An earlier scene, for at().
  struct Replaced
  {
    std::chrono::steady_clock::time_point time;  // of the replacement or of the last use
    std::shared_ptr<const PlanningScene> scene;
    std::size_t shapes;
  };

  Applied make(const SceneChange& change, const Lookup& lookup, bool keeps_octomap);
  std::uint64_t replace(PlanningScene scene, const std::map<std::string, double>& variables, std::uint64_t revision);
  void keep(const std::shared_ptr<const PlanningScene>& replaced);
  std::string octomapFault() const;
  AssumedBase assumeBase(std::int64_t stamp, const std::vector<bool>& known, std::vector<double>& state) const;

  std::mutex changes_;        // held during a change
  mutable std::mutex mutex_;  // guards the next eight members
  std::shared_ptr<const PlanningScene> scene_;
  std::vector<double> state_;
  std::vector<bool> known_;
  std::vector<std::int64_t> stamps_;                                // of the values; 0: unknown
  std::vector<std::chrono::steady_clock::time_point> measured_at_;  // when updateState set it last; initially min()
  StateHistory history_;
  mutable std::deque<Replaced> replaced_;  // in the order of their times
  std::size_t replaced_shapes_ = 0;
  mutable std::condition_variable arrived_;
  std::atomic<bool> octomap_is_sensed_{false};
  std::atomic<bool> keeps_ages_{false};
  mutable std::mutex octomap_mutex_;  // guards the next member; held during its call
  std::function<std::string()> octomap_fault_;
  const SceneDefaults defaults_;
  const SceneLimits limits_;
  const BaseSource base_source_;
  const std::vector<int> virtual_variables_;
  std::map<const void*, Listener> listeners_;  // guarded by changes_
};
}  // namespace gpu_planning_scene::core
