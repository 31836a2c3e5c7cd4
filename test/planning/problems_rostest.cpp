// Plans the problems of ../shared through ~plan, for one client and then for two at once. Each path must have the right
// ends, and the exact checker must find it free at a tenth of the resolution that it was planned with. ~problems:
// number of problems (default: one of each set); ~planner: as in the request.

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include <gpu_planning_scene/PlanMotion.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "node/messages/messages.h"
#include "node/messages/to_messages.h"
#include "node/persistent_call.h"
#include "support/planning_problems.h"
#include "support/states_along.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kTime = 60.0;  // seconds: sanitizers and other tests slow the node

std::string nameOf(const std::string& service)
{
  return "/planning_scene/" + service;
}

void apply(const PlanningProblem& problem)
{
  ApplyPlanningScene call;
  const std::vector<bool> known(problem.start.size(), true);
  call.request.scene = messageOf(*problem.scene, 0, problem.start, known);
  ASSERT_TRUE(callPersistently(nameOf("apply_planning_scene"), call));
  ASSERT_TRUE(call.response.success) << problem.name << ": " << call.response.message;
}

PlanMotion::Response plan(const PlanningProblem& problem)
{
  PlanMotion call;
  const RobotModel& robot = *problem.scene->robot;
  call.request.group = problem.group;
  for (const int variable : robot.group(problem.group).variables)
  {
    const auto i = static_cast<std::size_t>(variable);
    call.request.start_names.push_back(robot.variables()[i].name);
    call.request.start.push_back(problem.start[i]);
    call.request.goals.push_back(problem.goal[i]);
  }
  call.request.goal_names = call.request.start_names;
  call.request.allowed_planning_time = kTime;
  call.request.simplify = true;
  ros::NodeHandle("~").getParam("planner", call.request.planner);
  EXPECT_TRUE(callPersistently(nameOf("plan"), call)) << problem.name;
  return call.response;
}

/// Number of states of the path that collide.
std::size_t collisionsOf(const PlanningProblem& problem, const PlanMotion::Response& response, CpuChecker& exact)
{
  const RobotModel& robot = *problem.scene->robot;
  const Group& group = robot.group(problem.group);
  std::vector<std::vector<double>> rows;
  for (const trajectory_msgs::JointTrajectoryPoint& point : response.trajectory.points)
  {
    rows.push_back(problem.start);
    for (std::size_t i = 0; i < group.variables.size(); ++i)
      rows.back()[static_cast<std::size_t>(group.variables[i])] = point.positions[i];
  }
  const std::vector<double> states = statesAlong(robot, rows);
  const auto valid = exact.check(states.data(), states.size() / problem.start.size(), problem.group).valid;
  return static_cast<std::size_t>(std::count(valid.begin(), valid.end(), 0));
}

void expectPath(const PlanningProblem& problem, const PlanMotion::Response& response, CpuChecker& exact)
{
  ASSERT_TRUE(response.success) << problem.name << ": " << response.message;
  const std::vector<int>& variables = problem.scene->robot->group(problem.group).variables;
  for (std::size_t i = 0; i < variables.size(); ++i)
  {
    const auto variable = static_cast<std::size_t>(variables[i]);
    EXPECT_EQ(response.trajectory.points.front().positions[i], problem.start[variable]) << problem.name;
    EXPECT_EQ(response.trajectory.points.back().positions[i], problem.goal[variable]) << problem.name;
  }
  EXPECT_EQ(collisionsOf(problem, response, exact), 0u) << problem.name;
}

TEST(ProblemsOverRos, AreSolvedForOneClientAndForTwoAtOnce)
{
  std::vector<std::string> names = planningProblemNames();
  ASSERT_FALSE(names.empty()) << planningProblemFolder() << " is missing";
  const auto wanted = static_cast<std::size_t>(ros::NodeHandle("~").param("problems", 7));
  const std::size_t count = std::min(wanted, names.size());
  ASSERT_TRUE(ros::service::waitForService(nameOf("check_states"), ros::Duration(120.0)));
  std::unique_ptr<CpuChecker> exact;
  std::vector<double> alone;
  std::vector<double> together;
  const auto timed = [](std::vector<double>& seconds, const auto& work)
  {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(secondsSince(start));
  };
  for (std::size_t i = 0; i < count; ++i)
  {
    const PlanningProblem problem = loadPlanningProblem(names[i * names.size() / count]);
    if (exact)
      exact->setScene(problem.scene);
    else
      exact = std::make_unique<CpuChecker>(problem.scene);
    apply(problem);
    PlanMotion::Response responses[3];
    timed(
        alone, [&] { responses[0] = plan(problem); });
    timed(together,
          [&]
          {
            std::thread other([&] { responses[1] = plan(problem); });
            responses[2] = plan(problem);
            other.join();
          });
    for (const PlanMotion::Response& response : responses)
      expectPath(problem, response, *exact);
  }
  for (std::vector<double>* seconds : {&alone, &together})
  {
    std::sort(seconds->begin(), seconds->end());
    std::cout << (seconds == &alone ? "alone: " : "two at once: ") << seconds->size() << " problems, median "
              << seconds->at(seconds->size() / 2) << " s, 95 % " << seconds->at(seconds->size() * 95 / 100)
              << " s, longest " << seconds->back() << " s" << std::endl;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
