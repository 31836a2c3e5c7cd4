#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// A text in UTF-8. A text that is not UTF-8 is read as ISO-8859-1: each byte is a letter of this encoding.
std::string inUtf8(std::string text);

/// An XML text in UTF-8, as of inUtf8, whatever its declaration says. The declaration of the result, if there is one,
/// says UTF-8.
std::string xmlInUtf8(std::string text);
}  // namespace gpu_planning_scene::core
