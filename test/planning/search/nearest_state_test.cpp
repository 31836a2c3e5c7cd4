// The nearest of many states has the least distance of the space, for all kinds of joints.

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DiscreteStateSpace.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/util/Exception.h>

#include "planning/search/nearest_state.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

/// Joints with limits, a continuous, a planar and a floating joint, as in a GroupStateSpace, but with weights.
ob::StateSpacePtr spaceOfAllJoints()
{
  const auto joints = std::make_shared<ob::RealVectorStateSpace>(3);
  joints->setBounds(-2.0, 2.0);
  const auto planar = std::make_shared<ob::SE2StateSpace>();
  const auto floating = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds plane(2);
  ob::RealVectorBounds room(3);
  plane.setLow(-1.0);
  plane.setHigh(1.0);
  room.setLow(-1.0);
  room.setHigh(1.0);
  planar->setBounds(plane);
  floating->setBounds(room);
  const auto all = std::make_shared<ob::CompoundStateSpace>();
  all->addSubspace(joints, 1.0);
  all->addSubspace(std::make_shared<ob::SO2StateSpace>(), 0.7);
  all->addSubspace(planar, 1.3);
  all->addSubspace(floating, 0.5);
  all->setup();
  return all;
}

TEST(NearestState, HasTheLeastDistanceOfTheSpace)
{
  // OMPL takes quaternions whose product is this near to 1 as equal.
  constexpr double kEqualQuaternions = 1e-4;
  constexpr int kQueries = 20;
  const ob::StateSpacePtr space = spaceOfAllJoints();
  const ob::StateSamplerPtr sampler = space->allocStateSampler();
  NearestState nearest(space);
  std::vector<ob::ScopedState<>> states;
  ob::ScopedState<> query(space);
  for (int round = 0; round < 2; ++round)
  {
    nearest.clear();
    states.clear();
    for (const std::size_t count : {1U, 2U, 300U, 700U})
    {
      while (states.size() < count)
      {
        states.emplace_back(space);
        sampler->sampleUniform(states.back().get());
        nearest.add(states.back().get());
      }
      for (int i = 0; i < kQueries; ++i)
      {
        sampler->sampleUniform(query.get());
        double least = std::numeric_limits<double>::infinity();
        for (const ob::ScopedState<>& state : states)
          least = std::min(least, space->distance(state.get(), query.get()));
        const std::size_t found = nearest.nearest(query.get());
        ASSERT_LT(found, states.size());
        EXPECT_NEAR(space->distance(states[found].get(), query.get()), least, kEqualQuaternions);
      }
      EXPECT_EQ(nearest.nearest(states.back().get()), states.size() - 1) << "a state is nearest to itself";
    }
  }
}

TEST(NearestState, OfAVectorSpaceIsTheFirstOfTheNearest)
{
  const auto space = std::make_shared<ob::RealVectorStateSpace>(7);
  space->setBounds(-3.0, 3.0);
  space->setup();
  NearestState nearest(space);
  const ob::StateSamplerPtr sampler = space->allocStateSampler();
  std::vector<ob::ScopedState<>> states;
  ob::ScopedState<> query(space);
  for (int count = 1; count <= 100; ++count)
  {
    states.emplace_back(space);
    sampler->sampleUniform(states.back().get());
    nearest.add(states.back().get());
    sampler->sampleUniform(query.get());
    std::size_t expected = 0;
    for (std::size_t i = 1; i < states.size(); ++i)
      if (space->distance(states[i].get(), query.get()) < space->distance(states[expected].get(), query.get()))
        expected = i;
    EXPECT_EQ(nearest.nearest(query.get()), expected) << count;
  }
  nearest.add(states[40].get());
  EXPECT_EQ(nearest.nearest(states[40].get()), 40U) << "not the equal one that came later";
}

TEST(NearestState, RefusesASpaceWhoseDistancesItDoesNotKnow)
{
  EXPECT_THROW(NearestState(std::make_shared<ob::DiscreteStateSpace>(0, 5)), ompl::Exception);
}
}  // namespace
}  // namespace gpu_planning_scene::core
