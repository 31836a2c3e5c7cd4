#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The name of `known` that was probably meant by `word`: the one with the fewest typing errors (a letter too many, too
/// few, another one, or two letters swapped), and at most one error for each three letters. Empty if no name is near.
std::string nearestKey(const std::string& word, const std::vector<std::string>& known);

/// The letters and digits of a key in lower case: collisionObjects, Collision-Objects and collision_objects agree.
std::string plainKey(const std::string& key);

/// The nearest name of `known` as nearestKey finds it, where only the plain keys are compared.
std::string nearestSpelling(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean 'NAME'?" with the nearest name of `known`; empty if no name is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);
}  // namespace gpu_planning_scene::core
