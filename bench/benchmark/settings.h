#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/method.h"

namespace gpu_planning_scene::benchmark
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
/// throughput.csv and accuracy.csv. Returns the wrong answers of methods that claim to be exact.
std::size_t measureThroughput(const Settings& settings);
/// latency.csv
void measureLatency(const Settings& settings);
/// build.csv
void measureBuilds(const Settings& settings);
/// growth.csv
void measureGrowth(const Settings& settings);
/// mesh_pairs.csv. Returns wrong answers as measureThroughput does.
std::size_t measureMeshPairs(const Settings& settings);
}  // namespace gpu_planning_scene::benchmark
