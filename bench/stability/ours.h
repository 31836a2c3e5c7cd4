#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stability/case.h"

namespace gpu_planning_scene::core::stability
{
/// The project's own methods on many cases: some go into one collision problem, on links and objects of their own, and
/// state i of the problem has the shapes of case i in their places and all others far apart.
class Ours
{
 public:
  /// `device` and `shaders` as in BatchCheckerOptions.
  Ours(const std::string& device, const std::string& shaders);
  ~Ours();

  /// What each method says: 1 for a collision.
  struct Answers
  {
    std::vector<std::uint8_t> work_queue;
    std::vector<std::uint8_t> breadth_first;
    std::vector<std::uint8_t> exact;
    std::size_t undecided = 0;  ///< how many of the cases the work queues left to the CPU
  };
  /// `origin`: see CollisionProblem.
  Answers check(const std::vector<Case>& cases, const Eigen::Vector3d& origin);

  std::string deviceName() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core::stability
