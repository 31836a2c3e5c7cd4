#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/proofs/robot_proofs.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The limits of the joints of slidingBalls, in metres: from the negative to the positive.
constexpr double kSlide = 0.6;

/// Two balls that slide, and one at rest, among one object of each kind.
inline std::shared_ptr<PlanningScene> slidingBalls()
{
  const auto link = [](const std::string& name, const std::string& radius)
  {
    return "<link name='" + name + "'><collision><geometry><sphere radius='" + radius +
           "'/></geometry></collision></link>";
  };
  const auto joint =
      [](const std::string& type, const std::string& parent, const std::string& child, const std::string& inside)
  {
    return "<joint name='to_" + child + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
           "'/>" + inside + "<limit lower='-0.6' upper='0.6' effort='1' velocity='1'/></joint>";
  };
  const auto robot = RobotModel::fromXml(
      "<robot name='sliding_balls'><link name='base'/><link name='slide'/>" + link("large", "0.12") +
          link("small", "0.07") + link("fixed", "0.09") + joint("prismatic", "base", "slide", "<axis xyz='1 0 0'/>") +
          joint("prismatic", "slide", "large", "<axis xyz='0 1 0'/>") +
          joint("prismatic", "base", "small", "<axis xyz='0.6 0.2 0.5'/>") +
          joint("fixed", "base", "fixed", "<origin xyz='-0.3 0.05 0'/>") + "</robot>",
      "", {});
  auto scene = std::make_shared<PlanningScene>(robot);
  const auto add = [&scene](const std::string& id, const Shape& shape, double x, double y, double padding)
  {
    const Eigen::Isometry3d tilted(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
    scene->objects.push_back(
        {id, Eigen::Translation3d(x, y, 0.0) * tilted, {{shape, Eigen::Isometry3d::Identity()}}, padding});
  };
  add("box", Box{{0.2, 0.3, 0.1}}, 0.4, 0.4, 0.0);
  add("ball", Sphere{0.1}, -0.5, 0.4, 0.0);
  add("can", Cylinder{0.1, 0.3}, 0.4, -0.5, 0.0);
  add("cone", Cone{0.1, 0.3}, -0.4, -0.5, 0.0);
  auto stone = std::make_shared<Mesh>(*tessellate(Box{{0.15, 0.1, 0.1}}).mesh);
  for (Eigen::Vector3d& vertex : stone->vertices)
    vertex.y() += 0.2;
  add("stone", std::shared_ptr<const Mesh>(stone), 0.1, 0.3, 0.0);
  add("padded", Cylinder{0.05, 0.2}, 0.0, -0.5, 0.03);
  return scene;
}

/// A cover of one ball around the origin, whose enclosing ball has no layer.
inline std::shared_ptr<const BallCover> ballCover(double outer, double layer, double inner)
{
  const CoverBall ball{Eigen::Vector3d::Zero(), outer, Eigen::Vector3d::Zero(), inner};
  auto cover = std::make_shared<BallCover>();
  cover->levels.fill({ball});
  cover->levels.front().front().outer = outer + layer;
  cover->layer = layer;
  return cover;
}

/// Covers of the balls that are exactly the balls, so that small errors of radii and distances change verdicts. The
/// large ball is the sum of a ball and a layer.
inline std::vector<std::shared_ptr<const BallCover>> exactCovers(const CollisionProblem& problem,
                                                                 const RobotModel& robot)
{
  std::vector<std::shared_ptr<const BallCover>> covers;
  for (const ShapeInstance& instance : problem.robot)
  {
    const std::string& link = robot.links()[static_cast<std::size_t>(instance.link)].name;
    covers.push_back(link == "large"   ? ballCover(0.01, 0.11, 0.12)
                     : link == "small" ? ballCover(0.07, 0.0, 0.07)
                                       : ballCover(0.09, 0.0, 0.09));
  }
  return covers;
}
}  // namespace gpu_planning_scene::core
