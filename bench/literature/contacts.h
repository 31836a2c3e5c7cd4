#pragma once

#include <cstdint>
#include <vector>

#include "literature/hard_meshes.h"

/// Poses of a mesh b in the frame of a mesh a at which b just does not touch a. The exact checker finds them by
/// bisection. The oracle gives the truth later, so an error here changes only the difficulty of a case.
namespace gpu_planning_scene::core::literature
{
struct Contact
{
  Eigen::Isometry3d apart;
  Eigen::Vector3d direction;  ///< away from a; unit length
};

/// The path of b: `start`, moved by up to `reach` metres along `direction`. At its end, b does not touch a. If b does
/// not touch a at the start either, the contact is at the start.
struct Path
{
  Eigen::Isometry3d start;
  Eigen::Vector3d direction;
  double reach;
};
std::vector<Contact> contactsOn(const std::vector<Path>& paths, const MeshPtr& a, const MeshPtr& b);

/// For meshes of about a metre: from random directions with random rotations, or, if not `turned`, from the six
/// directions of the axes without a rotation.
std::vector<Contact> contacts(const MeshPtr& a, const MeshPtr& b, bool turned, std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core::literature
