#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The allowed collision matrix: names the pairs of bodies (links and objects) that may touch. The rules are MoveIt's:
/// 1. An entry for the pair decides.
/// 2. Without an entry, the defaults of the two bodies decide. If both bodies have a default, both must allow the pair.
/// If one body has a default, this default decides.
/// 3. A pair without an entry and without a default is checked.
/// Concurrent calls of const functions are safe; the caller synchronises changes.
class AllowedCollisionMatrix
{
  struct Body;

 public:
  /// The matrix of the SRDF. Without an SRDF, the matrix allows adjacent links (RobotModel::adjacentLinks) to touch.
  static AllowedCollisionMatrix fromRobot(const RobotModel& robot);

  /// Sets the entry of a pair. The order of the two names does not matter.
  void setEntry(const std::string& body_1, const std::string& body_2, bool allowed);
  void setDefault(const std::string& body, bool allowed);
  /// Removes all entries of a body and its default. Returns the bodies that may touch `body` from now on, sorted by
  /// name: an entry or the default of `body` forbade the contact, and the default of the returned body allows it.
  std::vector<std::string> removeEntry(const std::string& body);
  bool allowed(const std::string& body_1, const std::string& body_2) const;
  /// The entry of a pair; no value: it has none, so that defaults decide.
  std::optional<bool> entryOf(const std::string& body_1, const std::string& body_2) const;

  std::vector<std::string> bodies() const;             ///< all with an entry or a default, sorted by name
  std::vector<std::string> bodiesWithEntries() const;  ///< all with an entry, sorted by name
  /// The default of a body; no value: it has none.
  std::optional<bool> defaultOf(const std::string& body) const;
  /// The bodies that an entry allows to touch `body`, sorted by name. Defaults do not count.
  std::vector<std::string> allowedPartners(const std::string& body) const;
  /// True if both matrices have the same entries and defaults.
  bool operator==(const AllowedCollisionMatrix& other) const { return bodies_ == other.bodies_; }

  /// The entries and the default of one body. A row saves the search for the name when a caller looks up many pairs of
  /// a body. It is valid while the matrix and the name string exist unchanged.
  class Row
  {
   public:
    bool allowed(const Row& other) const;
    /// False if the matrix has no entry and no default of the body. All such bodies get the same answers. A row made by
    /// `Row()` gets these answers too.
    bool known() const { return body_ != nullptr; }

   private:
    friend class AllowedCollisionMatrix;
    const std::string* name_ = nullptr;
    const Body* body_ = nullptr;  // null: the matrix does not have the body
  };
  Row row(const std::string& body) const;
  Row row(const std::string&& body) const = delete;  // a row keeps a pointer to the name

 private:
  struct Body
  {
    std::map<std::string, bool> entries;  // by the name of the other body; both bodies store the entry of a pair
    std::optional<bool> default_allowed;
    bool operator==(const Body& other) const
    {
      return entries == other.entries && default_allowed == other.default_allowed;
    }
  };

  /// Removes the entry for `other` from `body`. A body without any entry or default is removed too.
  void removeHalfOfEntry(const std::string& body, const std::string& other);

  std::map<std::string, Body> bodies_;
};
}  // namespace gpu_planning_scene::core
