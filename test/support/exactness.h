#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "oracle/problem_oracle.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// How the checkers' answers to some states compare with the oracle's and with each other.
struct Exactness
{
  std::size_t states = 0;
  std::size_t valid = 0;
  std::size_t false_free = 0;       ///< free, where the contract asks for a collision
  std::size_t false_collision = 0;  ///< the reverse
  std::size_t false_pair = 0;       ///< a colliding pair is reported that is free, or not checked at all
  std::size_t either = 0;           ///< the contract leaves these open
  std::size_t unlike = 0;           ///< verdicts of some traversal or batch size that are not the CPU checker's
  double oracle_seconds = 0.0;

  /// Of a BatchChecker with each traversal, all states in one call.
  struct Undecided
  {
    std::size_t states = 0;
    double seconds = 0.0;  ///< spent on them
    double total_seconds = 0.0;
  };
  Undecided work_queue;
  Undecided breadth_first;

  /// How many free states have a clearance, by the oracle, below 1e-9, 1e-8, ... 1e-3 m, and above; each state counts
  /// once. All 0 where clearances were not asked for.
  std::array<std::size_t, 8> clearances{};

  std::vector<std::string> failures;  ///< a line for each of the first few

  bool good() const { return false_free + false_collision + false_pair + unlike == 0; }
};

/// Holds the answers of all checkers in a scene against the oracle, which works on all cores.
class ExactnessCheck
{
 public:
  explicit ExactnessCheck(const TestScene& scene);

  /// `clearances`: whether they are measured. `label` is for the progress bar.
  Exactness compare(const std::vector<double>& states, bool clearances, const std::string& label);

 private:
  struct Judgement
  {
    oracle::Verdict verdict;
    bool false_pair;
    double clearance;
  };

  void compareSizes(StateChecker& checker, const std::string& name, const std::vector<double>& states,
                    const std::vector<std::uint8_t>& expected, Exactness& exactness) const;
  oracle::Verdict pairVerdict(const std::vector<oracle::Motion>& poses, BodyPair pair) const;
  Judgement judge(const double* state, const std::vector<BodyPair>& reported, bool clearance) const;

  const TestScene& scene_;
  oracle::ProblemOracle oracle_;
  std::map<BodyPair, std::vector<std::pair<std::size_t, std::size_t>>> checked_;  // instances, as pairVerdict has them
  CpuChecker cpu_;
  std::unique_ptr<BatchChecker> work_queue_;
  std::unique_ptr<BatchChecker> breadth_first_;
};
}  // namespace gpu_planning_scene::core
