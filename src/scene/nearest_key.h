#pragma once

#include <initializer_list>
#include <string>

namespace gpu_planning_scene::core
{
/// The name of `known` that was probably meant by `word`: the one with the fewest typing errors (a letter too many, too
/// few, another one, or two letters swapped), and at most one error for each three letters. Empty if no name is near.
std::string nearestKey(const std::string& word, std::initializer_list<const char*> known);
}  // namespace gpu_planning_scene::core
