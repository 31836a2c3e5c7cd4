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
/// Compares the checkers' answers to some states with the oracle's answers and with each other.
struct Exactness
{
  std::size_t states = 0;
  std::size_t valid = 0;
  std::size_t false_free = 0;       ///< the checker answers free, the oracle finds a collision
  std::size_t false_collision = 0;  ///< the checker answers collision, the oracle finds the state free
  std::size_t false_pair = 0;       ///< a reported pair is free, or is not a checked pair
  std::size_t either = 0;           ///< states for which the contract allows both answers
  std::size_t disagreeing = 0;      ///< verdicts of some traversal or batch size that differ from the CPU checker's
  std::size_t proven = 0;           ///< states that proofs decided without an exact test
  double oracle_seconds = 0.0;

  std::size_t undecided_work_queue = 0;  ///< states that the traversal by work queues left undecided
  std::size_t undecided_breadth_first = 0;

  /// Number of free states whose clearance, by the oracle, is below 1e-9, 1e-8, ... 1e-3 m, and above. Each state
  /// counts once. All entries are 0 if no clearances were requested.
  std::array<std::size_t, 8> clearances{};

  std::vector<std::string> failures;  ///< one line for each of the first failures

  bool good() const { return false_free + false_collision + false_pair + disagreeing == 0; }
};

/// Compares the answers of all checkers in a scene with the oracle. The oracle runs on all cores.
class ExactnessCheck
{
 public:
  /// `with_proofs`: the CPU checker that uses proofs is compared too. Making the proofs takes seconds. `device`: as in
  /// BatchCheckerOptions.
  explicit ExactnessCheck(const TestScene& scene, bool with_proofs = false, const std::string& device = "auto");

  /// `clearances`: whether clearances are measured. `label`: for the progress bar.
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
  std::map<BodyPair, std::vector<std::pair<std::size_t, std::size_t>>> checked_;  // pairs of instances
  CpuChecker cpu_;                                                                // the exact checker alone
  std::unique_ptr<CpuChecker> with_proofs_;                                       // null: not compared
  std::unique_ptr<BatchChecker> work_queue_;
  std::unique_ptr<BatchChecker> breadth_first_;
};
}  // namespace gpu_planning_scene::core
