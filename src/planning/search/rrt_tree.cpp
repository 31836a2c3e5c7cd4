#include "planning/search/rrt_tree.h"

#include <unordered_set>
#include <utility>

// The tree of S. M. LaValle: Rapidly-exploring random trees: A new tool for path planning. TR 98-11, 1998. A
// removed vertex stays in memory, because its children point to it.
namespace gpu_planning_scene::core
{
const RrtTree::Vertex& RrtTree::Vertex::root() const
{
  const Vertex* vertex = this;
  while (vertex->parent)
    vertex = vertex->parent;
  return *vertex;
}

RrtTree::RrtTree(const ompl::base::Planner& planner)
  : information_(planner.getSpaceInformation()), nearest_(information_->getStateSpace())
{
}

RrtTree::~RrtTree()
{
  for (const std::unique_ptr<Vertex>& vertex : vertices_)
    information_->freeState(vertex->state);
}

const RrtTree::Vertex& RrtTree::add(const ompl::base::State* state, const Vertex* parent)
{
  vertices_.push_back(
      std::make_unique<Vertex>(Vertex{information_->cloneState(state), parent, false, false, false, vertices_.size()}));
  ++size_;
  nearest_.add(state);
  vertex_of_.push_back(vertices_.back().get());
  return *vertices_.back();
}

void RrtTree::remove(const std::vector<const Vertex*>& vertices)
{
  const std::unordered_set<const Vertex*> wanted(vertices.begin(), vertices.end());
  for (const std::unique_ptr<Vertex>& each : vertices_)
    if (!each->removed && (wanted.count(each.get()) != 0 || (each->parent && each->parent->removed)))
    {
      each->removed = true;
      --size_;
    }
  is_stale_ = is_stale_ || !vertices.empty();
}

const RrtTree::Vertex& RrtTree::nearest(const ompl::base::State* state)
{
  if (std::exchange(is_stale_, false))
  {
    nearest_.clear();
    vertex_of_.clear();
    for (const std::unique_ptr<Vertex>& each : vertices_)
      if (!each->removed)
      {
        nearest_.add(each->state);
        vertex_of_.push_back(each.get());
      }
  }
  return *vertex_of_[nearest_.nearest(state)];
}
}  // namespace gpu_planning_scene::core
