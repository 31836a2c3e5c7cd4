#include "planning/search/nearest_state.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include <ompl/base/StateSpaceTypes.h>
#include <ompl/util/Exception.h>

#include "base/instruction_sets.h"
#include "base/math_constants.h"

// The distances are those of OMPL's spaces: the length of the difference in R^n, the smaller arc in SO(2), the angle
// between unit quaternions as points of the sphere in SO(3), and weighted sums in compounds.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

constexpr std::size_t kLanes = 8;
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;

/// sums: for each state, the sum of (value - query)^2 of `count` values, which begin at `values` in the first block.
[[gnu::always_inline]] inline void sumSquaresOf(const double* values, std::size_t blocks, std::size_t width,
                                                const double* query, std::size_t count, double* sums)
{
  for (std::size_t block = 0; block < blocks; ++block, values += width * kLanes, sums += kLanes)
  {
    Lanes sum{};
    for (std::size_t k = 0; k < count; ++k)
    {
      Lanes difference;
      std::memcpy(&difference, values + k * kLanes, sizeof difference);
      difference -= query[k];
      sum += difference * difference;
    }
    std::memcpy(sums, &sum, sizeof sum);
  }
}

/// The number of the state with the least sum of (value - query)^2; of equal ones, the first. `blocks` >= 1.
[[gnu::always_inline]] inline std::size_t leastSumOf(const double* values, std::size_t blocks, const double* query,
                                                     std::size_t count)
{
  using Numbers [[gnu::vector_size(kLanes * sizeof(std::int64_t))]] = std::int64_t;
  Lanes least = Lanes{} + std::numeric_limits<double>::infinity();
  Numbers least_block{};
  for (std::size_t block = 0; block < blocks; ++block, values += count * kLanes)
  {
    Lanes sum{};
    for (std::size_t k = 0; k < count; ++k)
    {
      Lanes difference;
      std::memcpy(&difference, values + k * kLanes, sizeof difference);
      difference -= query[k];
      sum += difference * difference;
    }
    const Numbers is_less = sum < least;
    least = is_less ? sum : least;
    least_block = is_less ? Numbers{} + static_cast<std::int64_t>(block) : least_block;
  }
  // Copies, because clang binds no reference to an element of a vector.
  const auto order = [&](std::size_t lane)
  {
    const double sum = least[lane];
    const std::int64_t block = least_block[lane];
    return std::pair(sum, block);
  };
  std::size_t found = 0;
  for (std::size_t lane = 1; lane < kLanes; ++lane)
    if (order(lane) < order(found))
      found = lane;
  return static_cast<std::size_t>(least_block[found]) * kLanes + found;
}

struct Functions
{
  void (*sum_squares)(const double* values, std::size_t blocks, std::size_t width, const double* query,
                      std::size_t count, double* sums);
  std::size_t (*least_sum)(const double* values, std::size_t blocks, const double* query, std::size_t count);
};

// A macro, because the attribute `target` cannot be a parameter of a template.
#define GPS_NEAREST_FUNCTIONS(NAME, TARGET)                                                                           \
  TARGET void sumSquares##NAME(const double* values, std::size_t blocks, std::size_t width, const double* query,      \
                               std::size_t count, double* sums)                                                       \
  {                                                                                                                   \
    sumSquaresOf(values, blocks, width, query, count, sums);                                                          \
  }                                                                                                                   \
  TARGET std::size_t leastSum##NAME(const double* values, std::size_t blocks, const double* query, std::size_t count) \
  {                                                                                                                   \
    return leastSumOf(values, blocks, query, count);                                                                  \
  }                                                                                                                   \
  constexpr Functions k##NAME = {sumSquares##NAME, leastSum##NAME}

GPS_NEAREST_FUNCTIONS(Baseline, );
#ifdef __x86_64__
GPS_NEAREST_FUNCTIONS(Avx2, [[gnu::target("avx2")]]);
GPS_NEAREST_FUNCTIONS(Avx512, [[gnu::target("avx512f")]]);
#endif
#undef GPS_NEAREST_FUNCTIONS

/// The fastest functions that the machine can run. All have the same results.
const Functions& fastest()
{
#ifdef __x86_64__
  static const bool has_avx512 = hasAvx512();
  static const bool has_avx2 = hasAvx2();
  if (has_avx512 || has_avx2)
    return has_avx512 ? kAvx512 : kAvx2;
#endif
  return kBaseline;
}
}  // namespace

NearestState::NearestState(ob::StateSpacePtr space) : space_(std::move(space))
{
  addParts(*space_, 1.0);
  if (!parts_.empty())
    width_ = parts_.back().first + parts_.back().count;
}

void NearestState::addParts(const ob::StateSpace& space, double weight)
{
  if (space.isCompound())
  {
    const auto& compound = *space.as<ob::CompoundStateSpace>();
    for (unsigned int i = 0; i < compound.getSubspaceCount(); ++i)
      addParts(*compound.getSubspace(i), weight * compound.getSubspaceWeight(i));
    return;
  }
  const std::size_t first = parts_.empty() ? 0 : parts_.back().first + parts_.back().count;
  switch (space.getType())
  {
    case ob::STATE_SPACE_REAL_VECTOR:
      parts_.push_back({Kind::Vector, first, std::size_t{space.getDimension()}, weight});
      return;
    case ob::STATE_SPACE_SO2:
      parts_.push_back({Kind::Angle, first, 1, weight});
      return;
    case ob::STATE_SPACE_SO3:
      parts_.push_back({Kind::Quaternion, first, 4, weight});
      return;
    default:
      throw ompl::Exception(space.getName(), "the planner knows no distances of this state space");
  }
}

void NearestState::add(const ob::State* state)
{
  space_->copyToReals(query_, state);
  const std::size_t lane = count_ % kLanes;
  if (lane == 0)
    blocks_.resize(blocks_.size() + width_ * kLanes, std::numeric_limits<double>::infinity());  // far from all states
  double* const block = &blocks_[count_ / kLanes * width_ * kLanes];
  for (std::size_t k = 0; k < width_; ++k)
    block[k * kLanes + lane] = query_[k];
  ++count_;
}

void NearestState::clear()
{
  blocks_.clear();
  count_ = 0;
}

/// Adds the distances in a part to `distances_`.
void NearestState::addDistances(const Part& part)
{
  const double* const query = &query_[part.first];
  const std::size_t blocks = distances_.size() / kLanes;
  if (part.kind == Kind::Vector)
    fastest().sum_squares(&blocks_[part.first * kLanes], blocks, width_, query, part.count, sums_.data());
  for (std::size_t i = 0; i < distances_.size(); ++i)
  {
    const double* const values = &blocks_[(i / kLanes * width_ + part.first) * kLanes + i % kLanes];
    switch (part.kind)
    {
      case Kind::Vector:
        distances_[i] += part.weight * std::sqrt(sums_[i]);
        break;
      case Kind::Angle:
      {
        const double arc = std::abs(*values - *query);
        distances_[i] += part.weight * std::min(arc, 2.0 * kPi - arc);
        break;
      }
      case Kind::Quaternion:
      {
        double product = 0.0;
        for (std::size_t k = 0; k < part.count; ++k)
          product += values[k * kLanes] * query[k];
        distances_[i] += part.weight * std::acos(std::min(1.0, std::abs(product)));
        break;
      }
    }
  }
}

std::size_t NearestState::nearest(const ob::State* state)
{
  space_->copyToReals(query_, state);
  const std::size_t blocks = (count_ + kLanes - 1) / kLanes;
  if (parts_.size() == 1 && parts_[0].kind == Kind::Vector)
    return fastest().least_sum(blocks_.data(), blocks, query_.data(), width_);
  distances_.assign(blocks * kLanes, 0.0);
  sums_.resize(blocks * kLanes);
  for (const Part& part : parts_)
    addDistances(part);
  const auto end = distances_.begin() + static_cast<std::ptrdiff_t>(count_);
  return static_cast<std::size_t>(std::min_element(distances_.begin(), end) - distances_.begin());
}
}  // namespace gpu_planning_scene::core
