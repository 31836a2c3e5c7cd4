#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/PlannerData.h>

#include "planning/search/nearest_state.h"

namespace gpu_planning_scene::core
{
/// A tree of states that grows from one or several roots, with a search for the nearest state. Not thread-safe.
class RrtTree
{
 public:
  struct Vertex
  {
    ompl::base::State* state = nullptr;
    const Vertex* parent = nullptr;  // null: a root
    bool removed = false;
    bool proven = false;       // the motion from the parent is valid by the validator's own rule
    bool at_obstacle = false;  // a motion from here towards a random state was not valid
    std::size_t number = 0;    // in vertices()

    const Vertex& root() const;
  };

  /// Makes an empty tree. Distances are those of the planner's space.
  explicit RrtTree(const ompl::base::Planner& planner);
  ~RrtTree();
  RrtTree(const RrtTree&) = delete;
  RrtTree& operator=(const RrtTree&) = delete;

  /// Adds a copy of the state. The vertex exists as long as the tree.
  const Vertex& add(const ompl::base::State* state, const Vertex* parent);
  /// Removes these vertices, which must not be roots, and everything that grew from them: nearest() no longer returns
  /// them.
  void remove(const std::vector<const Vertex*>& vertices);
  /// Sets Vertex::proven.
  void setProven(const Vertex& vertex) { vertices_[vertex.number]->proven = true; }
  /// Sets Vertex::at_obstacle.
  void setAtObstacle(const Vertex& vertex) { vertices_[vertex.number]->at_obstacle = true; }
  /// The vertex nearest to the state. The tree must not be empty.
  const Vertex& nearest(const ompl::base::State* state);
  /// All vertices, removed ones included; parents come before children.
  const std::vector<std::unique_ptr<Vertex>>& vertices() const { return vertices_; }
  /// The number of vertices that are not removed.
  std::size_t size() const { return size_; }

 private:
  ompl::base::SpaceInformationPtr information_;
  std::vector<std::unique_ptr<Vertex>> vertices_;
  std::size_t size_ = 0;
  NearestState nearest_;
  std::vector<const Vertex*> vertex_of_;  // of each state of nearest_
  bool is_stale_ = false;                 // nearest_ still has removed vertices; the next search removes them
};
}  // namespace gpu_planning_scene::core
