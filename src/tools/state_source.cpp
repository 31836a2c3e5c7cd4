#include "tools/state_source.h"

#include <limits>
#include <random>

#include "collision/checkers/scene_text.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "tools/state_table.h"

namespace gpu_planning_scene::core
{
namespace
{
class RandomStates : public StateSource
{
 public:
  RandomStates(const RobotModel& robot, std::size_t count, std::uint64_t seed)
    : robot_(robot), count_(count), seed_(seed), generator_(seed)
  {
  }

  std::size_t count() const override { return count_; }
  std::string text() const override { return counted(count_, "random state") + ", seed " + std::to_string(seed_); }

  const double* next(std::size_t count) override
  {
    const std::size_t width = robot_.variables().size();
    states_.resize(count * width);
    for (std::size_t i = 0; i < count; ++i)
      robot_.randomState(generator_, states_.data() + i * width);
    return states_.data();
  }

 private:
  const RobotModel& robot_;
  std::size_t count_;
  std::uint64_t seed_;
  std::mt19937_64 generator_;
  std::vector<double> states_;
};

class StatesOfFile : public StateSource
{
 public:
  StatesOfFile(const PlanningScene& scene, const std::string& path) : path_(path)
  {
    const RobotModel& robot = *scene.robot;
    width_ = robot.variables().size();
    const StateTable table = readStateTable(path);
    count_ = table.rows;
    try
    {
      const std::vector<int> columns = variableIndices(robot, table.names);
      if (const auto outside = findValueOutsideLimits(robot, columns, table.values.data(), table.rows))
        warning_ = path + ":" + std::to_string(outside->row + 2) + ": " + outside->text;
      const PartialState current(robot, scene.current_state);
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
          {"--random", "N", "instead: N random states within the limits, with random values\nof all variables"},
          {"--seed", "S", "the seed of the random states (default 0)"}};
}

std::unique_ptr<StateSource> stateSourceFrom(const CommandLine& arguments, const PlanningScene& scene)
{
  if (arguments.has("--states") == arguments.has("--random"))
    throw UsageError("give either --states FILE or --random N");
  if (arguments.has("--states"))
  {
    if (arguments.has("--seed"))
      throw UsageError("--seed needs --random");
    return std::make_unique<StatesOfFile>(scene, arguments.required("--states"));
  }
  const long long count = arguments.integer("--random", 0, 1, 1000000000);
  const long long seed = arguments.integer("--seed", 0, 0, std::numeric_limits<long long>::max());
  return std::make_unique<RandomStates>(*scene.robot, static_cast<std::size_t>(count),
                                        static_cast<std::uint64_t>(seed));
}
}  // namespace gpu_planning_scene::core
