#pragma once

#include <cstddef>
#include <vector>

namespace gpu_planning_scene::core::volumes
{
/// Work at one level of the traversal. The level is the number of openings since the roots.
struct LevelWork
{
  std::size_t tests = 0;     ///< tests of two volumes
  std::size_t overlaps = 0;  ///< tests whose volumes overlap
  std::size_t leaf_pairs = 0;
  std::size_t triangle_pairs = 0;

  LevelWork& operator+=(const LevelWork& other)
  {
    tests += other.tests;
    overlaps += other.overlaps;
    leaf_pairs += other.leaf_pairs;
    triangle_pairs += other.triangle_pairs;
    return *this;
  }
};

/// Counts level by level.
class WorkCount
{
 public:
  void test(std::size_t level, bool overlap)
  {
    LevelWork& work = at(level);
    ++work.tests;
    work.overlaps += overlap ? 1 : 0;
  }
  void leafPair(std::size_t level) { ++at(level).leaf_pairs; }
  void trianglePair(std::size_t level) { ++at(level).triangle_pairs; }

  const std::vector<LevelWork>& levels() const { return levels_; }
  LevelWork total() const
  {
    LevelWork sum;
    for (const LevelWork& level : levels_)
      sum += level;
    return sum;
  }

 private:
  LevelWork& at(std::size_t level)
  {
    if (level >= levels_.size())
      levels_.resize(level + 1);
    return levels_[level];
  }

  std::vector<LevelWork> levels_;
};

/// Replaces WorkCount when time is measured.
struct NoCount
{
  void test(std::size_t, bool) {}
  void leafPair(std::size_t) {}
  void trianglePair(std::size_t) {}
};
}  // namespace gpu_planning_scene::core::volumes
