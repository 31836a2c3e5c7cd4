#include "literature/hard_meshes.h"

#include <algorithm>
#include <random>

#include "literature/models.h"
#include "literature/poses.h"

namespace gpu_planning_scene::core::literature
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

MeshPtr modelMesh(const char* model, std::size_t triangles)
{
  return madeModel(model, triangles, 1).mesh;
}

MeshPtr moved(const MeshPtr& mesh, const Isometry3d& pose, double scale)
{
  auto made = std::make_shared<Mesh>(*mesh);
  for (Vector3d& vertex : made->vertices)
    vertex = pose * (scale * vertex);
  return made;
}

MeshPtr scaled(const MeshPtr& mesh, double scale)
{
  return moved(mesh, Isometry3d::Identity(), scale);
}

MeshPtr damaged(const MeshPtr& mesh, Damage damage, std::uint64_t seed)
{
  auto made = std::make_shared<Mesh>(*mesh);
  std::shuffle(made->triangles.begin(), made->triangles.end(), std::mt19937_64(seed));
  const std::size_t tenth = made->triangles.size() / 10;
  for (std::size_t i = 0; i < tenth; ++i)
    if (damage == Damage::Removed)
      made->triangles.pop_back();
    else if (damage == Damage::Flipped)
      std::swap(made->triangles[i][0], made->triangles[i][1]);
    else
      made->triangles.push_back(std::array<std::uint32_t, 3>(made->triangles[i]));
  return made;
}

const Vector3d kNeedleAxis = Vector3d(1.0, 0.8, 1.2).normalized();

MeshPtr needle()
{
  const Isometry3d turn(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), kNeedleAxis));
  return moved(boxMesh({1.0, 1e-4, 1e-4}), turn);
}

const Vector3d kPlateAxis = Vector3d(0.8, 0.6, 0.0);

MeshPtr plate()
{
  return moved(boxMesh({1.0, 1e-4, 0.1}),
               Isometry3d(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), kPlateAxis)));
}

MeshPtr grains(std::uint64_t seed, const Eigen::Matrix3d& turn)
{
  auto made = std::make_shared<Mesh>();
  made->name = "grains";
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  for (int i = 0; i < 60; ++i)
  {
    const double x = place(generator);
    const double y = place(generator);
    const Vector3d at(x, y, place(generator));
    const auto first = static_cast<std::uint32_t>(made->vertices.size());
    for (const Vector3d& corner : {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)})
      made->vertices.push_back(at + turn * (0.35 * kGrainSize * corner));
    for (const auto& t : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}})
      made->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return made;
}

MeshPtr pile(std::uint64_t seed)
{
  auto made = std::make_shared<Mesh>();
  made->name = "pile";
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-0.45, 0.45);
  for (const Isometry3d& turn : posesAt(0.0, 150, seed))
  {
    const Vector3d at(place(generator), place(generator), place(generator));
    const MeshPtr part = boxMesh({0.1, 0.06, 0.03});
    const auto first = static_cast<std::uint32_t>(made->vertices.size());
    for (const Vector3d& vertex : part->vertices)
      made->vertices.push_back(turn * vertex + at);
    for (const auto& t : part->triangles)
      made->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return made;
}
}  // namespace gpu_planning_scene::core::literature
