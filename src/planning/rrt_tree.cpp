#include "planning/rrt_tree.h"

#include <unordered_set>
#include <utility>

#include <ompl/tools/config/SelfConfig.h>

// The tree of S. M. LaValle: Rapidly-exploring random trees: A new tool for path planning. TR 98-11, 1998. OMPL finds
// the nearest state. A removed vertex stays in memory, because its children point to it.
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
  : information_(planner.getSpaceInformation()),
    nearest_(ompl::tools::SelfConfig::getDefaultNearestNeighbors<const Vertex*>(&planner))
{
  nearest_->setDistanceFunction([space = information_->getStateSpace()](const Vertex* a, const Vertex* b)
                                { return space->distance(a->state, b->state); });
}

RrtTree::~RrtTree()
{
  for (const std::unique_ptr<Vertex>& vertex : vertices_)
    information_->freeState(vertex->state);
}

const RrtTree::Vertex& RrtTree::add(const ompl::base::State* state, const Vertex* parent)
{
  vertices_.push_back(std::make_unique<Vertex>(Vertex{information_->cloneState(state), parent}));
  nearest_->add(vertices_.back().get());
  return *vertices_.back();
}

void RrtTree::remove(const std::vector<const Vertex*>& vertices)
{
  const std::unordered_set<const Vertex*> wanted(vertices.begin(), vertices.end());
  for (const std::unique_ptr<Vertex>& each : vertices_)
    if (wanted.count(each.get()) != 0 || (each->parent && each->parent->removed))
      each->removed = true;
  is_stale_ = is_stale_ || !vertices.empty();
}

const RrtTree::Vertex& RrtTree::nearest(const ompl::base::State* state)
{
  if (std::exchange(is_stale_, false))
  {
    std::vector<const Vertex*> left;
    for (const std::unique_ptr<Vertex>& each : vertices_)
      if (!each->removed)
        left.push_back(each.get());
    nearest_->clear();
    nearest_->add(left);
  }
  // The search only reads the vertex that it is given.
  const Vertex query{const_cast<ompl::base::State*>(state), nullptr};
  return *nearest_->nearest(&query);
}
}  // namespace gpu_planning_scene::core
