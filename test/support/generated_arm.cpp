#include "support/generated_arm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gpu_planning_scene/error.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// A link is a tube along its z axis. Its joint lies at the end of the previous link.
struct ArmLink
{
  double radius;
  double length;
  const char* axis;
  double limit;  // radians, in both directions
};

constexpr std::array<ArmLink, 7> kLinks = {{{0.12, 0.30, "", 0.0},
                                            {0.09, 0.12, "0 0 1", 2.9},
                                            {0.07, 0.34, "0 1 0", 1.8},
                                            {0.06, 0.14, "0 1 0", 2.4},
                                            {0.05, 0.22, "0 0 1", 3.0},
                                            {0.04, 0.10, "0 1 0", 2.0},
                                            {0.03, 0.08, "0 0 1", 3.0}}};

/// A tube with rounded ends along z, from 0 to the link's length. Its bumps are a tenth of its radius high.
std::shared_ptr<const Mesh> tube(const ArmLink& link, std::size_t triangles)
{
  // The number of columns makes the triangles about as wide as high.
  const double ratio = 2.0 * M_PI * link.radius / (link.length + 2.0 * link.radius);
  return closedSurface("tube", triangles, ratio,
                       [&](double along, double angle) -> Vector3d
                       {
                         const double rounded = std::sqrt(std::sqrt(std::max(0.0, 4.0 * along * (1.0 - along))));
                         const double bumps = 0.95 + 0.05 * std::sin(7.0 * angle) * std::sin(20.0 * along);
                         const double radius = link.radius * rounded * bumps;
                         return {radius * std::cos(angle), radius * std::sin(angle), link.length * along};
                       });
}

std::string linkName(std::size_t i)
{
  return "link_" + std::to_string(i);
}

void writeStl(const std::string& path, const Mesh& mesh)
{
  std::ofstream file(path, std::ios::binary);
  const std::array<char, 80> header{};
  file.write(header.data(), header.size());
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  file.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& triangle : mesh.triangles)
  {
    std::array<float, 12> record{};  // a zero normal, then the corners
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        record[3 + 3 * corner + axis] = static_cast<float>(mesh.vertices[triangle[corner]][axis]);
    const std::uint16_t attribute = 0;
    file.write(reinterpret_cast<const char*>(record.data()), sizeof record);
    file.write(reinterpret_cast<const char*>(&attribute), sizeof attribute);
  }
  if (!file.flush())
    throw Error(path + ": cannot be written; is there room in the folder for temporary files?");
}

std::string urdf()
{
  std::ostringstream text;
  text << "<robot name=\"generated_arm\">\n";
  for (std::size_t i = 0; i < kLinks.size(); ++i)
  {
    text << "<link name=\"" << linkName(i) << "\"><collision><geometry><mesh filename=\"" << linkName(i)
         << ".stl\"/></geometry></collision></link>\n";
    if (i == 0)
      continue;
    // The joint lies slightly before the end of the previous link, so neighbouring tubes overlap as in real robots.
    text << "<joint name=\"joint_" << i << "\" type=\"revolute\"><parent link=\"" << linkName(i - 1)
         << "\"/><child link=\"" << linkName(i) << "\"/><origin xyz=\"0 0 " << kLinks[i - 1].length - kLinks[i].radius
         << "\"/><axis xyz=\"" << kLinks[i].axis << "\"/><limit lower=\"" << -kLinks[i].limit << "\" upper=\""
         << kLinks[i].limit << "\" effort=\"1\" velocity=\"1\"/></joint>\n";
  }
  text << "</robot>\n";
  return text.str();
}

/// A link overlaps the next two links of the chain in all states.
std::string srdf(const std::string& virtual_joint = "")
{
  std::ostringstream text;
  text << "<robot name=\"generated_arm\">\n" << virtual_joint;
  for (std::size_t i = 0; i < kLinks.size(); ++i)
    for (std::size_t k = i + 1; k < std::min(i + 3, kLinks.size()); ++k)
      text << "<disable_collisions link1=\"" << linkName(i) << "\" link2=\"" << linkName(k)
           << "\" reason=\"Adjacent\"/>\n";
  text << "<group name=\"arm\"><chain base_link=\"link_1\" tip_link=\"link_6\"/></group>\n"
          "<group name=\"hand\"><joint name=\"joint_6\"/></group>\n";
  text << "</robot>\n";
  return text.str();
}
}  // namespace

GeneratedArm::GeneratedArm(std::size_t triangles)
{
  std::string name = (std::filesystem::temp_directory_path() / "generated_armXXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error("no folder for the generated robot can be made in " + std::filesystem::temp_directory_path().string() +
                "; set TMPDIR");
  folder_ = name;
  std::ofstream(folder_ + "/arm.urdf") << urdf();
  std::ofstream(folder_ + "/arm.srdf") << srdf();
  std::ofstream(folder_ + "/driven_arm.srdf") << srdf(
      "<virtual_joint name=\"drive\" type=\"planar\" parent_frame=\"map\" child_link=\"" + linkName(0) + "\"/>\n");
  for (std::size_t i = 0; i < kLinks.size(); ++i)
    writeStl(folder_ + "/" + linkName(i) + ".stl", *tube(kLinks[i], triangles / kLinks.size()));
}

GeneratedArm::~GeneratedArm()
{
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::shared_ptr<const RobotModel> GeneratedArm::load() const
{
  return RobotModel::fromFiles(folder_ + "/arm.urdf", folder_ + "/arm.srdf", {});
}

std::shared_ptr<const RobotModel> GeneratedArm::loadDriven() const
{
  return RobotModel::fromFiles(folder_ + "/arm.urdf", folder_ + "/driven_arm.srdf", {});
}
}  // namespace gpu_planning_scene::core
