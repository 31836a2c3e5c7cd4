#include "tools/state_source.h"

#include <limits>
#include <random>

#include "collision/report/scene_text.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "tools/state_table.h"
#include "tools/state_values.h"

namespace gpu_planning_scene::core
{
namespace
{
class RandomStates : public StateSource
{
 public:
  RandomStates(const PlanningScene& scene, std::size_t count, std::uint64_t seed, bool keep_base)
    : robot_(*scene.robot),
      start_(startState(scene)),
      count_(count),
      seed_(seed),
      keep_base_(keep_base),
      generator_(seed)
  {
  }

  std::size_t count() const override { return count_; }
  std::string text() const override { return counted(count_, "random state") + ", seed " + std::to_string(seed_); }

  const double* next(std::size_t count) override
  {
    const std::size_t width = robot_.variables().size();
    states_.resize(count * width);
    for (std::size_t i = 0; i < count; ++i)
      randomise(robot_, generator_, start_, keep_base_, states_.data() + i * width);
    return states_.data();
  }

 private:
  const RobotModel& robot_;
  std::vector<double> start_;
  std::size_t count_;
  std::uint64_t seed_;
  bool keep_base_;
  std::mt19937_64 generator_;
  std::vector<double> states_;
};

class StateOfText : public StateSource
{
 public:
  StateOfText(const PlanningScene& scene, const std::string& text, const std::string& group)
    : text_(text), state_(startState(scene))
  {
    SetValues values = setValues(*scene.robot, text, !scene.current_state.empty(), state_);
    warning_ = std::move(values.warning);
    try
    {
      requireVariableOfGroup(*scene.robot, group, values.variables);
    }
    catch (const Error& error)
    {
      throw UsageError(std::string("--state: ") + error.what());
    }
  }

  std::size_t count() const override { return 1; }
  std::string text() const override { return "1 state, " + text_; }
  std::string warning() const override { return warning_; }
  const double* next(std::size_t /*count*/) override { return state_.data(); }

 private:
  std::string text_;
  std::vector<double> state_;
  std::string warning_;
};

class StatesOfFile : public StateSource
{
 public:
  StatesOfFile(const PlanningScene& scene, const std::string& path, const std::string& group) : path_(path)
  {
    const RobotModel& robot = *scene.robot;
    width_ = robot.variables().size();
    const StateTable table = readStateTable(path);
    count_ = table.rows;
    try
    {
      const std::vector<int> columns = variableIndices(robot, table.names);
      requireVariableOfGroup(robot, group, columns);
      if (const auto outside = findDoubtfulValue(robot, columns, table.values.data(), table.rows))
        warning_ = path + ":" + std::to_string(outside->row + 2) + ": " + outside->text;
      const PartialState current(robot, scene.current_state);
      std::vector<bool> given(width_, !scene.current_state.empty());
      for (const int column : columns)
        given[static_cast<std::size_t>(column)] = true;
      if (const std::string passive = assumedPassiveJoints(robot, given); !passive.empty())
        warning_ += (warning_.empty() ? "" : "; ") + passive;
      states_ = fullStates(robot, columns, table.values.data(), table.rows, current);
    }
    catch (const Error& error)
    {
      throw Error(path + ":1: " + error.what());
    }
  }

  std::size_t count() const override { return count_; }
  std::string text() const override { return counted(count_, "state") + " from " + path_; }
  std::string warning() const override { return warning_; }

  const double* next(std::size_t count) override
  {
    const double* states = states_.data() + next_ * width_;
    next_ += count;
    return states;
  }

 private:
  std::string path_;
  std::string warning_;
  std::size_t width_ = 0;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  std::vector<double> states_;
};
}  // namespace

std::vector<Option> stateOptions()
{
  return {{"--states", "FILE",
           "CSV: a header of variable names, then one state per row; variables\nwithout a column take the scene's "
           "robot_state"},
          {"--state", "ITEM,...",
           "instead: one state, from items NAME=VALUE (a variable) and names of\nstates of the SRDF (ready, or "
           "GROUP/ready), of which later ones replace\nvalues of earlier ones; the other variables have the "
           "scene's\nrobot_state, or their defaults"},
          {"--random", "N",
           "instead: N random states within the limits. Planar and floating\njoints, which move the robot's base, "
           "stay where they are"},
          {"--random-base", "", "with --random: random values of planar and floating joints too"},
          {"--seed", "S", "the seed of the random states (default 0)"}};
}

void checkStateUsage(const CommandLine& arguments)
{
  const int sources =
      (arguments.has("--states") ? 1 : 0) + (arguments.has("--state") ? 1 : 0) + (arguments.has("--random") ? 1 : 0);
  if (sources != 1)
    throw UsageError("give one of --states FILE, --state ITEM,... and --random N");
  for (const char* option : {"--seed", "--random-base"})
    if (arguments.has(option) && !arguments.has("--random"))
      throw UsageError(std::string(option) + " needs --random");
}

std::unique_ptr<StateSource> stateSourceFrom(const CommandLine& arguments, const PlanningScene& scene)
{
  checkStateUsage(arguments);
  const std::string group = arguments.value("--group", "");
  if (arguments.has("--states"))
    return std::make_unique<StatesOfFile>(scene, arguments.required("--states"), group);
  if (arguments.has("--state"))
    return std::make_unique<StateOfText>(scene, arguments.required("--state"), group);
  const std::size_t count = arguments.count("--random", 0, 1, 1000000000);
  const std::size_t seed = arguments.count("--seed", 0, 0, std::numeric_limits<long long>::max());
  return std::make_unique<RandomStates>(scene, count, seed, !arguments.has("--random-base"));
}
}  // namespace gpu_planning_scene::core
