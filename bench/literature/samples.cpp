#include "literature/samples.h"

#include "base/parallel_for.h"
#include "literature/poses.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kClearancePoses = 60;

/// Distances of the centres, from just apart to deep overlap.
std::vector<double> turningDistances(bool quick)
{
  return quick ? std::vector<double>{0.99, 0.7}
               : std::vector<double>{1.1, 1.05, 1.01, 0.99, 0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5};
}

std::vector<double> clearances(bool quick)
{
  return quick ? std::vector<double>{0.01} : std::vector<double>{1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4};
}
}  // namespace

std::vector<Sample> samplesOf(const Model& model, const Settings& settings)
{
  std::vector<Sample> samples;
  for (const std::string& protocol : settings.protocols)
  {
    if (protocol == "turning")
      for (const double distance : turningDistances(settings.quick))
        samples.push_back({protocol, distance, turningPoses(distance * model.size, settings.seed), {}});
    else
    {
      const std::vector<double> shares = clearances(settings.quick);
      std::vector<double> metres;
      for (const double share : shares)
        metres.push_back(share * model.size);
      const auto poses =
          posesWithClearances(*model.mesh, *model.mesh, model.size, metres, kClearancePoses, settings.seed);
      for (std::size_t i = 0; i < shares.size(); ++i)
        samples.push_back({protocol, shares[i], poses[i], {}});
    }
  }
  const oracle::PreparedShape shape{Shape(model.mesh)};
  for (Sample& sample : samples)
  {
    sample.truth.resize(sample.poses.size());
    parallelFor(sample.poses.size(), 2,
                [&](std::size_t begin, std::size_t end)
                {
                  for (std::size_t i = begin; i < end; ++i)
                    sample.truth[i] = oracle::verdict(shape, {}, shape, oracle::Motion(sample.poses[i]), 0.0);
                });
  }
  return samples;
}
}  // namespace gpu_planning_scene::core::literature
