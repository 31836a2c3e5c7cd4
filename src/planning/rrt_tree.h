#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/PlannerData.h>
#include <ompl/datastructures/NearestNeighbors.h>

namespace gpu_planning_scene::core
{
/// A tree of states that grows from a root, or several, with the search for the nearest of them.
class RrtTree
{
 public:
  struct Vertex
  {
    ompl::base::State* state = nullptr;
    const Vertex* parent = nullptr;  // null: a root
    bool removed = false;

    const Vertex& root() const;
  };

  /// Empty. Distances are those of the planner's space.
  explicit RrtTree(const ompl::base::Planner& planner);
  ~RrtTree();
  RrtTree(const RrtTree&) = delete;
  RrtTree& operator=(const RrtTree&) = delete;

  /// Takes a copy of the state. The vertex lives as long as the tree.
  const Vertex& add(const ompl::base::State* state, const Vertex* parent);
  /// From now on these vertices, which are no roots, and all that has grown from them are never the nearest.
  void remove(const std::vector<const Vertex*>& vertices);
  /// The tree must not be empty.
  const Vertex& nearest(const ompl::base::State* state);
  /// Parents before children, removed ones too.
  const std::vector<std::unique_ptr<Vertex>>& vertices() const { return vertices_; }
  std::size_t size() const { return vertices_.size(); }

 private:
  ompl::base::SpaceInformationPtr information_;
  std::vector<std::unique_ptr<Vertex>> vertices_;
  /// OMPL's removes a vertex only by building itself anew, now and then, so removed ones stay until that is due.
  std::unique_ptr<ompl::NearestNeighbors<const Vertex*>> nearest_;
  bool is_stale_ = false;  // it has removed vertices
};
}  // namespace gpu_planning_scene::core
