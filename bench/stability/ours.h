#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stability/case.h"

namespace gpu_planning_scene::core::stability
{
/// Runs the project's own methods on many cases. Several cases form one collision problem, each with its own links and
/// objects. State i of the problem places the shapes of case i and moves the shapes of all other cases far apart.
class Ours
{
 public:
  /// `device` and `shaders` as in BatchCheckerOptions. `with_proofs`: the number of cases, from the first, that are
  /// also checked with balls. These take some 0.05 s to make for each shape.
  Ours(const std::string& device, const std::string& shaders, std::size_t with_proofs);
  ~Ours();

  /// The answers of each method: 1 for a collision.
  struct Answers
  {
    std::vector<std::uint8_t> work_queue;
    std::vector<std::uint8_t> breadth_first;
    std::vector<std::uint8_t> exact;
    std::vector<std::uint8_t> proofs;  ///< by balls where they prove a verdict, else as `exact`; of the first cases
    std::size_t undecided = 0;         ///< cases that the work queues left undecided
    std::size_t proven = 0;            ///< cases that balls decided
  };
  /// `origin`: see CollisionProblem.
  Answers check(const std::vector<Case>& cases, const Eigen::Vector3d& origin);

  std::string deviceName() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core::stability
