#include "node/messages/exact_numbers.h"

#include <cstdint>
#include <cstring>
#include <vector>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/messages/from_messages.h"

// The message is converted back, and each number that is then another one is kept. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// Lists the addresses of all numbers of a change.
class Numbers
{
 public:
  explicit Numbers(SceneChange& change)
  {
    for (auto& [name, value] : change.state.variables)
      all.push_back(&value);
    for (auto& [name, pose] : change.fixed_frames)
      add(pose);
    for (AttachedChange& attached : change.state.attached)
      add(attached.object);
    for (const bool is_octomap : {false, true})  // in a message, the octomap comes last
      for (ObjectChange& object : change.objects)
        if ((object.id == kOctomapId) == is_octomap)
          add(object);
  }

  std::vector<double*> all;

 private:
  void add(Eigen::Isometry3d& pose)
  {
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        all.push_back(&pose(row, column));
  }

  void add(Eigen::Vector3d& vector)
  {
    for (int i = 0; i < 3; ++i)
      all.push_back(&vector[i]);
  }

  /// Messages keep the other numbers of shapes to the last bit.
  void add(PlacedShape& placed)
  {
    add(placed.pose);
    if (auto* half_space = std::get_if<HalfSpace>(&placed.shape))
    {
      add(half_space->normal);
      all.push_back(&half_space->offset);
    }
    else if (auto* box = std::get_if<Box>(&placed.shape))
      add(box->size);
  }

  void add(ObjectChange& object)
  {
    if (object.pose)
      add(*object.pose);
    for (PlacedShape& placed : object.shapes)
      add(placed);
    for (Eigen::Isometry3d& pose : object.shape_poses)
      add(pose);
    for (auto& [name, pose] : object.subframes)
      add(pose);
  }
};

std::uint64_t bitsOf(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// Unlike ==, it distinguishes 0 and -0.
bool hasSameBits(double a, double b)
{
  return bitsOf(a) == bitsOf(b);
}
}  // namespace

void keepExactNumbers(const SceneChange& change, const RobotModel& robot, PlanningSceneMessage& message)
{
  SceneLimits none;
  none.voxels = none.name_length = none.matrix_entries = 0;
  SceneChange back = changeFrom(message, robot, none, nullptr);
  SceneChange exact = change;
  const Numbers found(back);
  const Numbers wanted(exact);
  if (found.all.size() != wanted.all.size())
    throw Error("a message of the scene has " + std::to_string(found.all.size()) + " numbers, and the scene has " +
                std::to_string(wanted.all.size()));
  for (std::size_t i = 0; i < found.all.size(); ++i)
    if (!hasSameBits(*found.all[i], *wanted.all[i]))
    {
      message.exact_places.push_back(static_cast<std::uint32_t>(i));
      message.exact_values.push_back(*wanted.all[i]);
    }
}

void takeExactNumbers(const PlanningSceneMessage& message, SceneChange& change)
{
  if (message.exact_places.size() != message.exact_values.size())
    throw Error(std::to_string(message.exact_values.size()) + " exact_values for " +
                std::to_string(message.exact_places.size()) + " exact_places");
  const Numbers numbers(change);
  for (std::size_t i = 0; i < message.exact_places.size(); ++i)
  {
    if (message.exact_places[i] >= numbers.all.size())
      throw Error("exact_places names number " + std::to_string(message.exact_places[i]) + " of " +
                  std::to_string(numbers.all.size()));
    *numbers.all[message.exact_places[i]] = message.exact_values[i];
  }
}
}  // namespace gpu_planning_scene::core
