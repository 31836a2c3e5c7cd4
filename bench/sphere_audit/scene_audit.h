#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/truth.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "peers/vamp/vamp_check.h"
#include "sphere_audit/vamp_model.h"

namespace gpu_planning_scene::core::benchmark
{
/// The part of VAMP's model that causes a wrong answer.
enum class Cause
{
  Spheres,   ///< the spheres that replace the links
  Pairs,     ///< VAMP's own list of checked pairs, which replaces the scene's allowed collision matrix
  Cylinders  ///< the capsules or boxes that replace the cylinders of the world
};
constexpr std::size_t kCauses = 3;

/// Wrong answers of one kind: missed or invented collisions.
struct WrongAnswers
{
  std::array<std::size_t, kCauses> by_cause = {};
  /// For missed collisions, the colliding pairs of bodies; for invented collisions, the pairs whose spheres collide.
  /// The number of states for each pair. A pair of a link and an object has the name "LINK, world".
  std::map<std::string, std::size_t> by_pair = {};
  std::vector<double> sizes = {};  ///< metres, of the measured answers: see GeometricError

  std::size_t all() const { return by_cause[0] + by_cause[1] + by_cause[2]; }
  std::size_t of(Cause cause) const { return by_cause[static_cast<std::size_t>(cause)]; }
};

/// Counts of states, and of VAMP's wrong answers for them.
struct Audit
{
  std::size_t states = 0;
  std::size_t free = 0;   ///< by the exact checker
  WrongAnswers missed;    ///< colliding states that VAMP calls free; sizes are penetration depths
  WrongAnswers invented;  ///< free states that VAMP calls colliding; sizes are clearances

  void add(const Audit& other);
};

/// Compares VAMP's verdicts with the exact checker's in scenes of the ur5. Not thread-safe.
class SceneAudit
{
 public:
  /// `first`: a scene of the ur5. Throws Error if VAMP or its sphere model is missing.
  explicit SceneAudit(const std::shared_ptr<const PlanningScene>& first);

  /// `states`: count rows. Measures the sizes of at most `measured` wrong answers of each kind. Throws Error if VAMP
  /// cannot check the scene.
  Audit audit(const std::shared_ptr<const PlanningScene>& scene, VampCylinders cylinders,
              const std::vector<double>& states, std::size_t measured);

 private:
  VampModel model_;
  Truth truth_;
};
}  // namespace gpu_planning_scene::core::benchmark
