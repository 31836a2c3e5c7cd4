#pragma once

#include <algorithm>
#include <array>
#include <cstring>

namespace gpu_planning_scene::core
{
/// The number that `bytes` hold in the given byte order.
template <typename Value>
Value valueOf(const char* bytes, bool big_endian)
{
  constexpr bool kBigEndianMachine = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  std::array<char, sizeof(Value)> ordered;
  std::copy(bytes, bytes + sizeof(Value), ordered.begin());
  if (big_endian != kBigEndianMachine)
    std::reverse(ordered.begin(), ordered.end());
  Value value;
  std::memcpy(&value, ordered.data(), sizeof value);
  return value;
}
}  // namespace gpu_planning_scene::core
