#pragma once

#include <optional>
#include <string_view>

namespace gpu_planning_scene::core
{
/// The whole of `text` as a number, whatever the locale; "nan" and "inf" are numbers here, and the caller refuses them.
/// Nothing if it is not a number or too large for a double.
std::optional<double> parseNumber(std::string_view text);

/// The whole of `text` as a decimal integer.
std::optional<long long> parseInteger(std::string_view text);
}  // namespace gpu_planning_scene::core
