#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/method.h"

namespace gpu_planning_scene::core::benchmark
{
/// Scope and duration of the measurements.
struct Settings
{
  std::string out;  ///< output folder for the tables
  std::vector<std::string> scenes;
  std::vector<MethodInfo> methods;
  std::vector<std::string> kinds;  ///< of states
  std::vector<double> paddings;    ///< metres; all except the first only with random states
  std::vector<std::size_t> batches;
  std::size_t states = 0;
  std::size_t repeats = 0;
  double seconds = 0.0;  ///< limit of a repeat; a slower method gets fewer states
  std::uint64_t seed = 1;
  bool quick = false;
  MethodOptions method;
};

// The parts of the program. Each part writes its tables and returns the number of wrong answers of exact methods,
// including answers of timed repeats.
/// throughput.csv and accuracy.csv
std::size_t measureThroughput(const Settings& settings);
/// stages.csv; finds no wrong answers
std::size_t measureStages(const Settings& settings);
/// kernels.csv; finds no wrong answers
std::size_t measureKernels(const Settings& settings);
/// latency.csv
std::size_t measureLatency(const Settings& settings);
/// build.csv
std::size_t measureBuilds(const Settings& settings);
/// updates.csv
std::size_t measureMovedObjects(const Settings& settings);
/// growth.csv
std::size_t measureGrowth(const Settings& settings);
/// mesh_pairs.csv
std::size_t measureMeshPairs(const Settings& settings);
/// required_distances.csv
std::size_t measureRequiredDistances(const Settings& settings);
}  // namespace gpu_planning_scene::core::benchmark
