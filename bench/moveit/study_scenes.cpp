#include "moveit/study_scenes.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include <geometric_shapes/shape_operations.h>
#include <moveit/utils/robot_model_test_utils.h>
#include <octomap/OcTree.h>
#include <srdfdom/model.h>
#include <urdf_parser/urdf_parser.h>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"

namespace gpu_planning_scene
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

class Random
{
 public:
  explicit Random(unsigned seed) : generator_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }

  /// A place around the robot, at least `nearest` from its axis.
  Isometry3d pose(double nearest)
  {
    std::normal_distribution<double> normal;
    const double angle = between(-M_PI, M_PI);
    const double radius = between(nearest, nearest + 0.75);
    Eigen::Quaterniond rotation(normal(generator_), normal(generator_), normal(generator_), normal(generator_));
    Isometry3d pose(rotation.normalized());
    pose.translation() = Vector3d(radius * std::cos(angle), radius * std::sin(angle), between(0.0, 1.4));
    return pose;
  }

 private:
  std::mt19937_64 generator_;
};

/// The radius of the robot's base.
double baseRadius(const planning_scene::PlanningScene& scene)
{
  return scene.getRobotModel()->getName() == "pr2" ? 0.75 : 0.35;
}

shapes::ShapeConstPtr meshFile(const std::string& name)
{
  const std::string path = "package://moveit_resources_panda_description/meshes/collision/" + name + ".stl";
  shapes::ShapeConstPtr mesh(shapes::createMeshFromResource(path));
  if (!mesh)
    throw std::runtime_error("cannot read " + path + "; is the folder of MoveIt's test robots in ROS_PACKAGE_PATH?");
  return mesh;
}

std::string contentOf(const std::string& path)
{
  std::ifstream file(path);
  if (!file)
    throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The matrix of the test robot pr2 lacks pairs that always collide.
void allowCollidingPairs(planning_scene::PlanningScene& scene)
{
  collision_detection::CollisionRequest request;
  request.contacts = true;
  request.max_contacts = 1000000;
  collision_detection::CollisionResult result;
  scene.checkCollision(request, result);
  for (const auto& [pair, contacts] : result.contacts)
    scene.getAllowedCollisionMatrixNonConst().setEntry(pair.first, pair.second, true);
}
}  // namespace

namespace
{
/// MoveIt only logs an error if it cannot read a mesh. Without meshes, hardly anything collides.
void requireAllShapes(const urdf::ModelInterface& urdf, const moveit::core::RobotModel& robot)
{
  for (const auto& [name, link] : urdf.links_)
    if (robot.getLinkModel(name)->getShapes().size() != link->collision_array.size())
      throw std::runtime_error("link '" + name +
                               "' lacks collision shapes; is the folder of its meshes in ROS_PACKAGE_PATH?");
}
}  // namespace

moveit::core::RobotModelPtr loadStudyRobot(const std::string& name)
{
  if (name != "ur5_robotiq")
  {
    moveit::core::RobotModelPtr robot = moveit::core::loadTestingRobotModel(name);
    if (!robot)
      throw std::runtime_error("no robot '" + name + "'");
    return robot;
  }
  const std::string folder = std::string(GPS_SHARED_DIR) + "/robots/ur5_robotiq/";
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(contentOf(folder + "urdf/ur5.urdf"));
  const auto srdf = std::make_shared<srdf::Model>();
  if (!urdf || !srdf->initString(*urdf, contentOf(folder + "srdf/ur5.srdf")))
    throw std::runtime_error("cannot load the robot in " + folder);
  auto robot = std::make_shared<moveit::core::RobotModel>(urdf, srdf);
  requireAllShapes(*urdf, *robot);
  return robot;
}

planning_scene::PlanningScenePtr makeStudyScene(const moveit::core::RobotModelPtr& robot, bool ours)
{
  auto scene = std::make_shared<planning_scene::PlanningScene>(robot);  // has FCL's detector
  moveit::core::RobotState& state = scene->getCurrentStateNonConst();
  state.setToDefaultValues();
  state.update();
  allowCollidingPairs(*scene);
  const auto with_ours = scene->diff();
  with_ours->setActiveCollisionDetector(detector::CollisionDetectorAllocator::create(), true);
  allowCollidingPairs(*with_ours);
  scene->getAllowedCollisionMatrixNonConst() = with_ours->getAllowedCollisionMatrix();
  if (ours)
    scene->setActiveCollisionDetector(detector::CollisionDetectorAllocator::create(), true);
  return scene;
}

void addStudyObjects(planning_scene::PlanningScene& scene, int count, unsigned seed, bool as_meshes)
{
  Random random(seed);
  const std::array<shapes::ShapeConstPtr, 2> meshes = {meshFile("hand"), meshFile("link5")};
  for (int i = 0; i < count; ++i)
  {
    const double size = random.between(0.05, 0.2);
    const double length = random.between(0.05, 0.3);
    shapes::ShapeConstPtr shape;
    switch (i % 6)
    {
      case 0:
        shape = std::make_shared<shapes::Box>(size, length, 0.1);
        break;
      case 1:
        shape = std::make_shared<shapes::Sphere>(0.5 * size);
        break;
      case 2:
        shape = std::make_shared<shapes::Cylinder>(0.4 * size, length);
        break;
      case 3:
        shape = std::make_shared<shapes::Cone>(0.5 * size, length);
        break;
      default:
        shape = meshes[static_cast<std::size_t>(i % 2)];
    }
    if (as_meshes && shape->type != shapes::MESH)
      shape.reset(shapes::createMeshFromShape(shape.get()));
    scene.getWorldNonConst()->addToObject("object" + std::to_string(i), random.pose(baseRadius(scene)), shape,
                                          Isometry3d::Identity());
  }
}

void addStudyOctomap(planning_scene::PlanningScene& scene, int cells, unsigned seed)
{
  Random random(seed);
  const auto octree = std::make_shared<octomap::OcTree>(0.05);
  for (int i = 0; i < cells; ++i)
  {
    const Vector3d place = random.pose(baseRadius(scene)).translation();
    octree->updateNode(
        octomap::point3d(static_cast<float>(place.x()), static_cast<float>(place.y()), static_cast<float>(place.z())),
        true);
  }
  scene.processOctomapPtr(octree, Isometry3d::Identity());
}

void attachStudyTool(moveit::core::RobotState& state)
{
  const auto& robot = *state.getRobotModel();
  for (const char* name : {"panda_hand", "r_gripper_palm_link", "wrist_3_link"})
  {
    if (!robot.hasLinkModel(name))
      continue;
    const std::vector<shapes::ShapeConstPtr> shapes = {std::make_shared<shapes::Box>(0.05, 0.05, 0.2),
                                                       meshFile("finger")};
    const EigenSTL::vector_Isometry3d poses = {Isometry3d(Eigen::Translation3d(0, 0, 0.15)),
                                               Isometry3d(Eigen::Translation3d(0.1, 0, 0.1))};
    std::vector<std::string> touch = {name};
    for (const moveit::core::LinkModel* link : robot.getLinkModels())
      if (link->getName().find("finger") != std::string::npos || link->getName().find("gripper") != std::string::npos ||
          link->getName().find("robotiq") != std::string::npos)
        touch.push_back(link->getName());
    state.attachBody("tool", Isometry3d::Identity(), shapes, poses, touch, name);
    state.update();
    return;
  }
  throw std::runtime_error("no link to attach a tool to");
}

void randomizeState(moveit::core::RobotState& state, random_numbers::RandomNumberGenerator& random)
{
  state.setToRandomPositions(random);
  state.update();
}
}  // namespace gpu_planning_scene
