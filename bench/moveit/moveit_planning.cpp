// moveit_planning [PROBLEMS] [SECONDS]: solves planning problems of ../shared through MoveIt's classes with this
// package's planner plugin, and without MoveIt by the same planner, as ~plan does. The two take turns. MoveIt's FCL
// detector checks the paths at 2 mrad.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <moveit/kinematic_constraints/utils.h>
#include <moveit/planning_interface/planning_interface.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ompl/util/Console.h>
#include <ros/console.h>
#include <pluginlib/class_loader.hpp>

#include "base/seconds_since.h"
#include "benchmark/statistics.h"
#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/moveit/collision_detector_allocator.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "moveit/moveit_resources.h"
#include "moveit/study_scenes.h"
#include "service/checker_maker.h"
#include "service/checker_pool.h"
#include "support/planning_problems.h"

namespace gpu_planning_scene
{
namespace
{
using Clock = std::chrono::steady_clock;
using core::PlanningProblem;
using moveit::core::RobotState;

shapes::ShapeConstPtr moveitShape(const core::Shape& shape)
{
  if (const auto* box = std::get_if<core::Box>(&shape))
    return std::make_shared<shapes::Box>(box->size.x(), box->size.y(), box->size.z());
  if (const auto* sphere = std::get_if<core::Sphere>(&shape))
    return std::make_shared<shapes::Sphere>(sphere->radius);
  if (const auto* cylinder = std::get_if<core::Cylinder>(&shape))
    return std::make_shared<shapes::Cylinder>(cylinder->radius, cylinder->length);
  if (const auto* cone = std::get_if<core::Cone>(&shape))
    return std::make_shared<shapes::Cone>(cone->radius, cone->length);
  if (const auto* half_space = std::get_if<core::HalfSpace>(&shape))
    return std::make_shared<shapes::Plane>(half_space->normal.x(), half_space->normal.y(), half_space->normal.z(),
                                           -half_space->offset);
  const core::Mesh& mesh = *std::get<std::shared_ptr<const core::Mesh>>(shape);
  const auto made = std::make_shared<shapes::Mesh>(mesh.vertices.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      made->vertices[3 * i + static_cast<std::size_t>(axis)] = mesh.vertices[i][axis];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    std::copy(mesh.triangles[i].begin(), mesh.triangles[i].end(), made->triangles + 3 * i);
  return made;
}

RobotState stateOf(const PlanningProblem& problem, const std::vector<double>& row,
                   const moveit::core::RobotModelPtr& robot)
{
  RobotState state(robot);
  state.setToDefaultValues();
  const auto& variables = problem.scene->robot->variables();
  for (std::size_t i = 0; i < variables.size(); ++i)
    state.setVariablePosition(variables[i].name, row[i]);
  state.update();
  return state;
}

/// The problem's scene in MoveIt, with MoveIt's FCL detector.
planning_scene::PlanningScenePtr moveitScene(const PlanningProblem& problem, const moveit::core::RobotModelPtr& robot)
{
  auto scene = std::make_shared<planning_scene::PlanningScene>(robot);
  if (!problem.scene->attached.empty())
    throw std::runtime_error(problem.name + " has attached objects, which this program does not convert");
  for (const core::WorldObject& object : problem.scene->objects)
    for (const core::PlacedShape& placed : object.shapes)
      scene->getWorldNonConst()->addToObject(object.id, object.pose, moveitShape(placed.shape), placed.pose);
  const core::AllowedCollisionMatrix& from = problem.scene->allowed_collisions;
  collision_detection::AllowedCollisionMatrix& matrix = scene->getAllowedCollisionMatrixNonConst();
  matrix.clear();
  const std::vector<std::string> listed = from.bodiesWithEntries();
  for (std::size_t i = 0; i < listed.size(); ++i)
    for (std::size_t j = i + 1; j < listed.size(); ++j)
      matrix.setEntry(listed[i], listed[j], from.allowed(listed[i], listed[j]));
  for (const std::string& body : from.bodies())
    if (const auto allowed = from.defaultOf(body))
      matrix.setDefaultEntry(body, *allowed);
  scene->setCurrentState(stateOf(problem, problem.start, robot));
  return scene;
}

/// The states of a path that MoveIt's FCL detector finds in collision.
struct PathCheck
{
  std::size_t states = 0;
  std::size_t colliding = 0;
  std::size_t near_contact = 0;  ///< of them: the exact distance is above 0 and below kNear

  void add(const robot_trajectory::RobotTrajectory& path, const planning_scene::PlanningScene& scene,
           const planning_scene::PlanningScene& exact)
  {
    constexpr double kStep = 2e-3;  // radians
    RobotState state = path.getFirstWayPoint();
    for (std::size_t i = 1; i < path.getWayPointCount(); ++i)
    {
      const RobotState& from = path.getWayPoint(i - 1);
      const RobotState& to = path.getWayPoint(i);
      double largest = 0.0;
      for (std::size_t k = 0; k < from.getVariableCount(); ++k)
        largest = std::max(largest, std::abs(from.getVariablePosition(static_cast<int>(k)) -
                                             to.getVariablePosition(static_cast<int>(k))));
      const double parts = std::max(1.0, std::ceil(largest / kStep));
      for (double part = 0.0; part < parts; ++part)
      {
        from.interpolate(to, part / parts, state);
        state.update();
        addState(state, path.getGroupName(), scene, exact);
      }
    }
  }

  void addState(const RobotState& state, const std::string& group, const planning_scene::PlanningScene& scene,
                const planning_scene::PlanningScene& exact)
  {
    constexpr double kNear = 1e-6;  // metres
    ++states;
    if (!scene.isStateColliding(state, group))
      return;
    ++colliding;
    collision_detection::CollisionRequest request;
    request.group_name = group;
    request.distance = true;
    collision_detection::CollisionResult result;
    exact.checkCollision(request, result, state);
    near_contact += !result.collision && result.distance < kNear ? 1 : 0;
  }
};

struct Times
{
  std::vector<double> seconds;
  std::size_t solved = 0;

  void add(bool is_solved, double time)
  {
    seconds.push_back(time);
    solved += is_solved ? 1 : 0;
  }

  void print(const std::string& name) const
  {
    constexpr double kMilliseconds = 1e3;
    std::cout << name << ": " << solved << " of " << seconds.size() << " solved, median "
              << kMilliseconds * core::benchmark::median(seconds) << " ms, 95 % "
              << kMilliseconds * core::benchmark::percentile(seconds, 0.95) << " ms\n";
  }
};

/// MoveIt only logs a mesh that it cannot read.
moveit::core::RobotModelPtr loadRobot()
{
  moveit::core::RobotModelPtr robot = loadStudyRobot("ur5_robotiq");
  for (const moveit::core::LinkModel* link : robot->getLinkModels())
    if (robot->getURDF()->getLink(link->getName())->collision && link->getShapes().empty())
      throw std::runtime_error("MoveIt has not read the mesh of link '" + link->getName() + "'");
  return robot;
}

void run(std::size_t count, double seconds)
{
  const moveit::core::RobotModelPtr robot = loadRobot();
  pluginlib::ClassLoader<planning_interface::PlannerManager> loader("moveit_core",
                                                                    "planning_interface::PlannerManager");
  const planning_interface::PlannerManagerPtr manager =
      loader.createUniqueInstance("gpu_planning_scene/PlannerManager");
  if (!manager->initialize(robot, "moveit_planning"))
    throw std::runtime_error("the planner cannot be initialised");
  core::CheckerPool pool(core::makeCheckers(core::BatchCheckerOptions(), core::openGpuDevice,
                                            [](const std::string& warning) { std::cerr << warning << '\n'; }));
  Times through_moveit;
  Times alone;
  PathCheck check;
  for (const std::string& name : core::chosenPlanningProblems(count))
  {
    const PlanningProblem problem = core::loadPlanningProblem(name);
    const planning_scene::PlanningScenePtr scene = moveitScene(problem, robot);
    planning_interface::MotionPlanRequest request;
    request.group_name = problem.group;
    request.allowed_planning_time = seconds;
    request.num_planning_attempts = 1;
    request.goal_constraints.push_back(kinematic_constraints::constructGoalConstraints(
        stateOf(problem, problem.goal, robot), robot->getJointModelGroup(problem.group)));
    planning_interface::MotionPlanResponse response;
    moveit_msgs::MoveItErrorCodes code;
    Clock::time_point begin = Clock::now();
    const auto context = manager->getPlanningContext(scene, request, code);
    const bool solved = context && context->solve(response);
    through_moveit.add(solved, core::secondsSince(begin));
    if (!solved)
      std::cout << name << ": MoveIt's error code " << (context ? response.error_code_.val : code.val) << '\n';
    else
    {
      const auto exact = scene->diff();
      exact->setActiveCollisionDetector(detector::CollisionDetectorAllocator::create(), true);
      check.add(*response.trajectory_, *scene, *exact);
    }

    core::PlanningQuery query;
    query.group = problem.group;
    query.start = problem.start;
    query.goals = {problem.goal};
    query.seconds = seconds;
    begin = Clock::now();
    core::CheckerPool::Lease lease(pool, problem.scene);
    const core::PlanningResult result =
        core::planMotion(problem.scene, lease.checker(), query, core::PlannerFactoryOf<core::BatchRrtConnect>());
    alone.add(result.status == core::PlanningStatus::Solved, core::secondsSince(begin));
    lease.giveBack();
    if (result.status != core::PlanningStatus::Solved)
      std::cout << name << ": " << result.message << '\n';
  }
  through_moveit.print("through MoveIt");
  alone.print("as ~plan");
  std::cout << "FCL: " << check.states << " states of the paths, " << check.colliding << " in collision, "
            << check.near_contact << " of them free by less than 1e-6 m\n";
}
}  // namespace
}  // namespace gpu_planning_scene

int main(int argc, char** argv)
{
  try
  {
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
    gpu_planning_scene::useMoveItResources();
    gpu_planning_scene::useBuiltPlugins(GPS_SHARED_DIR "/robots:");
    const long problems = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 140;
    const double seconds = argc > 2 ? std::strtod(argv[2], nullptr) : 10.0;
    if (argc > 3 || problems < 1 || !(seconds > 0.0))
      throw std::runtime_error("usage: moveit_planning [PROBLEMS] [SECONDS]");
    gpu_planning_scene::run(static_cast<std::size_t>(problems), seconds);
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
