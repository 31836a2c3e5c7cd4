#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// A mesh that a method is measured with, two copies of it against each other. The centre of its bounding box is the
/// origin of its frame.
struct Model
{
  std::string name;
  std::shared_ptr<const Mesh> mesh;
  double size;  ///< longest edge of its bounding box, metres
  bool convex = false;
  bool open = false;  ///< some part of it does not enclose a volume
};

/// A closed, concave surface with hollows and humps, similar to a scanned object, of about a metre.
std::shared_ptr<const Mesh> lump(std::size_t triangles);

/// The names of the models that the project makes: torus, sphere, lump, car and pipes.
const std::vector<std::string>& madeModelNames();

/// A model with about `triangles` triangles and a size of about a metre. `seed`: for the parts of the car and the
/// courses of the pipes. Throws Error for an unknown name.
Model madeModel(const std::string& name, std::size_t triangles, std::uint64_t seed);

/// Models of one size each. First a box, which has few, large triangles. Then the links with the most triangles of the
/// robots whose files are available, one of each robot: kr5, ur5_robotiq and drchubo. The names are those of robot and
/// link.
std::vector<Model> fixedModels();
}  // namespace gpu_planning_scene::core::literature
