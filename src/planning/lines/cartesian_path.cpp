#include "gpu_planning_scene/planning/cartesian_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/path_constraints.h"
#include "model/inverse_kinematics/kinematic_chains.h"
#include "model/joint_limits.h"
#include "model/rigid_pose.h"
#include "planning/lines/straight_lines.h"
#include "planning/space/group_space.h"
#include "planning/space/waypoints.h"
#include "scene/frame.h"

// Each row is the solution of inverse kinematics that is nearest to the row before it. A step is halved until the
// joints' straight motion between its rows keeps the frame close to the line, and no joint moves too much. R. H.
// Taylor: Planning and execution of straight line manipulator trajectories. IBM Journal of Research and Development
// 23(4), 1979 (bounded deviation joint paths).
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLeastDeviation = 1e-7;

// Rows are solved to this part of the deviation that is allowed between them.
constexpr double kAccuracy = 0.01;

// A step is halved this many times at most: to less than a hundredth.
constexpr int kMostHalvings = 7;

// Samples of the deviation within a step. It is the largest near the middle.
constexpr std::array<double, 3> kSamples = {0.25, 0.5, 0.75};

void requirePositive(double value, double least, const std::string& what)
{
  if (!(std::isfinite(value) && value > least))
    throw Error(what + " is " + numberText(value) + "; it must be above " + numberText(least));
}

void validate(const RobotModel& robot, const CartesianQuery& query)
{
  if (query.start.size() != robot.variables().size())
    throw Error("the start has " + std::to_string(query.start.size()) + " values; the robot has " +
                std::to_string(robot.variables().size()) + " variables");
  for (std::size_t i = 0; i < query.start.size(); ++i)
    if (!std::isfinite(query.start[i]))
      throw Error("the start: " + robot.variables()[i].name + " is not finite");
  if (query.link < 0 || static_cast<std::size_t>(query.link) >= robot.links().size())
    throw Error("the robot has no link " + std::to_string(query.link));
  if (query.waypoints.empty())
    throw Error("there is no waypoint; give at least one");
  requireHolonomic(robot, robot.group(query.group));
  requirePositive(query.max_step, 0.0, "the largest step");
  requirePositive(query.max_rotation_step, 0.0, "the largest rotation of a step");
  requirePositive(query.max_deviation, kLeastDeviation, "the largest deviation");
  requirePositive(query.max_rotation_deviation, kLeastDeviation, "the largest deviation of the orientation");
  requirePositive(query.max_joint_step, 0.0, "the largest step of a joint");
  ValuesOutsideLimits outside(robot);
  for (const int index : robot.group(query.group).variables)
  {
    const Variable& variable = robot.variables()[static_cast<std::size_t>(index)];
    const double value = query.start[static_cast<std::size_t>(index)];
    if (variable.bounded && (value < variable.lower || value > variable.upper))
      outside.add(index, value);
  }
  if (outside.count() != 0)
    throw Error("the start is out of bounds: " + outside.text());
}

class Follower
{
 public:
  Follower(std::shared_ptr<const RobotModel> robot, const CartesianQuery& query)
    : robot_(std::move(robot)),
      query_(query),
      lines_(posesOf(*robot_, query), {query.max_step, query.max_rotation_step},
             {query.max_deviation, query.max_rotation_deviation}, query.max_rows)
  {
    rows_.push_back(query.start);
    ats_.push_back(0.0);
  }

  /// Follows the lines as far as possible. Returns why the path ends early; empty if it does not.
  std::string run(const std::function<bool()>& stop)
  {
    for (const double at : lines_.steps())
    {
      if (stop && stop())
        return "the search was stopped";
      if (std::string fault = advance(at, 0); !fault.empty())
        return fault;
    }
    return "";
  }

  const std::vector<std::vector<double>>& rows() const { return rows_; }

  /// The part of the lines that the rows up to one of them follow.
  double fraction(std::size_t row) const { return ats_[row] / lines_.steps().back(); }

 private:
  static std::vector<Eigen::Isometry3d> posesOf(const RobotModel& robot, const CartesianQuery& query)
  {
    std::vector<Eigen::Isometry3d> ends = {linkPose(robot, query.link, query.start.data()) * query.frame};
    for (std::size_t i = 0; i < query.waypoints.size(); ++i)
      ends.push_back(nearestRigid(query.waypoints[i], "waypoint " + std::to_string(i)));
    return ends;
  }

  InverseKinematics kinematicsAt(double at) const
  {
    return InverseKinematics(
        robot_, query_.group,
        KinematicConstraints::pose(query_.link, query_.frame, lines_.pose(at), kAccuracy * query_.max_deviation,
                                   kAccuracy * query_.max_rotation_deviation));
  }

  /// Adds rows from the last one to the pose at `at`. Returns the fault if it is not reached.
  std::string advance(double at, int halvings)
  {
    if (rows_.size() >= query_.max_rows)
      return "the joints need more than " + std::to_string(query_.max_rows) +
             " states to follow the lines; take larger steps, larger deviations, or fewer waypoints";
    const InverseKinematics kinematics = kinematicsAt(at);
    std::vector<double> row = rows_.back();
    std::string fault;
    const bool is_reached = kinematics.project(row.data());
    // The descent may turn a joint by whole turns. A controller that interpolates numbers would drive them, unchecked.
    continueAngles(*robot_, rows_.back(), row);
    if (!is_reached)
      fault =
          "the pose is not reached: the nearest state is " + kinematics.violation(row.data()).text() + limitText(row);
    else if (fault = jumpOf(row); fault.empty() && deviates(kinematics, row, at))
      fault = "the joints would leave the line: a singularity or a joint limit is near" + limitText(row);
    if (fault.empty())
    {
      rows_.push_back(std::move(row));
      ats_.push_back(at);
      return "";
    }
    if (halvings == kMostHalvings)
      return fault;
    const double middle = 0.5 * (ats_.back() + at);
    if (std::string first = advance(middle, halvings + 1); !first.empty())
      return first;
    return advance(at, halvings + 1);
  }

  /// The joints at their limits, as an explanation.
  std::string limitText(const std::vector<double>& row) const
  {
    std::string names;
    for (const int index : robot_->group(query_.group).variables)
    {
      const Variable& variable = robot_->variables()[static_cast<std::size_t>(index)];
      const double value = row[static_cast<std::size_t>(index)];
      if (variable.bounded && (value <= variable.lower || value >= variable.upper))
        names += (names.empty() ? "; at their limits: " : ", ") + variable.name;
    }
    return names;
  }

  std::string jumpOf(const std::vector<double>& row) const
  {
    const std::vector<JointTravel> travel = jointTravel(*robot_, rows_.back().data(), row.data());
    for (std::size_t i = 0; i < travel.size(); ++i)
      if (const double by = std::max(travel[i].angle, travel[i].length); by > query_.max_joint_step)
        return "joint '" + robot_->joints()[i].name + "' would jump by " + numberText(by) +
               "; a singularity or the end of the reach is near (max_joint_step is " +
               numberText(query_.max_joint_step) + ")";
    return "";
  }

  bool deviates(const InverseKinematics& kinematics, const std::vector<double>& row, double at)
  {
    state_.resize(row.size());
    for (const double sample : kSamples)
    {
      interpolate(*robot_, rows_.back().data(), row.data(), sample, state_.data());
      kinematics.chains().computePoses(state_.data(), workspace_);
      const StraightLines::Lengths deviation =
          lines_.deviation(workspace_.poses[static_cast<std::size_t>(query_.link)] * query_.frame, ats_.back(), at);
      // Half of the bounds, because the largest deviation can be between the samples.
      if (deviation.metres > 0.5 * query_.max_deviation || deviation.radians > 0.5 * query_.max_rotation_deviation)
        return true;
    }
    return false;
  }

  std::shared_ptr<const RobotModel> robot_;
  const CartesianQuery& query_;
  StraightLines lines_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> ats_;  // the place of each row on the lines
  std::vector<double> state_;
  KinematicChains::Workspace workspace_;
};

/// ": the next state is 0.1 m from the wanted position"; empty without a violation.
std::string nearText(const ConstraintViolation& violation)
{
  return violation.isNone() ? "" : ": the next state is " + violation.text();
}

/// Number of motions at the beginning of the path that are valid, and the fault of the next one.
std::pair<std::size_t, std::string> validMotions(const PlanningScene& scene,
                                                 const std::shared_ptr<StateChecker>& checker,
                                                 const CartesianQuery& query,
                                                 const std::vector<std::vector<double>>& rows,
                                                 const std::function<bool()>& stop, std::uint64_t& states_checked)
{
  std::size_t count = rows.size() - 1;
  std::string fault;
  if (!query.path_constraints.isEmpty())
  {
    const PathConstraints constraints(scene.robot, query.group, query.path_constraints);
    for (std::size_t i = 0; i < count && fault.empty(); ++i)
    {
      if (stop && stop())
        fault = "the search was stopped";
      else if (!constraints.holdAlong(rows[i].data(), rows[i + 1].data()))
        fault = "the path constraints are not proven to hold" + nearText(constraints.violation(rows[i + 1].data()));
      if (!fault.empty())
        count = i;
    }
  }
  if (!query.check_collisions || count == 0)
    return {count, fault};
  std::vector<double> starts;
  std::vector<double> ends;
  for (std::size_t i = 0; i < count; ++i)
  {
    starts.insert(starts.end(), rows[i].begin(), rows[i].end());
    ends.insert(ends.end(), rows[i + 1].begin(), rows[i + 1].end());
  }
  const MotionChecker motions(checker, scene.robot, query.group, query.motions);
  const std::vector<MotionVerdict> verdicts =
      motions.check(starts.data(), ends.data(), count, MotionQuery::Valid, stop);
  states_checked = motions.statesChecked();
  for (std::size_t i = 0; i < count; ++i)
    if (!verdicts[i].valid)
      return {i, verdicts[i].colliding == kNoPair ? std::string("a motion is not proven free")
                                                  : "collision of " + scene.bodyName(verdicts[i].colliding[0]) +
                                                        " and " + scene.bodyName(verdicts[i].colliding[1])};
  return {count, fault};
}
}  // namespace

CartesianPath followLines(const std::shared_ptr<const PlanningScene>& scene,
                          const std::shared_ptr<StateChecker>& checker, const CartesianQuery& query,
                          const std::function<bool()>& stop)
{
  validate(*scene->robot, query);
  Follower follower(scene->robot, query);
  CartesianPath path;
  path.message = follower.run(stop);
  path.revision = scene->revision;
  auto [valid, fault] = validMotions(*scene, checker, query, follower.rows(), stop, path.states_checked);
  path.rows.assign(follower.rows().begin(), follower.rows().begin() + static_cast<std::ptrdiff_t>(valid) + 1);
  path.fraction = follower.fraction(valid);
  if (!fault.empty())
    path.message = std::move(fault);
  return path;
}
}  // namespace gpu_planning_scene::core
