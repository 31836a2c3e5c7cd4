// Robots and worlds made at random - all joint types, several shapes a link, meshes and solids, few objects and
// hundreds - on the GPU against the CPU: every traversal gives the CPU's verdicts.

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

  std::mt19937_64 generator_{GetParam()};
  std::shared_ptr<const Mesh> mesh_;
};

TEST_P(RandomRobots, HaveTheVerdictsOfTheCpuOnTheGpu)
{
  const auto made = scene();
  const std::size_t width = made->robot->variables().size();
  std::vector<double> states(kStates * width);
  for (std::size_t i = 0; i < kStates; ++i)
  {
    made->robot->randomState(generator_, &states[i * width]);
  }
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
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRobots, testing::Range<std::uint64_t>(0, 16));
}  // namespace
}  // namespace gpu_planning_scene
