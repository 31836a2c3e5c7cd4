#pragma once

#include <cstddef>

#include "literature/experiment.h"

namespace gpu_planning_scene::core::literature
{
/// Asks every method for the poses of all hard pairs and writes families.csv: missed and false collisions, judged by
/// the truth of the surfaces and by that of the solids (PairTruth). Returns the number of wrong answers of the family
/// "ours" within its contract.
std::size_t judgeFamilies(const Settings& settings);
}  // namespace gpu_planning_scene::core::literature
