#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "model/meshes/ply_header.h"

namespace gpu_planning_scene::core
{
/// The values behind the header of a PLY file, one after the other. Each method throws Error with the place of the
/// fault.
class PlyValues
{
 public:
  virtual ~PlyValues() = default;

  /// The next value. In a text, a value of a float type keeps all its digits.
  virtual double next(PlyType type) = 0;
  virtual void skip(PlyType type) = 0;
  /// Throws Error unless all values are read.
  virtual void requireEnd() = 0;
  /// The place of the last value, for messages.
  virtual std::string place() const = 0;
};

std::unique_ptr<PlyValues> plyValues(std::string_view content, const PlyHeader& header);
}  // namespace gpu_planning_scene::core
