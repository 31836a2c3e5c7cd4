#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Which pairs of bodies may touch, by name (links and objects). As in MoveIt: an entry for the pair decides; without
/// one the default entries of the two bodies do (both present: allowed only if both allow; one present: that one);
/// without either the pair is checked.
class AllowedCollisionMatrix
{
  struct Body;

 public:
  /// The SRDF's matrix; without an SRDF the adjacent links are allowed.
  static AllowedCollisionMatrix fromRobot(const RobotModel& robot);

  void setEntry(const std::string& body_1, const std::string& body_2, bool allowed);
  void setDefault(const std::string& body, bool allowed);
  /// Removes all entries of a body and its default, as if the matrix had never named it.
  void removeEntry(const std::string& body);
  bool allowed(const std::string& body_1, const std::string& body_2) const;

  std::vector<std::string> bodies() const;             ///< that it has an entry or a default of, in alphabetical order
  std::vector<std::string> bodiesWithEntries() const;  ///< likewise
  std::optional<bool> defaultOf(const std::string& body) const;
  /// The bodies that an entry allows to touch `body`, in alphabetical order. Defaults do not count.
  std::vector<std::string> allowedPartners(const std::string& body) const;
  /// Whether it has the same entries and defaults.
  bool operator==(const AllowedCollisionMatrix& other) const { return bodies_ == other.bodies_; }

  /// What the matrix knows of a body: for looking at many pairs of a body without looking for its name each time.
  /// Valid as long as the matrix and the name are there and unchanged.
  class Row
  {
   public:
    bool allowed(const Row& other) const;
    /// Whether the matrix has the body. It says the same of all that it has not; a row made by `Row()` is one of those.
    bool known() const { return body_ != nullptr; }

   private:
    friend class AllowedCollisionMatrix;
    const std::string* name_ = nullptr;
    const Body* body_ = nullptr;  // null: nothing
  };
  Row row(const std::string& body) const;
  Row row(const std::string&& body) const = delete;  // the name would be gone

 private:
  struct Body
  {
    std::map<std::string, bool> entries;  // by the other body; each pair is with both
    std::optional<bool> by_default;
    bool operator==(const Body& other) const { return entries == other.entries && by_default == other.by_default; }
  };

  /// Removes the entry for `other` from those of `body`, and `body` where it was its last.
  void removeHalfOfEntry(const std::string& body, const std::string& other);

  std::map<std::string, Body> bodies_;
};
}  // namespace gpu_planning_scene::core
