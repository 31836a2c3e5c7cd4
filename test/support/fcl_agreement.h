#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// A checker's answers compared with FCL's. Where the two differ, FCL is excused for what it is known to get wrong, as
/// far as FCL itself can show it; everything else is a failure.
struct FclAgreement
{
  std::size_t states = 0;
  std::size_t free = 0;               ///< by FCL
  std::size_t world_hits = 0;         ///< states in which a link hits an object, by FCL
  std::size_t agreed = 0;             ///< the same verdict, and the colliding pair collides by FCL as well
  std::size_t barely_touching = 0;    ///< free, a hit by FCL, but free by FCL with the pair moved 1e-6 m apart
  std::size_t within_micrometre = 0;  ///< a hit, free by FCL, but at a distance of at most 1e-6 m by FCL
  std::size_t contained = 0;          ///< a hit, free by FCL, but one body has a part inside the other
  std::vector<std::string> failures;  ///< one line each
};

FclAgreement compareWithFcl(const PlanningScene& scene, const std::vector<double>& states, const BatchResult& result);

std::ostream& operator<<(std::ostream& out, const FclAgreement& agreement);
}  // namespace gpu_planning_scene::core
