// line_study: paths of real arms along random straight lines among random boxes, judged at ten times the resolution.
// See --help.

#include <algorithm>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/cartesian_path.h"
#include "planning/arm_study.h"
#include "scene/frame.h"
#include "support/states_along.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr double kLongestLine = 0.4;      // metres
constexpr double kLargestRotation = 0.8;  // radians
constexpr std::size_t kBoxes = 12;

class Random
{
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  std::mt19937_64& generator() { return generator_; }
  double within(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(generator_); }
  Eigen::Vector3d direction()
  {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }

 private:
  std::mt19937_64 generator_;
};

/// Boxes around the arm, none of which touches it in its default state.
std::shared_ptr<const PlanningScene> sceneOf(const Arm& arm, Random& random)
{
  auto scene = std::make_shared<PlanningScene>(arm.robot);
  scene->current_state = arm.robot->defaultState();
  const int tip = tipOf(*arm.robot, arm.robot->group(arm.group));
  std::vector<double> state(scene->current_state);
  for (std::size_t i = 0; i < kBoxes; ++i)
  {
    arm.robot->randomState(random.generator(), scene->current_state.data(), state.data());
    WorldObject box;
    box.id = "box" + std::to_string(i);
    box.pose.translation() = linkPose(*arm.robot, tip, state.data()).translation();
    box.shapes.push_back({Box{Eigen::Vector3d::Constant(random.within(0.02, 0.15))}, Eigen::Isometry3d::Identity()});
    scene->objects.push_back(box);
  }
  return scene;
}

struct Findings
{
  std::size_t lines = 0;
  std::size_t whole = 0;  // followed to their end
  double largest_deviation = 0.0;
  double largest_joint_step = 0.0;
  std::size_t states = 0;
  std::size_t colliding = 0;
  std::vector<double> seconds;
  std::map<std::string, std::size_t> faults;
};

/// The distance of a point from a segment.
double distanceFrom(const Eigen::Vector3d& point, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  const Eigen::Vector3d along = to - from;
  const double fraction = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - fraction * along).norm();
}

/// The first words of a message, without names.
std::string kindOf(const std::string& message)
{
  for (const char* const kind : {"collision of", "the pose is not reached", "joint '", "the joints would leave"})
    if (message.rfind(kind, 0) == 0)
      return kind;
  return message;
}

void judge(const Arm& arm, int tip, StateChecker& checker, const CartesianQuery& query, const CartesianPath& path,
           Findings& findings)
{
  const RobotModel& robot = *arm.robot;
  const Eigen::Vector3d from = linkPose(robot, tip, query.start.data()).translation();
  const Eigen::Vector3d to = query.waypoints.front().translation();
  for (std::size_t i = 1; i < path.rows.size(); ++i)
    for (const JointTravel& travel : jointTravel(robot, path.rows[i - 1].data(), path.rows[i].data()))
      findings.largest_joint_step = std::max({findings.largest_joint_step, travel.angle, travel.length});
  const std::vector<double> states = statesAlong(robot, path.rows);
  const std::size_t width = robot.variables().size();
  for (std::size_t i = 0; i < states.size(); i += width)
    findings.largest_deviation =
        std::max(findings.largest_deviation, distanceFrom(linkPose(robot, tip, &states[i]).translation(), from, to));
  const std::size_t count = states.size() / width;
  if (count == 0)
    return;
  for (const std::uint8_t valid : checker.check(states.data(), count, arm.group).valid)
    findings.colliding += valid == 0 ? 1 : 0;
  findings.states += count;
}

void studyArm(const Arm& arm, std::size_t count, std::uint64_t seed, CsvTable& table)
{
  Random random(seed);
  const std::shared_ptr<const PlanningScene> scene = sceneOf(arm, random);
  const auto checker = std::make_shared<CpuChecker>(scene, CheckerOptions());
  const int tip = tipOf(*arm.robot, arm.robot->group(arm.group));
  Findings findings;
  std::vector<double> state(arm.robot->variables().size());
  while (findings.lines < count)
  {
    arm.robot->randomState(random.generator(), scene->current_state.data(), state.data());
    if (checker->check(state.data(), 1, arm.group).valid.front() == 0)
      continue;
    CartesianQuery query;
    query.group = arm.group;
    query.link = tip;
    query.start = state;
    Eigen::Isometry3d goal = linkPose(*arm.robot, tip, state.data());
    goal.translation() += random.within(0.05, kLongestLine) * random.direction();
    goal.linear() = Eigen::AngleAxisd(random.within(0.0, kLargestRotation), random.direction()) * goal.linear();
    query.waypoints = {goal};
    const Stopwatch watch;
    const CartesianPath path = followLines(scene, checker, query);
    findings.seconds.push_back(watch.seconds());
    ++findings.lines;
    findings.whole += path.fraction == 1.0 ? 1 : 0;
    ++findings.faults[kindOf(path.message)];
    judge(arm, tip, *checker, query, path, findings);
  }
  table.add({arm.name, findings.lines, findings.whole, findings.largest_deviation, findings.largest_joint_step,
             findings.states, findings.colliding, 1e3 * median(findings.seconds)});
  std::cout << arm.name << ": " << findings.whole << " of " << findings.lines << " lines to their end, deviation "
            << findings.largest_deviation << " m, joint step " << findings.largest_joint_step << ", "
            << findings.colliding << " of " << findings.states << " states collide, median "
            << 1e3 * median(findings.seconds) << " ms, 95 % " << 1e3 * percentile(findings.seconds, 0.95) << " ms"
            << std::endl;
  for (const auto& [fault, number] : findings.faults)
    std::cout << "  " << number << " x " << (fault.empty() ? "whole" : fault) << std::endl;
}

void study(const CommandLine& arguments)
{
  const std::size_t count = arguments.count("--lines", 1000, 1, 1000000);
  const ArmStudySettings settings(arguments);
  CsvTable table(settings.out, "lines.csv",
                 {"arm", "lines", "whole", "deviation", "joint_step", "states", "colliding", "median_ms"});
  for (const Arm& arm : settings.arms)
    studyArm(arm, count, settings.seed, table);
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  return runTool({"line_study", "[--lines N] [options]",
                  "Follows random straight lines with the tips of real arms among random boxes, and judges the paths "
                  "at ten times the resolution: deviation from the line, largest joint step, collisions.",
                  benchmark::ArmStudySettings::options({"--lines", "N", "lines per arm (1000)"}), benchmark::study},
                 argc, argv);
}
