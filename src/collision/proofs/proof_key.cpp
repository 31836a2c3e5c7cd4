#include "collision/proofs/proof_key.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <variant>

#include <boost/uuid/detail/sha1.hpp>

#include "collision/geometry/primitive_solid.h"
#include "collision/proofs/proof_sources.h"

// The bits of all numbers, one after the other. A key does not contain the numbers of variables, so it stays the same
// if a robot numbers its variables in another way. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

template <class Number>
void append(std::string& bytes, Number number)
{
  static_assert(std::is_arithmetic_v<Number>, "padding has no defined value");
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

void append(std::string& bytes, const Vector3d& vector)
{
  for (int i = 0; i < 3; ++i)
    append(bytes, vector[i]);
}

void append(std::string& bytes, const Isometry3d& pose)
{
  for (int column = 0; column < 4; ++column)
    append(bytes, Vector3d(pose.matrix().block<3, 1>(0, column)));
}

void append(std::string& bytes, const ShapeHash& hash)
{
  bytes.append(hash.data(), hash.size());
}
}  // namespace

ShapeHash shapeHash(const Shape& shape, double sagitta)
{
  boost::uuids::detail::sha1 sha1;
  std::string bytes;
  append(bytes, sagitta);
  append(bytes, static_cast<std::uint64_t>(shape.index()));
  if (isMesh(shape))
  {
    const Mesh& mesh = *std::get<std::shared_ptr<const Mesh>>(shape);
    append(bytes, static_cast<std::uint64_t>(mesh.vertices.size()));
    append(bytes, static_cast<std::uint64_t>(mesh.triangles.size()));
    append(bytes, static_cast<std::uint64_t>(mesh.solid));
    static_assert(sizeof(Vector3d) == 3 * sizeof(double) && sizeof(mesh.triangles[0]) == 12, "no padding");
    sha1.process_bytes(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vector3d));
    sha1.process_bytes(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  }
  else
    append(bytes, halfExtents(shape));
  sha1.process_bytes(bytes.data(), bytes.size());
  boost::uuids::detail::sha1::digest_type digest;
  sha1.get_digest(digest);
  ShapeHash hash;
  static_assert(sizeof(digest) == sizeof(hash), "160 bits");
  std::memcpy(hash.data(), &digest, sizeof(hash));
  return hash;
}

std::string coverKey(const ShapeHash& shape)
{
  std::string key = std::string("cover ") + kProofSources;
  append(key, shape);
  return key;
}

std::string tableKey(const RobotModel& robot, const std::vector<ChainJoint>& chain, const TableSide& a,
                     const TableSide& b)
{
  std::string key = std::string("table ") + kProofSources;
  for (const TableSide& side : {a, b})
  {
    append(key, side.shape);
    append(key, side.pose);
  }
  std::vector<int> variables;  // in the order of the joints
  for (const auto& [joint, upwards] : chain)
  {
    append(key, upwards);
    append(key, static_cast<int>(joint->type));
    append(key, joint->origin);
    append(key, joint->axis);
    append(key, joint->multiplier);
    append(key, joint->offset);
    const auto place = std::find(variables.begin(), variables.end(), joint->first_variable) - variables.begin();
    append(key, static_cast<std::int64_t>(place));
    if (place < static_cast<std::ptrdiff_t>(variables.size()) || joint->type == JointType::Fixed)
      continue;
    variables.push_back(joint->first_variable);
    const Variable& variable = robot.variables()[static_cast<std::size_t>(joint->first_variable)];
    append(key, variable.bounded);
    append(key, variable.lower);
    append(key, variable.upper);
  }
  return key;
}
}  // namespace gpu_planning_scene::core
