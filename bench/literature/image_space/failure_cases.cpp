#include "literature/image_space/failure_cases.h"

#include "literature/solids.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
/// A box whose upper and lower side are divided along the same diagonal, from the lowest x and y to the highest.
std::shared_ptr<const Mesh> block(const Eigen::Vector3d& low, const Eigen::Vector3d& high)
{
  auto mesh = std::make_shared<Mesh>();
  for (const double z : {low.z(), high.z()})
    mesh->vertices.insert(mesh->vertices.end(),
                          {Eigen::Vector3d(low.x(), low.y(), z), Eigen::Vector3d(high.x(), low.y(), z),
                           Eigen::Vector3d(high.x(), high.y(), z), Eigen::Vector3d(low.x(), high.y(), z)});
  mesh->triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i)
  {
    const std::uint32_t next = (i + 1) % 4;
    mesh->triangles.push_back({i, next, next + 4});
    mesh->triangles.push_back({i, next + 4, i + 4});
  }
  return mesh;
}
}  // namespace

FailureCase linkedTori()
{
  const auto torus = torusMesh(0.4, 0.1, 64, 32);
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX()));
  pose.pretranslate(Eigen::Vector3d(0.4, 0.0, 0.0));
  return {torus, torus, pose};
}

FailureCase blockInPlate()
{
  return {block({-0.5, -0.5, -0.3}, {0.5, 0.5, 0.0}), block({0.1, -0.4, -0.1}, {0.4, -0.1, 0.4}),
          Eigen::Isometry3d::Identity()};
}
}  // namespace gpu_planning_scene::core::literature
