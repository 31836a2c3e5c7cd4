#pragma once

#include <optional>
#include <string_view>

namespace gpu_planning_scene::core
{
/// Reads the whole of `text` as a number, in the same way in every locale. "nan" and "inf" are numbers here, and the
/// caller refuses them. No value if the text is not a number or too large for a double.
std::optional<double> parseNumber(std::string_view text);

/// Reads the whole of `text` as a decimal integer. No value if it is not one.
std::optional<long long> parseInteger(std::string_view text);
}  // namespace gpu_planning_scene::core
