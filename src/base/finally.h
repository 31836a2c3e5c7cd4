#pragma once

#include <utility>

namespace gpu_planning_scene::core
{
/// Calls a function at the end of a scope, also if an exception leaves the scope. The function must not throw.
template <class Function>
class Finally
{
 public:
  explicit Finally(Function function) : function_(std::move(function)) {}
  ~Finally() { function_(); }
  Finally(const Finally&) = delete;
  Finally& operator=(const Finally&) = delete;

 private:
  Function function_;
};
}  // namespace gpu_planning_scene::core
