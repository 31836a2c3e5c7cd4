#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "volumes/pairs.h"
#include "volumes/work.h"

namespace gpu_planning_scene::core::volumes
{
/// A kind of volume under a scheme of traversal.
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
  std::size_t bytes() const { return bytes_; }  ///< of a node's volume

  /// Which of each state's pairs is the first that collides; -1: none. Level by level: 0 if any of them does.
  virtual std::vector<int> check(const std::vector<std::size_t>& states, WorkCount& count) = 0;
  /// The same without counting, for times. Returns how many states collide.
  virtual std::size_t run(const std::vector<std::size_t>& states) = 0;
  virtual bool tellsPair() const = 0;

 private:
  std::string volume_;
  std::string scheme_;
  std::size_t bytes_;
};

/// All volumes under all schemes, AABBs first. They keep a reference to `placed`.
std::vector<std::unique_ptr<Method>> makeMethods(const PlacedPairs& placed);
}  // namespace gpu_planning_scene::core::volumes
