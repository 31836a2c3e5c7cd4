#include "literature/contacts.h"

#include "literature/exact_pair.h"
#include "literature/poses.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kReach = 3.0;  // metres

Contact contactOn(const Path& path, const ExactPair& exact)
{
  ExactChecker::Scratch scratch;
  const auto at = [&](double distance)
  {
    Isometry3d pose = path.start;
    pose.pretranslate(distance * path.direction);
    return pose;
  };
  double apart = path.reach;
  double touching = 0.0;
  while (touching + 1e-14 * apart < apart)
  {
    const double middle = 0.5 * (touching + apart);
    if (middle == touching || middle == apart)
      break;
    (exact.collides(at(middle), scratch) ? touching : apart) = middle;
  }
  return {at(apart), path.direction};
}
}  // namespace

std::vector<Contact> contactsOn(const std::vector<Path>& paths, const MeshPtr& a, const MeshPtr& b)
{
  const ExactPair exact(pairProblem(a, b));
  std::vector<Contact> found;
  for (const Path& path : paths)
    found.push_back(contactOn(path, exact));
  return found;
}

std::vector<Contact> contacts(const MeshPtr& a, const MeshPtr& b, bool turned, std::size_t count, std::uint64_t seed)
{
  std::vector<Path> paths;
  const std::vector<Isometry3d> ends = posesAt(kReach, count, seed);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto axis = static_cast<int>(i % 3);
    const Vector3d direction =
        turned ? ends[i].translation().normalized() : Vector3d(Vector3d::Unit(axis) * (i % 2 == 0 ? 1.0 : -1.0));
    Isometry3d start = Isometry3d::Identity();
    if (turned)
      start.linear() = ends[i].linear();
    else
    {
      // A small shift across the direction, so that not all edges meet edges.
      start.translation() = 0.01 * static_cast<double>(i) / static_cast<double>(count) * Vector3d(0.7, 0.4, 0.55);
      start.translation()[axis] = 0.0;
    }
    paths.push_back({start, direction, kReach});
  }
  return contactsOn(paths, a, b);
}
}  // namespace gpu_planning_scene::core::literature
