#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/method.h"

namespace gpu_planning_scene::core::benchmark
{
/// What is measured, and how long.
struct Settings
{
  std::string out;  ///< folder of the tables
  std::vector<std::string> scenes;
  std::vector<MethodInfo> methods;
  std::vector<std::string> kinds;  ///< of states
  std::vector<double> paddings;    ///< metres; all but the first with random states alone
  std::vector<std::size_t> batches;
  std::size_t states = 0;
  std::size_t repeats = 0;
  double seconds = 0.0;  ///< of a slow method in a repeat: it gets fewer states
  std::uint64_t seed = 1;
  bool quick = false;
  MethodOptions method;
};

// The parts of the program; each writes its tables.
// Each returns the wrong answers, timed ones among them, of methods that claim to be exact.
/// throughput.csv and accuracy.csv
std::size_t measureThroughput(const Settings& settings);
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
}  // namespace gpu_planning_scene::core::benchmark
