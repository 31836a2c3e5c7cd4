#include "node/parameters/setup.h"

#include <memory>
#include <string>
#include <variant>

#include "node/parameters/parameter_values.h"

// The hash is FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo; RFC 9923), which is the same on all machines.
namespace gpu_planning_scene::core
{
namespace
{
class Hash
{
 public:
  void add(const void* data, std::size_t size)
  {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i)
      value = (value ^ bytes[i]) * 0x100000001B3U;
  }
  void add(const std::string& text) { add(text.c_str(), text.size() + 1); }
  void add(double number) { add(&number, sizeof(number)); }

  std::uint64_t value = 0xCBF29CE484222325U;
};
}  // namespace

std::uint64_t setupFromParameters(const ros::NodeHandle& node, const RobotModel& robot, const SceneDefaults& defaults)
{
  Hash hash;
  for (const char* name : {"robot_description", "robot_description_semantic"})
    hash.add(textParameter(node, searchedParameter(node, name), ""));
  for (const Link& link : robot.scaled({})->links())
    for (const PlacedShape& placed : link.shapes)
      if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
      {
        hash.add(toString((*mesh)->solid));
        hash.add((*mesh)->vertices.data(), (*mesh)->vertices.size() * sizeof(Eigen::Vector3d));
        hash.add((*mesh)->triangles.data(), (*mesh)->triangles.size() * sizeof((*mesh)->triangles[0]));
      }
  for (const Variable& variable : robot.variables())
  {
    hash.add(variable.lower);
    hash.add(variable.upper);
  }
  hash.add(defaults.object_padding);
  hash.add(defaults.attached_padding);
  return hash.value;
}
}  // namespace gpu_planning_scene::core
