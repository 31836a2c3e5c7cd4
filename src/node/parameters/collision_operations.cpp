#include "node/parameters/collision_operations.h"

#include <utility>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

/// The text of a member of the entry. Throws Error that begins with `where` if it has none.
std::string memberText(XmlRpcValue& entry, const char* member, const std::string& where)
{
  if (entry.getType() == XmlRpcValue::TypeStruct && entry.hasMember(member) &&
      entry[member].getType() == XmlRpcValue::TypeString)
    return entry[member];
  throw Error(where + " has no text '" + member + "'; write {object1: NAME, object2: NAME, operation: disable}");
}
}  // namespace

void applyCollisionOperations(const XmlRpcValue& operations, const std::string& parameter, PlanningScene& scene,
                              std::vector<std::string>* warnings)
{
  XmlRpcValue list = operations;
  if (list.getType() != XmlRpcValue::TypeArray)
    throw Error("parameter " + parameter + " is not a list of {object1: NAME, object2: NAME, operation: disable}");
  AllowedCollisionMatrix matrix = scene.allowed_collisions;
  for (int i = 0; i < list.size(); ++i)
  {
    const std::string where = "parameter " + parameter + ": entry " + std::to_string(i);
    const std::string operation = memberText(list[i], "operation", where);
    if (operation != "disable" && operation != "enable")
      throw Error(where + ": the operation is '" + operation + "'; it must be disable or enable");
    matrix.setEntry(memberText(list[i], "object1", where), memberText(list[i], "object2", where),
                    operation == "disable");
  }
  if (list.size() == 0)
    return;
  if (scene.matrix_source == MatrixSource::SceneFile)
  {
    if (warnings != nullptr)
      warnings->push_back("parameter " + parameter + " is ignored, because the scene file has a matrix of its own");
    return;
  }
  scene.allowed_collisions = std::move(matrix);
  scene.matrix_source = MatrixSource::SceneFile;  // it is no longer the robot's own
}
}  // namespace gpu_planning_scene::core
