#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"
#include "support/fcl_peer.h"

namespace gpu_planning_scene::core
{
/// A checker's answers compared with FCL's. A difference is accepted where FCL is known to be wrong, if FCL's own
/// queries confirm it. Every other difference is a failure.
struct FclAgreement
{
  std::size_t states = 0;
  std::size_t free = 0;               ///< free states by FCL
  std::size_t world_hits = 0;         ///< states in which a link hits an object, by FCL
  std::size_t agreed = 0;             ///< the same verdict; FCL finds a collision of the reported pair too
  std::size_t barely_touching = 0;    ///< free; a collision by FCL that ends when the pair is moved 1e-6 m apart
  std::size_t within_micrometre = 0;  ///< a collision; free by FCL, at an FCL distance of at most 1e-6 m
  std::size_t contained = 0;          ///< a collision; free by FCL, but a part of one body is inside the other
  std::vector<std::string> failures;  ///< one line each
};

/// `peer`: FCL with the scene's whole problem.
FclAgreement compareWithFcl(FclPeer& peer, const PlanningScene& scene, const std::vector<double>& states,
                            const BatchResult& result);

/// The same with a new peer, which builds FCL's trees.
FclAgreement compareWithFcl(const PlanningScene& scene, const std::vector<double>& states, const BatchResult& result);

std::ostream& operator<<(std::ostream& out, const FclAgreement& agreement);
}  // namespace gpu_planning_scene::core
