// Robots and worlds made at random - all joint types, several shapes a link, meshes and solids, few objects and
// hundreds - on the GPU against the CPU: every traversal gives the CPU's verdicts. And what is said to be free around a
// state is.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::size_t kStates = 500;

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
    {
      return below(2) == 0 ? "planar" : "floating";
    }
    const std::vector<std::string> types = {"revolute", "continuous", "prismatic", "fixed"};
    return types[static_cast<std::size_t>(below(4))];
  }

  std::shared_ptr<const RobotModel> robot()
  {
    std::ostringstream xml;
    const int links = 3 + below(12);
    xml << "<robot name='random'>";
    for (int i = 0; i < links; ++i)
    {
      xml << "<link name='l" << i << "'>";
      for (int shapes = below(3); shapes > 0; --shapes)
      {
        xml << "<collision>" << originXml(0.1) << geometryXml() << "</collision>";
      }
      xml << "</link>";
    }
    for (int i = 1; i < links; ++i)
    {
      // Chains, with a branch now and then.
      const int parent = below(3) == 0 ? below(i) : i - 1;
      xml << "<joint name='j" << i << "' type='" << jointType(i) << "'><parent link='l" << parent << "'/><child link='l"
          << i << "'/>" << originXml(0.3) << "<axis xyz='" << uniform(-1, 1) << ' ' << uniform(-1, 1) << ' '
          << uniform(0.1, 1) << "'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>";
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

  std::shared_ptr<const PlanningScene> scene()
  {
    auto wavy = std::make_shared<Mesh>(*tessellate(Sphere{0.12}).mesh);
    for (Eigen::Vector3d& vertex : wavy->vertices)
    {
      vertex *= 1.0 + 0.3 * std::sin(40.0 * vertex.x());
    }
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
    std::vector<double> states(kStates * width);
    for (std::size_t i = 0; i < kStates; ++i)
      robot.randomState(generator_, &states[i * width]);
    return states;
  }

  /// Rows from hardly anything to a good deal, each for some states; joints of which some stand still.
  Surroundings surroundings(const RobotModel& robot)
  {
    Surroundings around;
    for (const double most : {0.0, 1e-3, 0.01, 0.05, 0.2})
      for (const Joint& joint : robot.joints())
        around.ways.push_back(joint.type == JointType::Fixed || below(4) == 0
                                  ? JointWay{}
                                  : JointWay{uniform(0.0, most), uniform(0.0, most)});
    for (std::size_t i = 0; i < kStates; ++i)
      around.rows.push_back(static_cast<std::uint32_t>(below(5)));
    return around;
  }

  Eigen::Vector3d direction() { return Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized(); }

  /// Each joint by up to its way, and as far as its limits let it.
  void moveWithin(const RobotModel& robot, const JointWay* ways, double* state)
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
      const int first = joint.first_variable;
      const double angle = below(2) == 0 ? ways[i].angle : uniform(0.0, ways[i].angle);
      const double side = below(2) == 0 ? 1.0 : -1.0;
      const Eigen::Vector3d by = (below(2) == 0 ? 1.0 : uniform(0.0, 1.0)) * ways[i].length * direction();
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

  std::mt19937_64 generator_{GetParam()};
  std::shared_ptr<const Mesh> mesh_;
};

TEST_P(RandomRobots, HaveTheVerdictsOfTheCpuOnTheGpu)
{
  const auto made = scene();
  const std::size_t width = made->robot->variables().size();
  const std::vector<double> states = randomStates(*made->robot);
  const std::vector<std::uint8_t> expected = CpuChecker(made).check(states.data(), kStates).valid;
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    BatchCheckerOptions options;
    options.traversal = traversal;
    options.cpu_below = 0;
    options.max_batch = below(2) == 0 ? 16384 : 64;
    EXPECT_EQ(BatchChecker(made, options).check(states.data(), kStates).valid, expected)
        << "seed " << GetParam() << ", " << made->robot->links().size() << " links, " << made->objects.size()
        << " objects";
  }
  std::cout << "seed " << GetParam() << ": " << made->robot->links().size() << " links, " << width << " variables, "
            << made->objects.size() << " objects, " << std::count(expected.begin(), expected.end(), 1) << " of "
            << kStates << " free" << std::endl;
}
TEST_P(RandomRobots, AreFreeInAllThatIsFreeAroundAState)
{
  constexpr std::size_t kNeighbours = 40;
  const auto made = scene();
  const RobotModel& robot = *made->robot;
  const std::size_t width = robot.variables().size();
  const std::vector<double> states = randomStates(robot);
  const Surroundings around = surroundings(robot);
  CpuChecker checker(made);
  const std::vector<std::uint8_t> proven = checker.check(states.data(), kStates, "", &around).valid;
  std::vector<double> neighbours;
  for (std::size_t i = 0; i < kStates; ++i)
    for (std::size_t k = 0; proven[i] != 0 && k < kNeighbours; ++k)
    {
      neighbours.insert(neighbours.end(), &states[i * width], &states[(i + 1) * width]);
      moveWithin(robot, &around.ways[around.rows[i] * robot.joints().size()], &neighbours[neighbours.size() - width]);
    }
  const std::vector<std::uint8_t> free = checker.check(neighbours.data(), neighbours.size() / width).valid;
  EXPECT_EQ(std::count(free.begin(), free.end(), 0), 0) << "seed " << GetParam();
  const std::vector<std::uint8_t> plain = checker.check(states.data(), kStates).valid;
  for (std::size_t i = 0; i < kStates; ++i)
    EXPECT_LE(proven[i], plain[i]) << "seed " << GetParam() << ", state " << i;
  std::cout << "seed " << GetParam() << ": " << std::count(plain.begin(), plain.end(), 1) << " free, "
            << std::count(proven.begin(), proven.end(), 1) << " with what is around" << std::endl;
}

TEST_P(RandomRobots, AreAsFreeAroundAStateOnTheGpuAsOnTheCpu)
{
  const auto made = scene();
  const std::vector<double> states = randomStates(*made->robot);
  const Surroundings around = surroundings(*made->robot);
  const std::vector<std::uint8_t> expected = CpuChecker(made).check(states.data(), kStates, "", &around).valid;
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    BatchCheckerOptions options;
    options.traversal = traversal;
    options.cpu_below = 0;
    options.max_batch = below(2) == 0 ? 16384 : 64;
    BatchChecker checker(made, options);
    const std::vector<std::uint8_t> plain = checker.check(states.data(), kStates).valid;
    EXPECT_EQ(checker.check(states.data(), kStates, "", &around).valid, expected) << "seed " << GetParam();
    EXPECT_EQ(checker.check(states.data(), kStates).valid, plain) << "after margins, seed " << GetParam();
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRobots, testing::Range<std::uint64_t>(0, 16));
}  // namespace
}  // namespace gpu_planning_scene
