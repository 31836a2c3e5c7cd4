#include "literature/families.h"

#include <iostream>
#include <map>

#include "base/parallel_for.h"
#include "benchmark/csv_table.h"
#include "gpu_planning_scene/error.h"
#include "literature/hard_pairs.h"
#include "literature/pair_truth.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr double kDistanceLimit = 1e-8;  // metres: larger distances are only known to be larger

struct Truth
{
  double surfaces;
  double solids;
};

std::vector<Truth> truthsOf(const HardPair& pair)
{
  const PairTruth truth(pair.a, pair.b);
  std::vector<Truth> truths(pair.poses.size());
  parallelFor(truths.size(), 4,
              [&](std::size_t begin, std::size_t end)
              {
                for (std::size_t i = begin; i < end; ++i)
                  truths[i] = {truth.surfaces(pair.poses[i].b_in_a, kDistanceLimit),
                               truth.solids(pair.poses[i].b_in_a, kDistanceLimit)};
              });
  return truths;
}

/// Counts of one method at one level of a family.
struct Counts
{
  std::size_t poses = 0;
  std::size_t surfaces_collide = 0;
  std::size_t solids_collide = 0;
  std::size_t missed_surfaces = 0;
  std::size_t false_surfaces = 0;
  std::size_t missed_solids = 0;
  std::size_t false_solids = 0;
  std::size_t within_contract =
      0;  ///< of false_solids: distances of up to 1e-9 m, where the contract allows both answers
  bool in_domain = true;
};

using Rows = std::map<std::pair<std::string, double>, std::vector<Counts>>;  // one entry for each method

void count(const Truth& truth, bool answer, Counts& counts)
{
  const bool surfaces = truth.surfaces == 0.0;
  const bool solids = truth.solids == 0.0;
  ++counts.poses;
  counts.surfaces_collide += surfaces ? 1 : 0;
  counts.solids_collide += solids ? 1 : 0;
  counts.missed_surfaces += surfaces && !answer ? 1 : 0;
  counts.false_surfaces += !surfaces && answer ? 1 : 0;
  counts.missed_solids += solids && !answer ? 1 : 0;
  counts.false_solids += !solids && answer ? 1 : 0;
  counts.within_contract += !solids && answer && truth.solids <= oracle::kTolerance ? 1 : 0;
}

bool inDomain(const MethodInfo& info, const HardPair& pair)
{
  return (info.domain.concave || pair.convex) && (info.domain.open || !pair.open) &&
         (info.domain.containment || !pair.contained) && (info.family != "ours" || !pair.remote);
}

/// The answers of a method, or its reason for refusing the pair.
struct Asked
{
  std::vector<std::uint8_t> answers;
  std::string refused;
};

Asked ask(const MethodInfo& info, const HardPair& pair)
{
  std::vector<Eigen::Isometry3d> poses;
  for (const HardPose& pose : pair.poses)
    poses.push_back(pose.b_in_a);
  try
  {
    return {info.make(pair.a, pair.b)->collide(poses), ""};
  }
  catch (const Error& error)
  {
    return {{}, error.what()};
  }
}
}  // namespace

std::size_t judgeFamilies(const Settings& settings)
{
  benchmark::CsvTable table(
      settings.out, "families.csv",
      {"hard_case", "level", "method", "title", "family", "in_domain", "poses", "surfaces_collide", "solids_collide",
       "missed_surfaces", "false_surfaces", "missed_solids", "false_solids", "within_contract"});
  benchmark::CsvTable refusals(settings.out, "refusals.csv", {"hard_case", "method", "reason"});
  const std::vector<HardPair> pairs = hardPairs(settings.contacts, settings.seed);
  ProgressBar progress("hard cases", pairs.size() * settings.methods.size());
  std::size_t done = 0;
  Rows rows;
  for (const HardPair& pair : pairs)
  {
    const std::vector<Truth> truths = truthsOf(pair);
    for (std::size_t m = 0; m < settings.methods.size(); ++m)
    {
      progress.update(done++);
      const MethodInfo& info = settings.methods[m];
      const Asked asked = ask(info, pair);
      if (!asked.refused.empty())
        refusals.add({pair.poses.front().family, info.name, asked.refused});
      for (std::size_t i = 0; i < asked.answers.size(); ++i)
      {
        std::vector<Counts>& row = rows[{pair.poses[i].family, pair.poses[i].level}];
        row.resize(settings.methods.size());
        row[m].in_domain = row[m].in_domain && inDomain(info, pair);
        count(truths[i], asked.answers[i] != 0, row[m]);
      }
    }
  }

  std::size_t wrong_of_ours = 0;
  for (const auto& [key, row] : rows)
    for (std::size_t m = 0; m < row.size(); ++m)
    {
      const MethodInfo& info = settings.methods[m];
      const Counts& c = row[m];
      if (c.poses == 0)
        continue;
      table.add({key.first, key.second, info.name, info.title, info.family, c.in_domain ? "yes" : "no", c.poses,
                 c.surfaces_collide, c.solids_collide, c.missed_surfaces, c.false_surfaces, c.missed_solids,
                 c.false_solids, c.within_contract});
      const std::size_t wrong = c.missed_solids + c.false_solids - c.within_contract;
      if (info.family == "ours" && c.in_domain && wrong > 0)
      {
        std::cerr << key.first << ", " << key.second << ": " << info.title << " gives " << wrong << " wrong answers\n";
        wrong_of_ours += wrong;
      }
    }
  return wrong_of_ours;
}
}  // namespace gpu_planning_scene::core::literature
