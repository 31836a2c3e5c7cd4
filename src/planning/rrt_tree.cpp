#include "planning/rrt_tree.h"

#include <ompl/tools/config/SelfConfig.h>

namespace gpu_planning_scene
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

void RrtTree::remove(const Vertex& vertex)
{
  for (const std::unique_ptr<Vertex>& each : vertices_)
    if (!each->removed && (each.get() == &vertex || (each->parent && each->parent->removed)))
    {
      each->removed = true;
      nearest_->remove(each.get());
    }
}

const RrtTree::Vertex& RrtTree::nearest(const ompl::base::State* state) const
{
  // The search only reads the vertex that it is given.
  const Vertex query{const_cast<ompl::base::State*>(state), nullptr};
  return *nearest_->nearest(&query);
}
}  // namespace gpu_planning_scene
