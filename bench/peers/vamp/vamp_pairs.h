#pragma once

#include <set>
#include <string>
#include <utility>

namespace gpu_planning_scene::core::benchmark
{
/// Pairs of links, by name; the first name of a pair is the lower one.
using LinkPairs = std::set<std::pair<std::string, std::string>>;

/// The pair of two links in either order.
std::pair<std::string, std::string> linkPair(const std::string& a, const std::string& b);

/// The pairs of links that VAMP's check of a robot tests against each other. `path`: VAMP's generated header, in which
/// a comment names each pair. Throws Error if the file cannot be read or names no pair.
LinkPairs readVampPairs(const std::string& path);
}  // namespace gpu_planning_scene::core::benchmark
