#include "model/zero_size.h"

#include <algorithm>
#include <vector>

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kThickness = 1e-9;  // metres

std::vector<double*> sizesOf(Shape& shape)
{
  if (auto* box = std::get_if<Box>(&shape))
    return {&box->size.x(), &box->size.y(), &box->size.z()};
  if (auto* sphere = std::get_if<Sphere>(&shape))
    return {&sphere->radius};
  if (auto* cylinder = std::get_if<Cylinder>(&shape))
    return {&cylinder->radius, &cylinder->length};
  if (auto* cone = std::get_if<Cone>(&shape))
    return {&cone->radius, &cone->length};
  return {};
}
}  // namespace

ZeroSize thicken(Shape& shape)
{
  const std::vector<double*> sizes = sizesOf(shape);
  const auto zeros = std::count_if(sizes.begin(), sizes.end(), [](const double* size) { return *size == 0.0; });
  if (zeros == 0)
    return ZeroSize::None;
  if (zeros == static_cast<std::ptrdiff_t>(sizes.size()))
    return ZeroSize::Point;
  for (double* size : sizes)
    if (*size == 0.0)
      *size = kThickness;
  return ZeroSize::Flat;
}
}  // namespace gpu_planning_scene::core
