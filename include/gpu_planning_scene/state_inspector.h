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
/// A contact of two colliding bodies. Moving the second body along the normal by the depth ends their collision. See
/// ContactInformation.msg for the depth and the point of each kind of bodies.
struct Contact
{
  BodyPair bodies;         ///< body indices, ascending
  Eigen::Vector3d point;   ///< metres, in the planning frame; belongs to both bodies, up to 1e-6 m
  Eigen::Vector3d normal;  ///< unit length, in the planning frame, from the first body to the second
  double depth = 0.0;      ///< metres, above 0; for padded pairs it includes the required distance
};

/// Clearance of a state, in metres: the smallest gap between two bodies minus the required distance (see StateChecker).
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
  /// Metres: the gap minus the required distance, as Clearance. In collision: minus the depth of the pair's contacts.
  double distance = std::numeric_limits<double>::infinity();
  /// The nearest points of the two surfaces without padding, in the planning frame. In collision, both are the point of
  /// the deepest contact. Their distance is correct to 3e-6 m. NaN if no pair is checked.
  std::array<Eigen::Vector3d, 2> points = {Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
                                           Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
};

/// The nearest pairs of a state: see Clearance.
struct NearestPairs
{
  NearestPair world;
  NearestPair self;
};

/// Which distances are computed.
struct DistanceQuery
{
  /// Metres: pairs whose BodyDistance::distance is not below this are left out. Infinity: no pair is left out.
  double range = std::numeric_limits<double>::infinity();
  /// True: only the nearest pair of each link and attached object. It takes much less time than all pairs.
  bool nearest_of_each_body = false;
  bool gradients = true;  ///< see BodyDistances::gradients
  /// False: a pair in collision has the distance 0, and neither points nor a normal. It takes less time.
  bool signed_distance = true;
};

/// The distance of a pair of bodies.
struct BodyDistance
{
  BodyPair bodies;        ///< body indices; the first is a link or an attached object
  bool collides = false;  ///< by the exact checker
  /// Metres: the gap minus the required distance, as NearestPair::distance; a pair that is free may have 0. In
  /// collision: minus the depth of the pair's deepest contact, which is the length of a translation that separates the
  /// bodies; a shorter translation may exist.
  double distance;
  /// In collision: no translation shorter than this separates the bodies. 0: no such length is known.
  double depth_at_least = 0.0;
  /// As NearestPair::points, in the order of the bodies.
  std::array<Eigen::Vector3d, 2> points;
  /// Unit length, in the planning frame, from the first body to the second. If the second body moves along it, the
  /// distance grows. NaN if the surfaces are nearer than 1e-9 m without a collision, because such a distance has no
  /// direction, and in collision without signed_distance.
  Eigen::Vector3d normal;
};

/// The distances of states.
struct BodyDistances
{
  /// One more than the states: the pairs of state i are those from first[i] to before first[i + 1].
  std::vector<std::size_t> first;
  /// Ascending by their bodies. With nearest_of_each_body, each link and each attached object is at most once the first
  /// of the bodies.
  std::vector<BodyDistance> pairs;
  /// Row-major, one row per pair: the derivative of the distance by each variable, in metres per unit of the variable.
  /// It belongs to the points of the pair: if other points are equally near, these would give other derivatives. In
  /// collision, it belongs to the contact, which moves with the bodies. The derivatives by the values of a quaternion
  /// are those before it is normalised. A row without a normal is NaN. Empty unless the query has gradients.
  std::vector<double> gradients;
};

/// Computes contacts, clearances and distances of states of one scene. They take much longer than a check.
/// Thread-safe.
class StateInspector
{
 public:
  /// `previous`: an inspector of an earlier scene. Its trees are reused. It may be destroyed afterwards. Throws Error
  /// if the scene is not valid.
  explicit StateInspector(std::shared_ptr<const PlanningScene> scene, const StateInspector* previous = nullptr);
  ~StateInspector();

  /// The scene of this inspector.
  const std::shared_ptr<const PlanningScene>& scene() const;

  /// Contacts of the pairs that collide by the exact checker: at most `max_contacts`, and at most `max_per_pair` for
  /// each pair (0: no limit per pair). No pair has more than 256. The deepest contact of each pair comes first, by
  /// depth; the further contacts of all pairs follow. `state`: one value per variable. Throws Error for an unknown
  /// group, or a value that is not finite or beyond Variable::largest. The contacts of a pair differ only in their
  /// points. The first point is where the bodies overlap most. The further points are on the curve where the surfaces
  /// cross. Only pairs with a mesh, pairs of boxes, and several shapes over a half-space have further points.
  std::vector<Contact> contacts(const double* state, const std::string& group, std::size_t max_contacts,
                                std::size_t max_per_pair) const;

  /// Clearance by the exact checker's tests. Throws Error as contacts() does.
  Clearance clearance(const double* state, const std::string& group) const;

  /// The clearances of `count` states, computed on all cores. `states`: one row per state. Throws Error as contacts()
  /// does.
  std::vector<Clearance> clearances(const double* states, std::size_t count, const std::string& group) const;

  /// The nearest pairs of `count` states, computed on all cores. Throws Error as contacts() does.
  std::vector<NearestPairs> nearestPairs(const double* states, std::size_t count, const std::string& group) const;

  /// The distances of the bodies of `count` states, computed on all cores. Throws Error as contacts() does, and if the
  /// range is not above 0.
  BodyDistances distances(const double* states, std::size_t count, const std::string& group,
                          const DistanceQuery& query) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
