#pragma once

#include <moveit/collision_detection/collision_common.h>

#include "collision/contacts/body_contacts.h"
#include "moveit/pairs/exact_pair.h"
#include "moveit/pairs/pair_filter.h"

namespace gpu_planning_scene::detector
{
/// One call of checkSelfCollision or checkRobotCollision: tests pairs and writes the result. As in MoveIt's detectors,
/// the result is not cleared first: collisions and contacts are added to it.
class CollisionQuery
{
 public:
  /// The arguments must outlive the query.
  CollisionQuery(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                 const PairFilter& filter, PairScratch& scratch);

  /// Whether the result is complete: further pairs cannot change it, or the request's is_done() ends the search.
  bool isDone() const { return is_done_; }

  /// Tests two shape instances whose bounds overlap. Returns isDone().
  bool test(const ShapeInstance& a, const ShapeInstance& b);

 private:
  void addContact(const ShapeInstance& a, const ShapeInstance& b, const core::ShapeContact& contact);
  void addCostSource(const ShapeInstance& a, const ShapeInstance& b);
  /// The number of contacts of this pair that the result still takes.
  std::size_t wantedContacts(const ShapeInstance& a, const ShapeInstance& b) const;
  /// Asks the decider of a colliding pair. Returns whether a contact is not allowed, and adds such contacts.
  bool isRefused(const ShapeInstance& a, const ShapeInstance& b);
  void addCollision(const ShapeInstance& a, const ShapeInstance& b, bool with_contacts);
  bool isComplete() const;

  const collision_detection::CollisionRequest& request_;
  collision_detection::CollisionResult& result_;
  const PairFilter& filter_;
  PairScratch& scratch_;
  bool is_done_ = false;
};
}  // namespace gpu_planning_scene::detector
