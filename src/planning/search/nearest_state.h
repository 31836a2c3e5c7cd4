#pragma once

#include <cstddef>
#include <vector>

#include <ompl/base/StateSpace.h>

namespace gpu_planning_scene::core
{
/// Finds the nearest of many states by comparing all of them. Their values lie in flat arrays, so up to ten thousand
/// states this is faster than a search tree, and up to a hundred thousand it takes less than a millisecond. Not
/// thread-safe.
class NearestState
{
 public:
  /// `space`: R^n, SO(2), SO(3), or a compound of these. Throws ompl::Exception for another space.
  explicit NearestState(ompl::base::StateSpacePtr space);

  /// Copies the values of the state. States are numbered in the order of the calls.
  void add(const ompl::base::State* state);
  void clear();

  /// The number of the state with the least distance from `state`, by the distance of the space. There must be a state.
  std::size_t nearest(const ompl::base::State* state);

 private:
  enum class Kind
  {
    Vector,
    Angle,
    Quaternion
  };

  /// Consecutive values of a state, of a subspace. Its distance is multiplied by the weight.
  struct Part
  {
    Kind kind;
    std::size_t first;
    std::size_t count;
    double weight;
  };

  void addParts(const ompl::base::StateSpace& space, double weight);
  void addDistances(const Part& part);

  ompl::base::StateSpacePtr space_;
  std::vector<Part> parts_;
  std::size_t width_ = 0;  // number of values of a state
  std::size_t count_ = 0;
  // Blocks of some states. A block has, for each value, that of all its states.
  std::vector<double> blocks_;
  std::vector<double> query_;
  // One for each state of a block, also where the last block has no states.
  std::vector<double> distances_;
  std::vector<double> sums_;
};
}  // namespace gpu_planning_scene::core
