// Random robots and worlds with all joint types, mimic joints, several shapes per link, meshes and solids, and up to
// hundreds of objects. Every traversal on the GPU must give the CPU's verdicts. A state that is free with its
// neighbourhood must have free neighbours. No motion may move a point of the robot by more than its margin.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "collision/bounds/displacement_bounds.h"
#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_checker.h"
#include "collision/exact/forest_cache.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/interpolation.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStatesOfARobot = repetitions(60, 500);

class RandomRobots : public testing::TestWithParam<std::uint64_t>
{
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }

  std::string geometryXml()
  {
    std::ostringstream xml;
    switch (below(3))
    {
      case 0:
        xml << "<box size='" << uniform(0.02, 0.3) << ' ' << uniform(0.02, 0.3) << ' ' << uniform(0.02, 0.3) << "'/>";
        break;
      case 1:
        xml << "<cylinder radius='" << uniform(0.01, 0.1) << "' length='" << uniform(0.05, 0.4) << "'/>";
        break;
      default:
        xml << "<sphere radius='" << uniform(0.02, 0.15) << "'/>";
    }
    return "<geometry>" + xml.str() + "</geometry>";
  }

  std::string originXml(double reach)
  {
    std::ostringstream xml;
    xml << "<origin xyz='" << uniform(-reach, reach) << ' ' << uniform(-reach, reach) << ' ' << uniform(-reach, reach)
        << "' rpy='" << uniform(-3, 3) << ' ' << uniform(-3, 3) << ' ' << uniform(-3, 3) << "'/>";
    return xml.str();
  }

  std::string jointType(int link)
  {
    if (link == 1)
      return below(2) == 0 ? "planar" : "floating";
    const std::vector<std::string> types = {"revolute", "continuous", "prismatic", "fixed"};
    return types[static_cast<std::size_t>(below(4))];
  }

  /// A mimic element with a random multiplier. The leader may have another joint type and may be a mimic joint itself.
  std::string mimicXml(const std::vector<std::string>& leaders)
  {
    if (leaders.empty() || below(2) == 0)
      return "";
    const double any = uniform(-3, 3);
    const double whole = any < 0.0 ? std::floor(any) : std::ceil(any);  // a continuous leader keeps its period
    std::ostringstream xml;
    xml << "<mimic joint='" << leaders[static_cast<std::size_t>(below(static_cast<int>(leaders.size())))]
        << "' multiplier='" << (below(2) == 0 ? any : whole) << "' offset='" << uniform(-1, 1) << "'/>";
    return xml.str();
  }

  std::shared_ptr<const RobotModel> robot()
  {
    std::ostringstream xml;
    std::vector<std::string> leaders;
    const int links = 3 + below(12);
    xml << "<robot name='random'>";
    for (int i = 0; i < links; ++i)
    {
      xml << "<link name='l" << i << "'>";
      for (int shapes = below(3); shapes > 0; --shapes)
        xml << "<collision>" << originXml(0.1) << geometryXml() << "</collision>";
      xml << "</link>";
    }
    for (int i = 1; i < links; ++i)
    {
      // Mostly a chain, with some branches.
      const int parent = below(3) == 0 ? below(i) : i - 1;
      const std::string name = "j" + std::to_string(i);
      const std::string type = jointType(i);
      const bool can_follow = i > 1 && type != "fixed";
      xml << "<joint name='" << name << "' type='" << type << "'><parent link='l" << parent << "'/><child link='l" << i
          << "'/>" << originXml(0.3) << "<axis xyz='" << uniform(-1, 1) << ' ' << uniform(-1, 1) << ' '
          << uniform(0.1, 1) << "'/><limit lower='-1' upper='1' effort='1' velocity='1'/>"
          << (can_follow ? mimicXml(leaders) : "") << "</joint>";
      if (can_follow)
        leaders.push_back(name);
    }
    xml << "</robot>";
    return RobotModel::fromXml(xml.str(), "", {});
  }

  Shape shape()
  {
    switch (below(5))
    {
      case 0:
        return Box{{uniform(0.02, 0.4), uniform(0.02, 0.4), uniform(0.02, 0.4)}};
      case 1:
        return Sphere{uniform(0.03, 0.2)};
      case 2:
        return Cylinder{uniform(0.02, 0.1), uniform(0.05, 0.6)};
      case 3:
        return Cone{uniform(0.03, 0.2), uniform(0.05, 0.5)};
      default:
        return mesh_;
    }
  }

  /// The scene of the seed, and the generator after it. The tests share the scene and its trees, because building the
  /// trees of hundreds of objects takes a while.
  std::shared_ptr<const PlanningScene> scene()
  {
    using SceneAndGenerator = std::pair<std::shared_ptr<const PlanningScene>, std::mt19937_64>;
    static std::map<std::uint64_t, SceneAndGenerator> made;
    if (made.count(GetParam()) == 0)
    {
      const auto drawn = drawScene();
      keepTrees(*drawn);
      made[GetParam()] = {drawn, generator_};
    }
    generator_ = made.at(GetParam()).second;
    return made.at(GetParam()).first;
  }

  std::shared_ptr<const PlanningScene> drawScene()
  {
    auto wavy = std::make_shared<Mesh>(*tessellate(Sphere{0.12}).mesh);
    for (Eigen::Vector3d& vertex : wavy->vertices)
      vertex *= 1.0 + 0.3 * std::sin(40.0 * vertex.x());
    mesh_ = wavy;
    auto made = std::make_shared<PlanningScene>(robot());
    const int objects = below(4) == 0 ? 300 : below(12);
    const double reach = objects > 12 ? 4.0 : 1.5;
    for (int i = 0; i < objects; ++i)
    {
      WorldObject object;
      object.id = "o" + std::to_string(i);
      object.pose = Eigen::Translation3d(uniform(-reach, reach), uniform(-reach, reach), uniform(-1.5, 1.5));
      object.pose.rotate(
          Eigen::AngleAxisd(uniform(-3, 3), Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), 1).normalized()));
      for (int shapes = 1 + below(2); shapes > 0; --shapes)
      {
        object.shapes.push_back(
            {shape(), Eigen::Isometry3d(Eigen::Translation3d(uniform(-0.1, 0.1), uniform(-0.1, 0.1), 0.0))});
      }
      made->objects.push_back(object);
    }
    return made;
  }

  std::vector<double> randomStates(const RobotModel& robot)
  {
    const std::size_t width = robot.variables().size();
    std::vector<double> states(kStatesOfARobot * width);
    for (std::size_t i = 0; i < kStatesOfARobot; ++i)
      robot.randomState(generator_, &states[i * width]);
    return states;
  }

  /// Sets the travel of mimic joints to the travel that follows from their leaders.
  static void follow(const RobotModel& robot, JointTravel* travel)
  {
    const std::vector<Joint>& joints = robot.joints();
    for (std::size_t i = 0; i < joints.size(); ++i)
      for (std::size_t k = 0; k < joints.size(); ++k)
        if (joints[i].mimic && !joints[k].mimic && joints[i].first_variable == joints[k].first_variable)
        {
          const double moved = joints[k].type == JointType::Prismatic ? travel[k].length : travel[k].angle;
          const double own = std::abs(joints[i].multiplier) * moved;
          travel[i] = joints[i].type == JointType::Prismatic ? JointTravel{own, 0.0} : JointTravel{0.0, own};
        }
  }

  /// Rows of travel from 0 to 0.2, each for some of the states. Some joints do not move.
  JointNeighbourhood surroundings(const RobotModel& robot)
  {
    JointNeighbourhood around;
    for (const double most : {0.0, 1e-3, 0.01, 0.05, 0.2})
    {
      for (const Joint& joint : robot.joints())
        around.travel.push_back(joint.type == JointType::Fixed || below(4) == 0
                                    ? JointTravel{}
                                    : JointTravel{uniform(0.0, most), uniform(0.0, most)});
      follow(robot, &around.travel[around.travel.size() - robot.joints().size()]);
    }
    const bool by_turns = below(2) == 0;  // else a part of the batch may not use the first or the last rows
    for (std::size_t i = 0; i < kStatesOfARobot; ++i)
      around.rows.push_back(
          static_cast<std::uint32_t>(by_turns ? static_cast<std::size_t>(below(5)) : i * 5 / kStatesOfARobot));
    return around;
  }

  Eigen::Vector3d direction() { return Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized(); }

  /// Moves each joint by up to its travel, within its limits.
  void moveWithin(const RobotModel& robot, const JointTravel* travel, double* state)
  {
    const auto move = [&](int variable, double by)
    {
      const Variable& limits = robot.variables()[static_cast<std::size_t>(variable)];
      state[variable] += by;
      if (limits.bounded)
        state[variable] = std::clamp(state[variable], limits.lower, limits.upper);
    };
    for (std::size_t i = 0; i < robot.joints().size(); ++i)
    {
      const Joint& joint = robot.joints()[i];
      if (joint.mimic)
        continue;
      const int first = joint.first_variable;
      const double angle = below(2) == 0 ? travel[i].angle : uniform(0.0, travel[i].angle);
      const double side = below(2) == 0 ? 1.0 : -1.0;
      const Eigen::Vector3d by = (below(2) == 0 ? 1.0 : uniform(0.0, 1.0)) * travel[i].length * direction();
      switch (joint.type)
      {
        case JointType::Revolute:
        case JointType::Continuous:
          move(first, side * angle);
          break;
        case JointType::Prismatic:
          move(first, side * by.norm());
          break;
        case JointType::Planar:
          move(first, by.x());
          move(first + 1, by.y());
          move(first + 2, side * angle);
          break;
        case JointType::Floating:
        {
          for (int k = 0; k < 3; ++k)
            move(first + k, by[k]);
          Eigen::Map<Eigen::Quaterniond> rotation(state + first + 3);
          rotation = Eigen::AngleAxisd(angle, direction()) * rotation;
          break;
        }
        case JointType::Fixed:
          break;
      }
    }
  }

  /// The end of a motion that leads from a state to a random state, or only towards it. All or only some of the joints
  /// move. The angles of continuous joints may be off by a whole turn.
  std::vector<double> endOfMotion(const RobotModel& robot, const std::vector<double>& start)
  {
    std::vector<double> far(start.size());
    robot.randomState(generator_, far.data());
    const bool few = below(2) == 0;
    for (const Joint& joint : robot.joints())
    {
      if (joint.mimic || joint.first_variable < 0)
        continue;
      const auto first = static_cast<std::size_t>(joint.first_variable);
      const auto count = static_cast<std::size_t>(variableCount(joint.type));
      if (few && below(4) != 0)
        std::copy_n(&start[first], count, &far[first]);
      else if (joint.type == JointType::Continuous)
        far[first] += 2.0 * EIGEN_PI * (below(3) - 1);
    }
    std::vector<double> end(start.size());
    const double fractions[] = {0.001, 0.03, 0.3, 1.0};
    interpolate(robot, start.data(), far.data(), fractions[below(4)], end.data());
    return end;
  }

  std::mt19937_64 generator_{GetParam()};
  std::shared_ptr<const Mesh> mesh_;
};

/// The positions of points on the shapes of a problem's robot in a state.
class PlacedPoints
{
 public:
  PlacedPoints(const RobotModel& robot, const CollisionProblem& problem, const double* state)
    : problem_(problem), links_(robot.links().size())
  {
    robot.linkPoses(state, links_.data());
  }

  /// The largest distance between the positions of a point of `shape` in the two states, in the frame of the link
  /// `viewer`; -1: the planning frame.
  double farthest(const PlacedPoints& other, std::uint32_t shape, int viewer) const
  {
    constexpr std::size_t kPoints = 24;
    const std::vector<Eigen::Vector3d>& points = problem_.tessellations[problem_.robot[shape].tree].mesh->vertices;
    const Eigen::Isometry3d here = poseOf(shape, viewer);
    const Eigen::Isometry3d there = other.poseOf(shape, viewer);
    double most = 0.0;
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kPoints)
      most = std::max(most, (here * points[i] - there * points[i]).norm());
    return most;
  }

 private:
  Eigen::Isometry3d poseOf(std::uint32_t shape, int viewer) const
  {
    const ShapeInstance& instance = problem_.robot[shape];
    const Eigen::Isometry3d pose = links_[static_cast<std::size_t>(instance.link)] * instance.pose;
    return viewer < 0 ? pose : links_[static_cast<std::size_t>(viewer)].inverse() * pose;
  }

  const CollisionProblem& problem_;
  std::vector<Eigen::Isometry3d> links_;
};

/// The last common link on the paths from the root to both links.
int commonLink(const RobotModel& robot, int a, int b)
{
  while (a != b)  // parents have smaller indices than children
  {
    int& later = a > b ? a : b;
    const int joint = robot.links()[static_cast<std::size_t>(later)].parent_joint;
    later = robot.joints()[static_cast<std::size_t>(joint)].parent_link;
  }
  return a;
}

/// Splits a motion into parts. Expects that each part, and the motion from its start to each part, moves points within
/// their margins. Returns the largest ratio of displacement to margin.
double expectWithinMargins(const PlanningScene& scene, const CollisionProblem& problem,
                           const DisplacementBounds& displacements, const std::vector<double>& start,
                           const std::vector<double>& end)
{
  constexpr int kParts = 8;
  constexpr double kRounding = 1e-12;  // metres: intermediate states have rounding errors even if a joint does not move
  const RobotModel& robot = *scene.robot;
  JointNeighbourhood around{jointTravel(robot, start.data(), end.data()), {0}};
  for (std::size_t i = 0; i < robot.joints().size(); ++i)
    around.travel.push_back({around.travel[i].length / kParts, around.travel[i].angle / kParts});

  std::vector<PlacedPoints> placed;
  // The second row is that of all states between the parts. Its centre is the middle of the motion.
  std::vector<double> states = start;
  around.spread = 0.5 * kParts;
  around.centers = start;
  std::vector<double> state(start.size());
  for (int part = 0; part <= kParts; ++part)
  {
    interpolate(robot, start.data(), end.data(), static_cast<double>(part) / kParts, state.data());
    placed.emplace_back(robot, problem, state.data());
    states.insert(states.end(), state.begin(), state.end());
    around.rows.push_back(1);
    if (part == kParts / 2)
      around.centers.insert(around.centers.end(), state.begin(), state.end());
  }
  const Margins margins = displacements.margins(around, states.data(), around.rows.size());
  EXPECT_EQ(margins.within, std::vector<std::uint8_t>(around.rows.size(), 1));
  double fullest = 0.0;
  const auto compare = [&](std::size_t margin, const std::vector<std::uint32_t>& shapes, int viewer)
  {
    for (std::size_t part = 1; part < placed.size(); ++part)
      for (const std::size_t from : {std::size_t{0}, part - 1})
      {
        const double most = margins.of(from == 0 && part != 1 ? 0 : 1)[margin];
        double moved = 0.0;
        for (const std::uint32_t shape : shapes)
          moved += placed[part].farthest(placed[from], shape, viewer);
        EXPECT_LE(moved, most + kRounding)
            << "parts " << from << " to " << part << ", " << scene.bodyName(problem.robot[shapes.front()].body)
            << " and " << scene.bodyName(problem.robot[shapes.back()].body);
        fullest = most > 0.0 ? std::max(fullest, moved / most) : fullest;
      }
  };
  for (std::uint32_t i = 0; i < problem.robot.size(); ++i)
    compare(i, {i}, -1);
  // Two shapes approach each other by at most the sum of their displacements in the frame of their last common link.
  for (std::size_t i = 0; i < problem.self_pairs.size(); ++i)
  {
    const auto [a, b] = problem.self_pairs[i];
    compare(problem.robot.size() + i, {a, b}, commonLink(robot, problem.robot[a].link, problem.robot[b].link));
  }
  return fullest;
}

TEST_P(RandomRobots, HaveTheVerdictsOfTheCpuOnTheGpu)
{
  const auto made = scene();
  const std::size_t width = made->robot->variables().size();
  const std::vector<double> states = randomStates(*made->robot);
  const std::vector<std::uint8_t> expected = CpuChecker(made).check(states.data(), kStatesOfARobot).valid;
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    BatchCheckerOptions options;
    options.traversal = traversal;
    options.device_only = true;
    options.max_batch = below(2) == 0 ? 16384 : 64;
    EXPECT_EQ(BatchChecker(made, options).check(states.data(), kStatesOfARobot).valid, expected)
        << "seed " << GetParam() << ", " << made->robot->links().size() << " links, " << made->objects.size()
        << " objects";
  }
  std::cout << "seed " << GetParam() << ": " << made->robot->links().size() << " links, " << width << " variables, "
            << made->objects.size() << " objects, " << std::count(expected.begin(), expected.end(), 1) << " of "
            << kStatesOfARobot << " free" << std::endl;
}
TEST_P(RandomRobots, FreeNeighbourhoodsHoldFreeStates)
{
  constexpr std::size_t kNeighbours = 40;
  const auto made = scene();
  const RobotModel& robot = *made->robot;
  const std::size_t width = robot.variables().size();
  const std::vector<double> states = randomStates(robot);
  const JointNeighbourhood around = surroundings(robot);
  CpuChecker checker(made);
  const std::vector<std::uint8_t> proven = checker.check(states.data(), kStatesOfARobot, "", &around).valid;
  std::vector<double> neighbours;
  for (std::size_t i = 0; i < kStatesOfARobot; ++i)
    for (std::size_t k = 0; proven[i] != 0 && k < kNeighbours; ++k)
    {
      neighbours.insert(neighbours.end(), &states[i * width], &states[(i + 1) * width]);
      moveWithin(robot, &around.travel[around.rows[i] * robot.joints().size()], &neighbours[neighbours.size() - width]);
    }
  const std::vector<std::uint8_t> free = checker.check(neighbours.data(), neighbours.size() / width).valid;
  EXPECT_EQ(std::count(free.begin(), free.end(), 0), 0) << "seed " << GetParam();
  const std::vector<std::uint8_t> plain = checker.check(states.data(), kStatesOfARobot).valid;
  for (std::size_t i = 0; i < kStatesOfARobot; ++i)
    EXPECT_LE(proven[i], plain[i]) << "seed " << GetParam() << ", state " << i;
  std::cout << "seed " << GetParam() << ": " << std::count(plain.begin(), plain.end(), 1) << " free, "
            << std::count(proven.begin(), proven.end(), 1) << " with what is around" << std::endl;
}

TEST_P(RandomRobots, MotionsStayWithinMargins)
{
  constexpr int kRobots = repetitions(4, 8);
  constexpr int kMotions = 100;
  std::ptrdiff_t followers = 0;
  double fullest = 0.0;
  for (int i = 0; i < kRobots && !HasFailure(); ++i)
  {
    const PlanningScene alone(robot());
    const RobotModel& robot = *alone.robot;
    const CollisionProblem problem = makeProblem(alone, "", nullptr);
    JointLevers levers;
    const DisplacementBounds displacements(alone.robot, problem, levers);
    followers +=
        std::count_if(robot.joints().begin(), robot.joints().end(), [](const Joint& joint) { return joint.mimic; });
    for (int motion = 0; motion < kMotions && !HasFailure(); ++motion)
    {
      SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", robot " + std::to_string(i) + ", motion " +
                   std::to_string(motion));
      std::vector<double> start(robot.variables().size());
      robot.randomState(generator_, start.data());
      fullest = std::max(fullest, expectWithinMargins(alone, problem, displacements, start, endOfMotion(robot, start)));
    }
  }
  std::cout << "seed " << GetParam() << ": " << kRobots << " robots with " << followers
            << " joints that follow others, moved by up to " << 100.0 * fullest << " % of a margin" << std::endl;
}

TEST_P(RandomRobots, AreAsFreeAroundAStateOnTheGpuAsOnTheCpu)
{
  const auto made = scene();
  const std::vector<double> states = randomStates(*made->robot);
  const JointNeighbourhood around = surroundings(*made->robot);
  const std::vector<std::uint8_t> expected = CpuChecker(made).check(states.data(), kStatesOfARobot, "", &around).valid;
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    BatchCheckerOptions options;
    options.traversal = traversal;
    options.device_only = true;
    options.max_batch = below(2) == 0 ? 16384 : 64;
    BatchChecker checker(made, options);
    const std::vector<std::uint8_t> plain = checker.check(states.data(), kStatesOfARobot).valid;
    EXPECT_EQ(checker.check(states.data(), kStatesOfARobot, "", &around).valid, expected) << "seed " << GetParam();
    EXPECT_EQ(checker.check(states.data(), kStatesOfARobot).valid, plain) << "after margins, seed " << GetParam();
  }
}
/// Making the proofs takes seconds a robot under sanitizers, so this suite has fewer seeds.
class ProofsOfRandomRobots : public RandomRobots
{
 public:
  ProofsOfRandomRobots() { setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1); }
};

TEST_P(ProofsOfRandomRobots, GiveTheVerdictsOfTheExactChecker)
{
  const auto scene = this->scene();
  const RobotModel& robot = *scene->robot;
  const std::size_t width = robot.variables().size();
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr));
  if (problem->always_colliding)
    return;  // there is nothing to prove
  ForestCache trees;
  const auto exact = trees.exactCheckerOf(problem);
  LaneChecker checker(scene->robot, problem, trees.forest(), *exact);
  EXPECT_EQ(checker.requestProofs(), ProofStage::None);
  waitForProofs();
  ASSERT_EQ(checker.requestProofs(), ProofStage::All);
  const std::vector<double> states = randomStates(robot);
  LaneChecker::Scratch scratch;
  checker.useProofs(scratch);
  ExactChecker::Scratch exact_scratch;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::size_t free = 0;
  for (std::size_t i = 0; i + lanes::kLanes <= kStatesOfARobot; i += lanes::kLanes)
  {
    const double* block = &states[i * width];
    BatchResult result;
    result.valid.assign(lanes::kLanes, 1);
    result.colliding.assign(lanes::kLanes, kNoPair);
    checker.check(block, lanes::kLanes, 0, nullptr, scratch, result);
    for (std::size_t lane = 0; lane < lanes::kLanes; ++lane)
    {
      ASSERT_TRUE(isValidFor(*problem, block + lane * width) && LaneChecker::takes(block + lane * width, scratch));
      robot.linkPoses(block + lane * width, poses.data());
      const std::vector<BodyPair> colliding = exact->allCollisions(poses.data(), exact_scratch);
      ASSERT_EQ(result.valid[lane] != 0, colliding.empty()) << "seed " << GetParam() << ", state " << i + lane;
      free += colliding.empty() ? 1 : 0;
      if (!colliding.empty())
        ASSERT_EQ(std::count(colliding.begin(), colliding.end(), result.colliding[lane]), 1) << "seed " << GetParam();
    }
  }
  std::cout << free << " of " << kStatesOfARobot << " states are free, seed " << GetParam() << std::endl;
}
INSTANTIATE_TEST_SUITE_P(Seeds, ProofsOfRandomRobots,
                         testing::Range<std::uint64_t>(1, 1 + repetitions<std::uint64_t>(1, 60)));

INSTANTIATE_TEST_SUITE_P(Seeds, RandomRobots, testing::Range<std::uint64_t>(0, repetitions(3, 16)));
}  // namespace
}  // namespace gpu_planning_scene::core
