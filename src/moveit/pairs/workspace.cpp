#include "moveit/pairs/workspace.h"

#include <utility>

namespace gpu_planning_scene::detector
{
namespace
{
std::vector<std::unique_ptr<Workspace::Memory>>& unused()
{
  thread_local std::vector<std::unique_ptr<Workspace::Memory>> memories;
  return memories;
}
}  // namespace

Workspace::Workspace()
{
  if (unused().empty())
    memory_ = std::make_unique<Memory>();
  else
  {
    memory_ = std::move(unused().back());
    unused().pop_back();
  }
}

Workspace::~Workspace()
{
  memory_->instances.clear();
  memory_->attached.clear();  // shapes are not kept alive
  unused().push_back(std::move(memory_));
}
}  // namespace gpu_planning_scene::detector
