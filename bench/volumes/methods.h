#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "volumes/pairs.h"
#include "volumes/work.h"

namespace gpu_planning_scene::core::volumes
{
/// A kind of bounding volume with a traversal scheme.
class Method
{
 public:
  Method(std::string volume, std::string scheme, std::size_t bytes)
    : volume_(std::move(volume)), scheme_(std::move(scheme)), bytes_(bytes)
  {
  }
  virtual ~Method() = default;

  const std::string& volume() const { return volume_; }
  const std::string& scheme() const { return scheme_; }
  std::size_t bytes() const { return bytes_; }  ///< size of a node's volume

  /// For each state the index of its first colliding pair, or -1. Breadth-first schemes return 0 for any collision.
  virtual std::vector<int> check(const std::vector<std::size_t>& states, WorkCount& count) = 0;
  /// The same without counting, for timing. Returns the number of colliding states.
  virtual std::size_t run(const std::vector<std::size_t>& states) = 0;
  virtual bool reportsPair() const = 0;

 private:
  std::string volume_;
  std::string scheme_;
  std::size_t bytes_;
};

/// All volumes with all schemes, AABBs first. The methods keep a reference to `placed`.
std::vector<std::unique_ptr<Method>> makeMethods(const PlacedPairs& placed);
}  // namespace gpu_planning_scene::core::volumes
