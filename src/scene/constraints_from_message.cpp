#include "scene/constraints_from_message.h"

namespace gpu_planning_scene::core
{
Eigen::Quaterniond unitQuaternion(double x, double y, double z, double w, const std::string& where)
{
  constexpr double kLargestError = 1e-3;  // of the length: clients write few digits
  const Eigen::Quaterniond rotation(w, x, y, z);
  const double length = rotation.coeffs().stableNorm();
  if (!(std::abs(length - 1.0) <= kLargestError))
    throw Error(where + ": the quaternion of the orientation has the length " + numberText(length) +
                "; it must have the length 1 (no rotation is x: 0, y: 0, z: 0, w: 1)");
  return rotation.normalized();
}
}  // namespace gpu_planning_scene::core
