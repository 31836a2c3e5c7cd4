#pragma once

#include <cstdint>
#include <vector>

#include "literature/method.h"
#include "literature/shared_tree.h"
#include "literature/trees/triangle_overlap.h"

namespace gpu_planning_scene::core::literature
{
enum class Search
{
  First,  ///< a query ends at the first pair of triangles that collide
  All     ///< a query finds all pairs
};

/// The parts that all trees share: the test of two leaves, and the counts of work. So they differ by their volumes and
/// their order alone.
class TreeMethod : public PosewiseMethod
{
 public:
  /// The tests of volumes and of triangles, and with Search::All the number of pairs that were found.
  WorkCounts work() const override;

 protected:
  /// The triangles of a and b must live as long as this object.
  TreeMethod(const std::vector<Triangle>& a, const std::vector<Triangle>& b, Search search);

  bool collides(const Eigen::Isometry3d& b_in_a) final;
  /// Traverses both trees until testLeaves ends the query. Returns whether it did.
  virtual bool traverse() = 0;
  /// Tests two triangles. Returns whether the query ends.
  bool testLeaves(std::uint32_t a, std::uint32_t b);
  void countVolumeTest() { ++volume_tests_; }
  const Eigen::Isometry3d& pose() const { return pose_; }  ///< of b in the frame of a

 private:
  struct TrianglePair
  {
    std::uint32_t a;
    std::uint32_t b;
  };

  const std::vector<Triangle>& a_;
  const std::vector<Triangle>& b_;
  Search search_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::vector<TrianglePair> pairs_;  // of this query
  double volume_tests_ = 0.0;
  double triangle_tests_ = 0.0;
  double pairs_found_ = 0.0;
};
}  // namespace gpu_planning_scene::core::literature
