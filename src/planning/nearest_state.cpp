#include "planning/nearest_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <ompl/base/StateSpaceTypes.h>
#include <ompl/util/Exception.h>

#include "model/math_constants.h"

// The distances are those of OMPL's spaces: the length of the difference in R^n, the smaller arc in SO(2), the angle
// between unit quaternions as points of the sphere in SO(3), and weighted sums in compounds.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

// The compiler makes these functions for several instruction sets, and the program takes the best one of the machine.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define GPS_CLONES [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define GPS_CLONES
#endif

constexpr std::size_t kLanes = 8;
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;

/// sums: for each state, the sum of (value - query)^2 of `count` values, which begin at `values` in the first block.
GPS_CLONES
void sumSquares(const double* values, std::size_t blocks, std::size_t width, const double* query, std::size_t count,
                double* sums)
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

/// The least of the values. `blocks` is at least 1.
GPS_CLONES
double leastOf(const double* values, std::size_t blocks)
{
  Lanes least;
  std::memcpy(&least, values, sizeof least);
  for (std::size_t block = 1; block < blocks; ++block)
  {
    Lanes next;
    std::memcpy(&next, values + block * kLanes, sizeof next);
    least = next < least ? next : least;
  }
  double result = least[0];
  for (std::size_t lane = 1; lane < kLanes; ++lane)
    result = std::min(result, least[lane]);
  return result;
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
    blocks_.resize(blocks_.size() + width_ * kLanes);
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
    sumSquares(&blocks_[part.first * kLanes], blocks, width_, query, part.count, sums_.data());
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
  distances_.assign(blocks * kLanes, 0.0);
  sums_.resize(blocks * kLanes);
  if (parts_.size() == 1 && parts_.front().kind == Kind::Vector)
    sumSquares(blocks_.data(), blocks, width_, query_.data(), width_, distances_.data());  // the same order of states
  else
    for (const Part& part : parts_)
      addDistances(part);
  std::fill(distances_.begin() + static_cast<std::ptrdiff_t>(count_), distances_.end(),
            std::numeric_limits<double>::infinity());
  const double least = leastOf(distances_.data(), blocks);
  return static_cast<std::size_t>(std::find(distances_.begin(), distances_.end(), least) - distances_.begin());
}
}  // namespace gpu_planning_scene::core
