#include "planning/nearest_state.h"

#include <utility>

#include <ompl/base/StateSpaceTypes.h>
#include <ompl/util/Exception.h>
#include <Eigen/Core>

#include "model/math_constants.h"

// The distances are those of OMPL's spaces: the length of the difference in R^n, the smaller arc in SO(2), the angle
// between unit quaternions as points of the sphere in SO(3), and weighted sums in compounds.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
}  // namespace

NearestState::NearestState(ob::StateSpacePtr space) : space_(std::move(space))
{
  addParts(*space_, 1.0);
  if (!parts_.empty())
    columns_.resize(parts_.back().first + parts_.back().count);
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
  for (std::size_t k = 0; k < query_.size(); ++k)
    columns_[k].push_back(query_[k]);
}

void NearestState::clear()
{
  for (std::vector<double>& column : columns_)
    column.clear();
}

std::size_t NearestState::nearest(const ob::State* state)
{
  space_->copyToReals(query_, state);
  const std::size_t count = columns_.front().size();
  distances_.resize(count);
  sums_.resize(count);
  const auto array = [count](std::vector<double>& values)
  { return Eigen::Map<Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(count)); };
  auto distances = array(distances_);
  auto sums = array(sums_);
  distances.setZero();
  for (const Part& part : parts_)
  {
    sums.setZero();
    for (std::size_t k = part.first; k < part.first + part.count; ++k)
    {
      const auto column = array(columns_[k]);
      const double value = query_[k];
      switch (part.kind)
      {
        case Kind::Vector:
          sums += (column - value).square();
          break;
        case Kind::Angle:
          sums = (column - value).abs();
          break;
        case Kind::Quaternion:
          sums += column * value;
          break;
      }
    }
    switch (part.kind)
    {
      case Kind::Vector:
        distances += part.weight * sums.sqrt();
        break;
      case Kind::Angle:
        distances += part.weight * sums.min(2.0 * kPi - sums);
        break;
      case Kind::Quaternion:
        distances += part.weight * sums.abs().min(1.0).acos();
        break;
    }
  }
  Eigen::Index nearest = 0;
  distances.minCoeff(&nearest);
  return static_cast<std::size_t>(nearest);
}
}  // namespace gpu_planning_scene::core
