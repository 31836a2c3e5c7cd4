#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "model/full_states.h"
#include "service/state_history.h"

namespace gpu_planning_scene::core
{
/// An immutable scene, and the robot's state in the same instant.
struct Snapshot
{
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> state;  ///< one value per variable
  std::vector<bool> known;    ///< which of them are known; the others have their default

  bool allKnown() const;
  PartialState partialState() const;
};

/// The scene of a running service, which changes wholly or not at all. Thread-safe; readers never wait for a change.
class SceneStore
{
 public:
  /// What `scene` knows of the robot's state is known from the start.
  SceneStore(PlanningScene scene, SceneDefaults defaults, SceneLimits limits);

  Snapshot snapshot() const;
  const SceneLimits& limits() const { return limits_; }

  struct Applied
  {
    std::uint64_t revision = 0;  ///< of the scene with the change in it
    std::vector<std::string> warnings;
  };
  /// Finds a frame that the scene does not know; it may wait, as no lock is held. Throws Error.
  using Lookup = std::function<Eigen::Isometry3d(const FrameAt&)>;
  /// See applyChange. One change comes after the other; the revision grows by 1. What throws changes nothing.
  Applied apply(const SceneChange& change, const Lookup& lookup);

  /// Removes all objects, those that links carry too, with their entries in the allowed-collision matrix, and all
  /// colours. Returns the new revision.
  std::uint64_t clear();

  /// Takes the robot's variables, by name; other names are passed over. The revision stays. Throws Error and takes
  /// nothing if a value is not finite. `stamp`: nanoseconds; 0 where it is not known.
  void updateState(const std::map<std::string, double>& variables, std::int64_t stamp = 0);
  /// The state with the nearest stamp (nanoseconds; 0: the newest) of the last seconds; the newest where states came
  /// without stamps. Throws Error: longer ago than what is kept.
  std::vector<double> stateAt(std::int64_t stamp) const;

  /// Called after each change with the scenes before and after it, in the order of revisions. Readers go on meanwhile,
  /// other changes wait; it must not change the scene itself.
  using Listener = std::function<void(const std::shared_ptr<const PlanningScene>& before,
                                      const std::shared_ptr<const PlanningScene>& after)>;
  void setListener(Listener listener);

 private:
  std::uint64_t replace(PlanningScene scene, const std::map<std::string, double>& variables);
  void setVariables(const std::map<std::string, double>& variables);

  std::mutex changes_;        // held by whoever makes a change
  mutable std::mutex mutex_;  // of the four below
  std::shared_ptr<const PlanningScene> scene_;
  std::vector<double> state_;
  std::vector<bool> known_;
  StateHistory history_;
  const SceneDefaults defaults_;
  const SceneLimits limits_;
  Listener listener_;  // changes_ guards it
};
}  // namespace gpu_planning_scene::core
