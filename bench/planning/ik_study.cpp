// ik_study: inverse kinematics of real arms, for poses that collision-free random states reach. KDL's solver stands
// beside it where KDL is found. See --help.

#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/collision_free_ik.h"
#include "planning/arm_study.h"
#include "scene/frame.h"
#ifdef GPS_HAS_KDL
#include "planning/kdl_peer.h"
#endif

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr double kTolerance = 1e-6;  // metres and radians

/// A free state in which the base stands at the origin. The joints outside the group keep its values.
std::vector<double> freeState(const Arm& arm, StateChecker& checker, std::mt19937_64& generator)
{
  const std::vector<double> base = arm.robot->defaultState();
  std::vector<double> state(base.size());
  do
    arm.robot->randomState(generator, base.data(), state.data());
  while (checker.check(state.data(), 1, arm.group).valid.front() == 0);
  return state;
}

/// Random states of the group without collision, and the poses of the tip in them.
struct Poses
{
  std::vector<std::vector<double>> states;
  std::vector<Eigen::Isometry3d> poses;
};

Poses randomPoses(const Arm& arm, int tip, StateChecker& checker, std::size_t count, const std::vector<double>& other,
                  std::mt19937_64& generator)
{
  Poses poses;
  const std::vector<int>& variables = arm.robot->group(arm.group).variables;
  std::vector<double> random(other.size());
  while (poses.states.size() < count)
  {
    arm.robot->randomState(generator, random.data());
    std::vector<double> state = other;
    for (const int variable : variables)
      state[static_cast<std::size_t>(variable)] = random[static_cast<std::size_t>(variable)];
    if (checker.check(state.data(), 1, arm.group).valid.front() == 0)
      continue;
    poses.poses.push_back(linkPose(*arm.robot, tip, state.data()));
    poses.states.push_back(std::move(state));
  }
  return poses;
}

/// The faults of a solution, by plain forward kinematics.
struct Faults
{
  std::size_t solved = 0;
  std::size_t off_pose = 0;
  std::size_t off_limits = 0;
  std::size_t colliding = 0;
  double largest_error = 0.0;
};

void judge(const Arm& arm, int tip, StateChecker& checker, const Eigen::Isometry3d& pose,
           const std::vector<double>& state, Faults& faults)
{
  ++faults.solved;
  const Eigen::Isometry3d reached = linkPose(*arm.robot, tip, state.data());
  const double distance = (reached.translation() - pose.translation()).norm();
  const double angle = Eigen::AngleAxisd(pose.linear().transpose() * reached.linear()).angle();
  faults.largest_error = std::max({faults.largest_error, distance, angle});
  faults.off_pose += distance > kTolerance || angle > kTolerance ? 1 : 0;
  const std::vector<Variable>& variables = arm.robot->variables();
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].bounded && (state[i] < variables[i].lower || state[i] > variables[i].upper))
    {
      ++faults.off_limits;
      break;
    }
  faults.colliding += checker.check(state.data(), 1, arm.group).valid.front() == 0 ? 1 : 0;
}

void studyArm(const Arm& arm, std::size_t count, std::uint64_t seed, CsvTable& table)
{
  const int tip = tipOf(*arm.robot, arm.robot->group(arm.group));
  auto scene = std::make_shared<PlanningScene>(arm.robot);
  scene->current_state = arm.robot->defaultState();
  const auto checker = std::make_shared<CpuChecker>(scene, CheckerOptions());
  std::mt19937_64 generator(seed);
  const std::vector<double> given = freeState(arm, *checker, generator);
  const Poses poses = randomPoses(arm, tip, *checker, count, given, generator);
  std::vector<KinematicConstraints> goals;
  for (const Eigen::Isometry3d& pose : poses.poses)
    goals.push_back(KinematicConstraints::pose(tip, Eigen::Isometry3d::Identity(), pose, kTolerance, kTolerance));
  CollisionFreeIkOptions options;

  const auto report =
      [&](const std::string& solver, const Faults& faults, const std::vector<double>& seconds, double per_thousand)
  {
    table.add({arm.name, solver, count, faults.solved, faults.off_pose, faults.off_limits, faults.colliding,
               faults.largest_error, 1e6 * median(seconds), 1e6 * percentile(seconds, 0.95), 1e3 * per_thousand});
    std::cout << arm.name << ", " << solver << ": " << faults.solved << " of " << count << " solved, "
              << faults.off_pose << " off the pose, " << faults.off_limits << " outside limits, " << faults.colliding
              << " colliding, largest error " << faults.largest_error << ", median " << 1e6 * median(seconds)
              << " us, 95 % " << 1e6 * percentile(seconds, 0.95) << " us, 1000 poses " << 1e3 * per_thousand << " ms"
              << std::endl;
  };

  std::vector<double> seconds;
  Faults faults;
  for (std::size_t i = 0; i < goals.size(); ++i)
  {
    const Stopwatch watch;
    const auto results = solveCollisionFree(*scene, *checker, arm.group, {goals[i]}, given, options);
    seconds.push_back(watch.seconds());
    if (results.front().status == IkStatus::Solved)
      judge(arm, tip, *checker, poses.poses[i], results.front().states.front(), faults);
  }
  const std::vector<KinematicConstraints> thousand(
      goals.begin(), goals.begin() + std::min<std::ptrdiff_t>(1000, static_cast<std::ptrdiff_t>(count)));
  const double batch = secondsOf([&] { solveCollisionFree(*scene, *checker, arm.group, thousand, given, options); });
  report("gpu_planning_scene", faults, seconds, batch * 1000.0 / static_cast<double>(thousand.size()));

#ifdef GPS_HAS_KDL
  if (arm.root.empty())
    return;
  KdlPeer kdl(*arm.robot, arm.urdf, arm.root, tip);
  std::vector<double> kdl_seconds;
  Faults kdl_faults;
  for (std::size_t i = 0; i < goals.size(); ++i)
  {
    const Stopwatch watch;
    const std::optional<std::vector<double>> state =
        kdl.solve(poses.poses[i], given, kTolerance, options.ik.max_attempts);
    kdl_seconds.push_back(watch.seconds());
    if (state)
      judge(arm, tip, *checker, poses.poses[i], *state, kdl_faults);
  }
  report("KDL", kdl_faults, kdl_seconds, std::nan(""));
#endif
}

void study(const CommandLine& arguments)
{
  const std::size_t count = arguments.count("--poses", 10000, 1, 1000000);
  const ArmStudySettings settings(arguments);
  CsvTable table(settings.out, "ik.csv",
                 {"arm", "solver", "poses", "solved", "off_pose", "off_limits", "colliding", "largest_error",
                  "median_us", "p95_us", "ms_per_1000"});
  for (const Arm& arm : settings.arms)
    studyArm(arm, count, settings.seed, table);
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  return runTool(
      {"ik_study", "[--poses N] [options]",
       "Solves inverse kinematics for poses that collision-free random states of real arms reach, and judges "
       "the solutions by plain forward kinematics, limits and the checker.",
       benchmark::ArmStudySettings::options({"--poses", "N", "poses per arm (10000)"}), benchmark::study},
      argc, argv);
}
