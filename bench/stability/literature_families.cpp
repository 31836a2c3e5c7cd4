// The hard cases of bench/literature: the same ones that all methods of the program `literature` answer.

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <random>

#include "literature/hard_pairs.h"
#include "stability/case.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
constexpr std::size_t kContacts = 16;  // of each family; each is a case at all levels

using CasePtr = std::shared_ptr<const Case>;
using Cases = std::map<std::string, std::vector<CasePtr>>;  // by family

Cases made(std::uint64_t seed)
{
  Cases cases;
  for (const literature::HardPair& pair : literature::hardPairs(kContacts, seed))
    for (const literature::HardPose& pose : pair.poses)
    {
      Case one;
      one.a = pair.a;
      one.b = pair.b;
      one.pose_b = pose.b_in_a;
      cases[pose.family].push_back(std::make_shared<const Case>(one));
    }
  // The first cases of a family are of all levels and pairs.
  std::mt19937_64 generator(seed);
  for (auto& [family, of_family] : cases)
    std::shuffle(of_family.begin(), of_family.end(), generator);
  return cases;
}

/// The cases are made together, when somebody needs the first of them.
const std::vector<CasePtr>& casesOf(const std::string& family, std::uint64_t seed)
{
  static std::mutex mutex;
  static std::map<std::uint64_t, Cases> kept;
  const std::lock_guard<std::mutex> lock(mutex);
  auto found = kept.find(seed);
  if (found == kept.end())
    found = kept.emplace(seed, made(seed)).first;
  return found->second.at(family);
}

Family familyOf(const std::string& name, std::size_t cases, bool convex = false)
{
  Family family;
  family.name = name;
  family.make = [name](std::uint64_t seed, std::size_t index) { return *casesOf(name, seed).at(index); };
  family.convex = convex;
  family.most = kContacts * cases;
  return family;
}
}  // namespace

// Without the families whose coordinates are beyond the contract of this package: units of 5e5, and 5e5 m from the
// origin.
std::vector<Family> literatureFamilies()
{
  constexpr std::size_t kFineLevels = 10;
  constexpr std::size_t kCoarseLevels = 6;
  return {familyOf("convex, along the axes", 2 * kFineLevels, true),
          familyOf("convex, turned", 2 * kFineLevels, true),
          familyOf("concave, along the axes", 2 * kFineLevels),
          familyOf("concave, turned", 2 * kFineLevels),
          familyOf("world turned by 1 degrees", kCoarseLevels),
          familyOf("world turned by 45 degrees", kCoarseLevels),
          familyOf("units of 1e-6", kCoarseLevels),
          familyOf("a tenth of the faces removed", kCoarseLevels),
          familyOf("a tenth of the faces flipped", kCoarseLevels),
          familyOf("a tenth of the faces doubled", kCoarseLevels),
          familyOf("sizes 1 : 1000", kCoarseLevels),
          familyOf("needles", 5, true),
          familyOf("plates from the edge", kFineLevels, true),
          familyOf("triangles below a pixel", kCoarseLevels),
          familyOf("containment", 3),
          familyOf("linked tori", 3),
          familyOf("dense piles", 3)};
}
}  // namespace gpu_planning_scene::core::stability
