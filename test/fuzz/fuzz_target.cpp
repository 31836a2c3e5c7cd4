#include "fuzz/fuzz_target.h"

#include <cstdio>
#include <cstdlib>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
void requireOneLine(const std::string& text, bool must_say)
{
  if (text.find('\n') == std::string::npos && !(must_say && text.empty()))
    return;
  std::fprintf(stderr, "expected one line of text, found: '%s'\n", text.c_str());
  std::abort();
}

void acceptOrRefuse(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const Error& error)
  {
    requireOneLine(error.what(), true);
  }
}

MeshAccess fuzzedMeshes()
{
  MeshAccess access;
  access.read = [](const std::string& path, const Eigen::Vector3d& scale) -> std::shared_ptr<const Mesh>
  {
    if (path.size() < 4 || path.compare(path.size() - 4, 4, ".stl") != 0 || !scale.allFinite() || scale.prod() == 0.0)
      throw Error("a mesh file cannot be read");
    auto mesh = std::make_shared<Mesh>();
    mesh->name = path;
    mesh->vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
  };
  return access;
}

PackageResolver fuzzedPackages()
{
  // No packageResolver: it would search the folders of ROS_PACKAGE_PATH for each input.
  return [](const std::string& package) { return package == "p" ? std::string("/p") : std::string(); };
}

std::string textOf(const std::uint8_t* data, std::size_t size)
{
  return std::string(reinterpret_cast<const char*>(data), size);
}

void useRobot(const RobotModel& robot)
{
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.linkPoses(robot.defaultState().data(), poses.data());
  robot.adjacentLinks();
}
}  // namespace gpu_planning_scene::core
