#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "literature/experiment.h"
#include "literature/models.h"
#include "oracle/oracle.h"

namespace gpu_planning_scene::core::literature
{
/// Poses of one protocol at one distance, with the true answers.
struct Sample
{
  std::string protocol;
  double distance;  ///< of the centres ("turning") or of the surfaces ("clearance"), divided by the model's size
  std::vector<Eigen::Isometry3d> poses;
  std::vector<oracle::Verdict> truth;
};

/// The samples of all protocols and distances of the settings. The oracle of the tests gives the truth, in quadruple
/// precision. It shares only data types with the methods.
std::vector<Sample> samplesOf(const Model& model, const Settings& settings);
}  // namespace gpu_planning_scene::core::literature
