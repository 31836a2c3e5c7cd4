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
/// A contact point of two colliding bodies.
struct Contact
{
  BodyPair bodies;         ///< body indices, ascending
  Eigen::Vector3d point;   ///< metres, in the planning frame
  Eigen::Vector3d normal;  ///< unit length, in the planning frame, from the first body to the second
  double depth = 0.0;      ///< penetration in metres; for padded pairs it includes the required distance
};

/// Clearance of a state, in metres beyond the required distance (see StateChecker).
struct Clearance
{
  /// `world`: between the robot (with its attached objects) and the world objects. `self`: within the robot (with its
  /// attached objects). A lower bound, at most 1e-6 m below the true value. 0 in collision; infinity if no pair is
  /// checked.
  double world = std::numeric_limits<double>::infinity();
  double self = std::numeric_limits<double>::infinity();
  BodyPair nearest_world = kNoPair;  ///< body indices, ascending
  BodyPair nearest_self = kNoPair;
};

/// The pair of bodies that is nearest to a collision, or deepest in collision.
struct NearestPair
{
  BodyPair bodies = kNoPair;  ///< body indices, ascending; kNoPair if no pair is checked
  /// Metres beyond the required distance, as Clearance. In collision: minus the depth of the pair's deepest contact, or
  /// 0 if the pair only touches.
  double distance = std::numeric_limits<double>::infinity();
  /// The nearest points of the two surfaces without padding, in the planning frame. In collision, both are the point of
  /// the deepest contact. They come from FCL, and are correct to 3e-4 m; NaN where FCL does not find such points.
  std::array<Eigen::Vector3d, 2> points = {Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
                                           Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
};

/// The nearest pairs of a state: see Clearance.
struct NearestPairs
{
  NearestPair world;
  NearestPair self;
};

/// Computes contacts and clearances of states of one scene. A clearance takes about a hundred times as long as a check.
/// Thread-safe.
class StateInspector
{
 public:
  /// `previous`: an inspector of an earlier scene. Its trees, also those for FCL, are reused. It may be destroyed
  /// afterwards. Throws Error if the scene is not valid.
  explicit StateInspector(std::shared_ptr<const PlanningScene> scene, const StateInspector* previous = nullptr);
  ~StateInspector();

  /// The scene of this inspector.
  const std::shared_ptr<const PlanningScene>& scene() const;

  /// Contacts of the pairs that collide by the exact checker: at most `max_contacts`, and at most `max_per_pair` for
  /// each pair (0: no limit per pair). The deepest contact of each pair comes first, then the others by depth. `state`:
  /// one value per variable. Throws Error for an unknown group, or a value that is not finite or beyond
  /// Variable::largest. Points, normals and depths come from FCL, except for half-spaces: their single contact is the
  /// deepest point of the other shape. A pair also has a single contact if FCL finds no crossing surfaces. If the
  /// bodies touch, or are within the required distance, this contact is at FCL's nearest points. If one body is inside
  /// the other, this contact is at the inner body. The depth of this contact is then the distance by which the inner
  /// body must move, away from the centre of the other body, to come free.
  std::vector<Contact> contacts(const double* state, const std::string& group, std::size_t max_contacts,
                                std::size_t max_per_pair) const;

  /// Clearance by the exact checker's tests, without FCL's distances. Throws Error as contacts() does.
  Clearance clearance(const double* state, const std::string& group) const;

  /// The clearances of `count` states, computed on all cores. `states`: one row per state. Throws Error as contacts()
  /// does.
  std::vector<Clearance> clearances(const double* states, std::size_t count, const std::string& group) const;

  /// The nearest pairs of `count` states, computed on all cores. Throws Error as contacts() does.
  std::vector<NearestPairs> nearestPairs(const double* states, std::size_t count, const std::string& group) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
