#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
struct Contact
{
  BodyPair bodies;         ///< body indices, ascending
  Eigen::Vector3d point;   ///< in the planning frame
  Eigen::Vector3d normal;  ///< unit, from the first body to the second
  double depth = 0.0;      ///< metres; of padded pairs it counts the required distance as well
};

/// How far a state is from a collision.
struct Clearance
{
  /// Metres beyond the required distance, to the objects of the world and of the robot and what it carries to itself:
  /// less than the true value by at most 1e-6. 0 in collision; infinity where no pair is checked.
  double world = std::numeric_limits<double>::infinity();
  double self = std::numeric_limits<double>::infinity();
  BodyPair nearest_world = kNoPair;  ///< body indices, ascending
  BodyPair nearest_self = kNoPair;
};

/// Looks closely at single states of one scene, on the calling thread: for the few states that somebody asks about.
/// Thread-safe.
class StateInspector
{
 public:
  /// Trees, those of FCL too, are kept from scene to scene through `previous`, which may be destroyed afterwards.
  /// Throws Error for a scene that cannot be used.
  explicit StateInspector(std::shared_ptr<const PlanningScene> scene, const StateInspector* previous = nullptr);
  ~StateInspector();

  const std::shared_ptr<const PlanningScene>& scene() const;

  /// Contacts of the pairs that collide by the exact checker: at most `most`, and at most `most_per_pair` of a pair (0:
  /// no bound). The deepest of each pair come first, then the rest by depth. Points, normals and depths are FCL's.
  /// Where FCL sees no surfaces cross there is one contact: of bodies that touch or are within the required distance at
  /// FCL's nearest points, of one body inside another at the inner one, as deep as it has to be moved, away from the
  /// other's centre, to come free. Throws Error for an unknown group or a value that is not finite.
  std::vector<Contact> contacts(const double* state, const std::string& group, std::size_t most,
                                std::size_t most_per_pair) const;

  /// By bisection with the exact checker's test of pairs, not by FCL's distances. Throws Error as above.
  Clearance clearance(const double* state, const std::string& group) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
