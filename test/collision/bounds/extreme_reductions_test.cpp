// Pairs that are left out of a problem change no answer, even with extreme numbers: unrealistic joint limits, poses
// that are slightly off rigid, and a system that refuses threads.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include <gtest/gtest.h>
#include <pthread.h>

#include "base/parallel_for.h"
#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
struct Limits
{
  double lower;
  double upper;
};

const std::vector<Limits> kHuge = {{-1e16, 1e16}, {-4e15, 4e15}, {-1e308, 1e308}, {-1e16, 1.0},
                                   {-1.0, 4e15},  {0.0, 1e308},  {-1e308, 0.5},   {1e16, 1e16}};

std::string limitXml(const Limits& limits)
{
  std::ostringstream text;
  text.precision(17);
  text << "<limit lower='" << limits.lower << "' upper='" << limits.upper << "' effort='1' velocity='1'/>";
  return text.str();
}

/// Expects the same answers with and without reductions. Returns the number of free states.
std::size_t expectSameAnswers(const std::shared_ptr<const PlanningScene>& scene, const std::vector<double>& states,
                              const std::string& what)
{
  const auto reduced = CpuChecker(scene).check(states.data(), states.size()).valid;
  EXPECT_EQ(reduced, CpuChecker(scene, optionsWithAllPairs()).check(states.data(), states.size()).valid) << what;
  return static_cast<std::size_t>(std::count(reduced.begin(), reduced.end(), 1));
}

/// A small box at 0.9 m from the base, on a joint of one variable.
std::shared_ptr<PlanningScene> toolOn(const std::string& type, const std::string& axis, const Limits& limits)
{
  return std::make_shared<PlanningScene>(
      robotOf("<link name='base'/><link name='tool'><collision><origin xyz='0.9 0 0'/><geometry>"
              "<box size='0.02 0.02 0.02'/></geometry></collision></link>" +
              jointXml("joint", type, "base", "tool", "<axis xyz='" + axis + "'/>" + limitXml(limits))));
}

WorldObject ballAt(const std::string& id, const Eigen::Vector3d& at)
{
  return {id, Eigen::Isometry3d(Eigen::Translation3d(at)), {{Sphere{0.01}}}, 0.0};
}

/// States from half a turn below 0 to half a turn above 0, at the limits and slightly beyond them, as far as the
/// checker accepts the values.
std::vector<double> statesFor(const Limits& limits, const RobotModel& robot)
{
  std::vector<double> states;
  for (int i = 0; i <= 500; ++i)
    states.push_back(0.0125 * (i - 250));
  for (const double limit : {limits.lower, limits.upper})
    for (const double beyond : {-2e-3, -5e-4, 0.0, 5e-4, 2e-3})
      if (std::abs(limit + beyond) <= robot.variables()[0].largest)
        states.push_back(limit + beyond);
  return states;
}

TEST(ExtremeReductions, KeepWhatAJointOfHugeAnglesCanReach)
{
  for (const Limits& limits : kHuge)
    for (const double angle : {-3.1415, -2.0, -0.7, 0.0, 0.7, 1.8, 3.0, 3.1415})
    {
      const auto scene = toolOn("revolute", "0 0 1", limits);
      scene->objects.push_back(ballAt("ball", 0.9 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)));
      const std::vector<double> states = statesFor(limits, *scene->robot);
      EXPECT_LT(expectSameAnswers(scene, states, limitXml(limits) + " at " + std::to_string(angle)), states.size());
    }
}

TEST(ExtremeReductions, KeepWhatAJointOfHugeTravelCanReach)
{
  for (const Limits& limits : kHuge)
    for (const double y : {-3.0, -0.4, 0.3, 2.5})
    {
      const auto scene = toolOn("prismatic", "0 1 0", limits);
      scene->objects.push_back(ballAt("ball", {0.9, y, 0.0}));
      const std::vector<double> states = statesFor(limits, *scene->robot);
      EXPECT_LT(expectSameAnswers(scene, states, limitXml(limits) + " at " + std::to_string(y)), states.size());
    }
}

TEST(ExtremeReductions, StillLeaveOutWhatAJointOfHugeAnglesCannotReach)
{
  for (const Limits& limits : kHuge)
  {
    const auto scene = toolOn("revolute", "0 0 1", limits);
    scene->objects.push_back(ballAt("far", {1.5, 0.0, 0.0}));
    EXPECT_EQ(CpuChecker(scene).report().unreachable_world_pairs, 1U) << limitXml(limits);
  }
}

/// Two links behind a slide are welded together. They overlap by 0.1 mm or are 0.1 mm apart.
TEST(ExtremeReductions, DecideWeldedLinksWhereverTheJointsBeforeThemAre)
{
  for (const double upper : {1.0, 1e9, 1e12, 1e13, 1e16})
    for (const std::string axis : {"0.6 0.8 0", "1 0 0"})
      for (const std::string offset : {"0.0999", "0.1001"})
      {
        const auto link = [](const std::string& name) {
          return "<link name='" + name +
                 "'><collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision></link>";
        };
        const auto scene = std::make_shared<PlanningScene>(
            robotOf("<link name='root'/>" + link("a") + link("b") +
                    jointXml("slide", "prismatic", "root", "a", "<axis xyz='" + axis + "'/>" + limitXml({0.1, upper})) +
                    jointXml("weld", "fixed", "a", "b", "<origin xyz='" + offset + " 0 0'/>")));
        scene->allowed_collisions = AllowedCollisionMatrix();
        const std::vector<double> states = {0.1, 0.3, 0.9};
        EXPECT_EQ(expectSameAnswers(scene, states, "up to " + std::to_string(upper)), offset == "0.1001" ? 3U : 0U);
      }
}

/// A link carries a box with a corner up. An object's frame is slightly off rigid, and its shape lies far from the
/// frame's origin. The box touches the shape only if the frame's rotation is replaced by the nearest true rotation.
TEST(ExtremeReductions, UseTheNearestRigidPose)
{
  const double half = 0.1;
  const Eigen::Quaterniond corner_up =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Ones().eval(), Eigen::Vector3d::UnitZ().eval());
  for (const double offset : {5.0, 10.0, 100.0, 500.0})
    for (const bool half_space : {false, true})
    {
      const double state = 0.0;
      auto scene = std::make_shared<PlanningScene>(
          robotOf("<link name='base'/><link name='tool'/>" +
                  jointXml("turn", "continuous", "base", "tool", "<axis xyz='0 0 1'/>")));
      WorldObject carried = {"carried", Eigen::Isometry3d::Identity(), {{Box{{2 * half, 2 * half, 2 * half}}}}, 0.0};
      carried.pose.linear() = corner_up.toRotationMatrix();
      scene->objects.push_back(carried);
      scene->attach("carried", "tool", {}, &state);
      PlacedShape shape = {half_space ? Shape(HalfSpace{-Eigen::Vector3d::UnitZ(), 0.0}) : Shape(Box{{2.0, 2.0, 2.0}})};
      shape.pose.translation().z() = offset;
      WorldObject object = {"object", Eigen::Isometry3d::Identity(), {shape}, 0.0};
      object.pose.linear() *= 1.0 + 4e-7;
      const double overlap = 0.3 * offset * 4e-7;
      object.pose.translation().z() = -offset + (half_space ? 0.0 : 1.0) + half * std::sqrt(3.0) - overlap;
      scene->objects.push_back(object);
      EXPECT_EQ(expectSameAnswers(scene, {state}, "offset " + std::to_string(offset)), 0U);
    }
}

template <class Name, class = void>
constexpr bool kHasRow = false;
template <class Name>
constexpr bool kHasRow<Name, std::void_t<decltype(std::declval<AllowedCollisionMatrix>().row(std::declval<Name>()))>> =
    true;
static_assert(kHasRow<const std::string&> && !kHasRow<std::string> && !kHasRow<const char*>,
              "a row points to its name, which has to stay");

TEST(Chunks, AreAllDoneWhereTheSystemRefusesThreads)
{
  pthread_attr_t usual;
  ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
  pthread_attr_t greedy;
  ASSERT_EQ(pthread_attr_init(&greedy), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&greedy, std::size_t{1} << 48), 0);  // larger than the address space
  ASSERT_EQ(pthread_setattr_default_np(&greedy), 0);
  std::vector<int> done(1000, 0);
  EXPECT_NO_THROW(parallelFor(done.size(), 1,
                              [&](std::size_t begin, std::size_t end)
                              {
                                for (std::size_t i = begin; i < end; ++i)
                                  ++done[i];
                              }));
  EXPECT_EQ(pthread_setattr_default_np(&usual), 0);
  pthread_attr_destroy(&greedy);
  pthread_attr_destroy(&usual);
  EXPECT_EQ(done, std::vector<int>(1000, 1));
}
}  // namespace
}  // namespace gpu_planning_scene::core
