#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpu_planning_scene::core
{
enum class PlyType
{
  Int8,
  Uint8,
  Int16,
  Uint16,
  Int32,
  Uint32,
  Float32,
  Float64
};

struct PlyProperty
{
  std::string name;
  PlyType type;
  std::optional<PlyType> length_type = {};  ///< a list; the type of the number of its values
};

struct PlyElement
{
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat
{
  Ascii,
  LittleEndian,
  BigEndian
};

struct PlyHeader
{
  PlyFormat format;
  std::vector<PlyElement> elements;
  std::size_t bytes;  ///< of the header; the values follow
  std::size_t lines;
};

/// Throws Error with the line of the fault.
PlyHeader readPlyHeader(std::string_view content);
}  // namespace gpu_planning_scene::core
