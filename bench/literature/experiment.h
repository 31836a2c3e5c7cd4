#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Scope and duration of the experiments.
struct Settings
{
  std::string out;  ///< output folder for the tables
  std::vector<MethodInfo> methods;
  std::vector<std::string> models;     ///< of madeModelNames()
  std::vector<std::size_t> triangles;  ///< of each made model
  std::vector<std::string> protocols;  ///< "turning" and "clearance"
  bool fixed_models = true;            ///< also the models of fixedModels()
  std::size_t contacts = 8;            ///< of each family of hard cases
  double seconds = 0.02;               ///< limit of a measurement; a slower method gets fewer poses
  std::uint64_t seed = 1;
  bool quick = false;
};

/// The experiment of A. Gress, G. Zachmann, "Object-Space Interference Detection on Programmable Graphics Hardware"
/// (2003), and of the benchmarks that it refers to: two copies of a model, one of which turns and comes nearer
/// ("turning"), and random rotations at given clearances ("clearance"). Writes experiment.csv, work.csv and builds.csv.
/// A method that took more than 100 times Settings::seconds to make for a model, or more than 200 times with its
/// measurements, is left out of larger models of this name; builds.csv says so. If a query takes more than 50 times
/// Settings::seconds, the other distances of this model are left out. A method of Scope::FullRun is measured only with
/// the torus and the lump of about 10,000 triangles. Returns the number of wrong answers of the family "ours".
std::size_t measureExperiment(const Settings& settings);

/// Writes methods.csv: what each method claims.
void writeMethods(const Settings& settings);
}  // namespace gpu_planning_scene::core::literature
