// Blocks of states have the verdicts of the exact checker, with each instruction set; and each proof holds.

#include <array>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "collision/cpu/lanes/lane_buffers.h"
#include "collision/cpu/lanes/lane_kernel.h"
#include "collision/proofs/proven_scene.h"
#include "support/near_contact.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using InstancePairs = std::vector<InstancePair>;

/// The pairs that collide in each state.
std::vector<InstancePairs> collidingPairs(const ProvenScene& proven, const std::vector<double>& states)
{
  const RobotModel& robot = *proven.scene.scene->robot;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  ExactChecker::Scratch scratch;
  std::vector<InstancePairs> all;
  for (std::size_t i = 0; i < states.size(); i += robot.variables().size())
  {
    robot.linkPoses(states.data() + i, poses.data());
    all.push_back(proven.exact->collidingInstances(poses.data(), scratch));
  }
  return all;
}

/// The result of a kernel for one state.
struct Proven
{
  Proof proof;
  std::uint32_t pair;               // if it collides
  std::vector<std::uint32_t> open;  // pairs without a proof, unless it collides
};

using BlockSize = std::function<int()>;

int fullBlock()
{
  return lanes::kLanes;
}

/// Runs a kernel on all states, in blocks of these sizes, and calls visit(state, its result).
template <class Visit>
void proveAll(const ProvenScene& proven, const lanes::NamedKernel& kernel, const std::vector<double>& states,
              const float* margins, const Visit& visit, const BlockSize& block_size = fullBlock)
{
  const lanes::Model& model = proven.lanes->model();
  LaneBuffers buffers;
  const lanes::Scratch scratch = buffers.of(*proven.lanes);
  const std::size_t pairs = proven.lanes->pairCount();
  const std::size_t count = states.size() / model.width;
  int size = 0;
  for (std::size_t first = 0; first < count; first += static_cast<std::size_t>(size))
  {
    size = std::min(block_size(), static_cast<int>(count - first));
    std::fill_n(scratch.trials, lanes::kTests * pairs, lanes::Trial{});  // so that no test is left out
    lanes::Block block;
    kernel.kernel(model, states.data() + first * model.width, size, margins, scratch, block);
    for (int lane = 0; lane < size; ++lane)
    {
      const std::uint32_t* const begin = scratch.open + static_cast<std::size_t>(lane) * pairs;
      visit(first + static_cast<std::size_t>(lane),
            Proven{block.proof[lane], block.pair[lane], {begin, begin + block.open_count[lane]}});
    }
  }
}

/// Runs a kernel on all states and compares its proofs with the pairs that collide. Returns the number of proven
/// states.
std::size_t compare(const ProvenScene& proven, const lanes::NamedKernel& kernel, const std::vector<double>& states,
                    const std::vector<InstancePairs>& colliding, const BlockSize& block_size = fullBlock)
{
  std::size_t proven_states = 0;
  proveAll(
      proven, kernel, states, nullptr,
      [&](std::size_t state, const Proven& result)
      {
        const InstancePairs& pairs = colliding[state];
        if (result.proof == Proof::Apart)
          EXPECT_TRUE(pairs.empty()) << kernel.instructions << ", seed " << kSeed;
        if (result.proof == Proof::Colliding)
          EXPECT_EQ(std::count(pairs.begin(), pairs.end(), proven.lanes->instancesOf(result.pair)), 1)
              << kernel.instructions << ", seed " << kSeed;
        proven_states += result.proof == Proof::None ? 0 : 1;
      },
      block_size);
  return proven_states;
}

TEST_P(ProvenScenes, ProofsHoldInRandomStatesWithEachInstructionSet)
{
  constexpr std::size_t kStates = repetitions(1000, 20000);
  const std::vector<double> states = proven_->scene.randomStates(kStates, kSeed);
  const std::vector<InstancePairs> colliding = collidingPairs(*proven_, states);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    const std::size_t proven = compare(*proven_, kernel, states, colliding);
    std::cout << kernel.instructions << ": " << proven << " of " << kStates << " states proven" << std::endl;
    EXPECT_GT(proven, kStates / 3);
  }
}

TEST_P(ProvenScenes, PairsThatAreProvenApartKeepTheirMarginsIfThereAreAny)
{
  constexpr std::size_t kStates = repetitions(1000, 20000);
  constexpr double kLargestMargin = 0.05;  // metres
  const std::vector<double> states = proven_->scene.randomStates(kStates, kSeed + 1);
  const std::size_t bodies = proven_->problem->robot.size();
  std::mt19937_64 generator(kSeed + 2);
  std::uniform_real_distribution<double> distances(0.0, kLargestMargin);
  std::vector<double> margins(bodies + proven_->problem->self_pairs.size());  // in the order of the kernel
  std::generate(margins.begin(), margins.end(), [&] { return distances(generator); });
  std::vector<float> in_lanes;
  for (const double margin : margins)
    in_lanes.insert(in_lanes.end(), lanes::kLanes, lanes::kernelMargin(margin));
  std::vector<Eigen::Isometry3d> poses(robot().links().size());
  ExactChecker::Scratch exact;
  std::vector<std::uint64_t> steps;
  for (const bool has_margins : {true, false})
  {
    std::vector<ExactChecker::OpenPair> pairs;
    for (std::uint32_t p = 0; p < proven_->lanes->pairCount(); ++p)
    {
      const InstancePair& instances = proven_->lanes->instancesOf(p);
      pairs.push_back({instances, has_margins ? margins[instances[1] < bodies ? bodies + p : instances[0]] : 0.0});
    }
    for (const lanes::NamedKernel& kernel : lanes::availableKernels())
    {
      std::size_t apart = 0;
      std::size_t open = 0;
      proveAll(*proven_, kernel, states, has_margins ? in_lanes.data() : nullptr,
               [&](std::size_t state, const Proven& result)
               {
                 if (result.proof == Proof::Colliding)
                   return;
                 robot().linkPoses(states.data() + state * robot().variables().size(), poses.data());
                 std::vector<ExactChecker::OpenPair> proven_apart;
                 for (std::uint32_t p = 0; p < pairs.size(); ++p)
                   if (std::find(result.open.begin(), result.open.end(), p) == result.open.end())
                     proven_apart.push_back(pairs[p]);
                 apart += proven_apart.size();
                 open += result.open.size();
                 EXPECT_FALSE(proven_->exact->firstCollisionOf(proven_apart.data(), proven_apart.size(), poses.data(),
                                                               exact, steps))
                     << kernel.instructions << ", seed " << kSeed << ", state " << state;
               });
      std::cout << kernel.instructions << (has_margins ? ", with margins: " : ": ") << apart << " pairs proven apart, "
                << open << " open" << std::endl;
      EXPECT_GT(apart, open);
    }
  }
}

const char* const kJointLimit = "<limit lower='-3' upper='3' effort='1' velocity='1'/>";

/// A link and the joint that moves it.
std::string movedLink(const std::string& name, const std::string& parent, const std::string& joint,
                      const std::string& collision = "")
{
  return "<link name='" + name + "'>" + collision + "</link><joint name='to " + name + "' " + joint + "<parent link='" +
         parent + "'/><child link='" + name + "'/></joint>";
}

/// A chain of turning joints that are metres apart, from the link "fixed" to the link "tip". Its other joints undo what
/// its first joints do, so the tip does not move. The kernel has the rounding errors of all of them.
std::string chainThatReturns()
{
  constexpr int kFolds = 2;
  std::string urdf;
  std::string parent = "fixed";
  const auto add = [&](const std::string& name, const std::string& joint)
  {
    urdf += movedLink(name, parent, joint);
    parent = name;
  };
  for (int fold = 0; fold < kFolds; ++fold)
  {
    const std::string number = std::to_string(fold);
    const std::string turn = "type='revolute'><axis xyz='0.6 0 0.8'/>" + std::string(kJointLimit);
    const auto mimic = [&](const char* multiplier)
    { return turn + "<mimic joint='to turn" + number + "' multiplier='" + multiplier + "'/>"; };
    add("turn" + number, turn);
    add("out" + number, "type='fixed'><origin xyz='2 -1 1'/>");
    add("turned back" + number, mimic("-1"));
    add("turned again" + number, mimic("1"));
    add("in" + number, "type='fixed'><origin xyz='-2 1 -1'/>");
    add("straight" + number, mimic("-1"));
  }
  return urdf + movedLink("tip", parent, "type='fixed'>");
}

struct TwoBoxes
{
  const char* name;
  double turns;             // the range of each of the three angles of the moving box
  bool has_chain;           // between the boxes, see chainThatReturns
  double mesh_from_origin;  // metres: the moving box is a mesh this far from the origin of its frame; 0: a primitive
  std::string joint = "";   // planar or floating: moves the box instead of six joints with one variable each
};

/// The box that one planar or floating joint moves. The plane is at the height of the other box.
std::string boxOnOneJoint(const std::string& type, const std::string& box)
{
  return movedLink("box", "fixed", "type='" + type + "'><origin xyz='0 0 0.3' rpy='0.1 0 0.2'/><axis xyz='0 0 1'/>",
                   box);
}

/// A box that moves freely around another one: the boxes of the kernel's test are the shapes themselves.
TestScene twoBoxes(const TwoBoxes& kind)
{
  const Eigen::Vector3d size(0.25, 0.15, 0.05);
  std::string urdf =
      "<robot name='two_boxes'><link name='fixed'><collision><origin xyz='0.2 -0.1 0.3'/>"
      "<geometry><box size='0.3 0.2 0.1'/></geometry></collision></link>";
  const std::string box =
      "<collision><origin xyz='0.05 0.1 -0.02'/><geometry><box size='0.25 0.15 0.05'/></geometry></collision>";
  std::string parent = "fixed";
  if (kind.has_chain)
  {
    urdf += chainThatReturns();
    parent = "tip";
  }
  if (!kind.joint.empty())
    urdf += boxOnOneJoint(kind.joint, box);
  for (const char* axis : {"1 0 0", "0 1 0", "0 0 1"})
    for (const char* type : {"prismatic", "revolute"})
    {
      if (!kind.joint.empty())
        continue;
      const std::string link = std::string(type) + axis;
      // The kernel's bounds grow with the travel of prismatic joints, so it is short here.
      const std::string limit = std::string(type) == "prismatic" ? "0.5" : "3";
      const bool is_box = link == "revolute0 0 1" && kind.mesh_from_origin == 0.0;
      urdf += movedLink(link, parent,
                        "type='" + std::string(type) + "'><axis xyz='" + axis + "'/><limit lower='-" + limit +
                            "' upper='" + limit + "' effort='1' velocity='1'/>",
                        is_box ? box : "");
      parent = link;
    }
  urdf += "</robot>";
  auto scene = std::make_shared<PlanningScene>(RobotModel::fromXml(urdf, "<robot name='two_boxes'/>", {}));
  if (kind.mesh_from_origin != 0.0)
  {
    const Eigen::Vector3d shift(kind.mesh_from_origin, 0.0, 0.0);
    auto mesh = std::make_shared<Mesh>(*tessellate(Box{size}).mesh);
    for (Eigen::Vector3d& vertex : mesh->vertices)
      vertex += shift;
    const Eigen::Isometry3d pose(Eigen::Translation3d(Eigen::Vector3d(0.05, 0.1, -0.02) - shift));
    scene->attached.push_back(
        {{"mesh", pose, {{mesh, Eigen::Isometry3d::Identity()}}, 0.0}, scene->robot->linkIndex(parent)});
  }
  TestScene made{kind.name, scene, {}, {}};
  for (const Variable& variable : scene->robot->variables())
  {
    const bool is_of_chain = variable.name.find("turn") != std::string::npos;
    const bool is_angle =
        variable.name.find("revolute") != std::string::npos || variable.name.find("theta") != std::string::npos;
    const double range = is_of_chain ? 3.0 : is_angle ? kind.turns : 0.5;
    made.lower.push_back(-range);
    made.upper.push_back(range);
  }
  return made;
}

class BoxesOfSelfPairs : public testing::TestWithParam<TwoBoxes>
{
};

TEST_P(BoxesOfSelfPairs, AreNotSeparatedInContact)
{
  constexpr std::size_t kStates = repetitions(300, 40000);
  const ProvenScene proven = prove(twoBoxes(GetParam()));
  const std::vector<double> states = nearContactStates(proven.scene, kStates, kSeed + 3);
  const std::vector<InstancePairs> colliding = collidingPairs(proven, states);
  const std::vector<double> random = proven.scene.randomStates(kStates, kSeed + 4);
  const std::vector<InstancePairs> colliding_random = collidingPairs(proven, random);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    compare(proven, kernel, states, colliding);
    EXPECT_GT(compare(proven, kernel, random, colliding_random), kStates / 3)
        << "the bounds are too large to be of use";
  }
  const auto collides = [](const InstancePairs& pairs) { return !pairs.empty(); };
  EXPECT_EQ(std::count_if(colliding.begin(), colliding.end(), collides), kStates / 2);
}

INSTANTIATE_TEST_SUITE_P(Robots, BoxesOfSelfPairs,
                         testing::Values(TwoBoxes{"parallel", 0.0, false, 0.0},
                                         TwoBoxes{"nearly_parallel", 1e-6, false, 0.0},
                                         TwoBoxes{"turned", 3.0, false, 0.0},
                                         TwoBoxes{"after_a_long_chain", 3.0, true, 0.0},
                                         TwoBoxes{"mesh_far_from_its_origin", 3.0, false, 30.0},
                                         TwoBoxes{"on_a_planar_joint", 3.0, false, 0.0, "planar"},
                                         TwoBoxes{"on_a_floating_joint", 3.0, false, 0.0, "floating"}),
                         [](const auto& tested) { return tested.param.name; });

/// Random states in which the base rests for many states, moves to another place, and moves for a while.
std::vector<double> withMovesOfTheBase(const ProvenScene& proven, std::size_t count)
{
  constexpr std::array<double, 4> kStep = {0.3, -0.2, 0.1, 0.4};  // metres or radians
  const lanes::Base& base = proven.lanes->model().base;
  std::mt19937_64 generator(kSeed + 5);
  std::uniform_int_distribution<std::size_t> one_of_forty(0, 39);
  std::uniform_int_distribution<int> places(-1, 1);
  const std::vector<double> rests = proven.scene.scene->robot->defaultState();
  std::vector<double> states = proven.scene.randomStates(count, kSeed + 6);
  const std::size_t width = proven.lanes->model().width;
  std::uniform_int_distribution<std::size_t> one_variable(0, static_cast<std::size_t>(base.variables) - 1);
  std::array<int, lanes::kMostBaseVariables> place{};
  bool moves = false;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (one_of_forty(generator) == 0)
      moves = !moves;
    if (moves || one_of_forty(generator) == 0)
      place[one_variable(generator)] = places(generator);
    double* const values = &states[i * width + static_cast<std::size_t>(base.variable)];
    for (std::size_t k = 0; k < static_cast<std::size_t>(base.variables); ++k)
      values[k] = rests[static_cast<std::size_t>(base.variable) + k] + place[k] * kStep[k % kStep.size()];
  }
  return states;
}

class MovingBases : public testing::TestWithParam<TestScene (*)()>
{
};

TEST_P(MovingBases, ProofsHoldWhileTheBaseRestsAndMoves)
{
  constexpr std::size_t kStates = repetitions(1000, 20000);
  const ProvenScene proven = prove(GetParam()());
  ASSERT_GT(proven.lanes->model().base.frames, 0U);
  const std::vector<double> states = withMovesOfTheBase(proven, kStates);
  const std::vector<InstancePairs> colliding = collidingPairs(proven, states);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    std::mt19937_64 generator(kSeed + 7);
    std::uniform_int_distribution<int> sizes(1, lanes::kLanes);
    EXPECT_GT(compare(proven, kernel, states, colliding, [&] { return sizes(generator); }), kStates / 4)
        << kernel.instructions;
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, MovingBases,
                         testing::Values([] { return testScene("arm_driven"); },
                                         [] {
                                           return twoBoxes({"floating", 3.0, false, 0.0, "floating"});
                                         }),
                         [](const auto& tested)
                         { return tested.index == 0 ? "planar" : "floating_after_a_fixed_link"; });
}  // namespace
}  // namespace gpu_planning_scene::core
