#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "collision/exact/forest.h"
#include "collision/geometry/cpu_box_pair.h"

namespace gpu_planning_scene::core::volumes
{
/// A bounding volume is a class with
///   static Volume fit(points)  a volume that contains the points with a margin of kGrowth on all sides;
///   contains(point)            whether the volume contains the point;
///   size()                     a measure of size; a traversal may open the larger of two nodes;
///   kBytes                     size of a node's volume in float32, without links;
///   Test                       constructed from the pose of tree b in the frame of tree a, which is the same for all
///                              pairs of their nodes. overlap(a, b) is true if the volumes overlap. It may also be true
///                              for volumes that are apart.
/// Volumes are in the frames of their trees. All computations are in double, as in the CPU checker.
using Points = Eigen::Ref<const Eigen::Matrix3Xd>;

constexpr double kGrowth = 1e-9;  // metres: covers rounding and the tolerance within which triangles count as touching
constexpr std::size_t kFloat = 4;

struct Sphere
{
  static constexpr std::size_t kBytes = 4 * kFloat;

  Eigen::Vector3d center;
  double radius;

  static Sphere fit(const Points& points);
  bool contains(const Eigen::Vector3d& point) const { return (point - center).norm() <= radius; }
  double size() const { return radius; }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a) : b_in_a_(b_in_a) {}
    bool overlap(const Sphere& a, const Sphere& b) const
    {
      const double reach = a.radius + b.radius;
      return (b_in_a_ * b.center - a.center).squaredNorm() <= reach * reach;
    }

   private:
    Eigen::Isometry3d b_in_a_;
  };
};

/// A box along the axes of its tree's frame (AABB).
struct AxisBox
{
  static constexpr std::size_t kBytes = 6 * kFloat;

  Eigen::Vector3d center;
  Eigen::Vector3d half;

  static AxisBox fit(const Points& points);
  bool contains(const Eigen::Vector3d& point) const
  {
    return ((point - center).cwiseAbs().array() <= half.array()).all();
  }
  double size() const { return half.squaredNorm(); }
};

/// AABBs that are tested along the axes of a, or along the axes of a and b. The test along a's axes replaces b's box by
/// its bounding box along these axes.
template <bool kAxesOfB>
struct AxisBoxByFaces : AxisBox
{
  static AxisBoxByFaces fit(const Points& points) { return {AxisBox::fit(points)}; }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a) : b_in_a_(b_in_a), abs_r_(b_in_a.linear().cwiseAbs()) {}
    bool overlap(const AxisBox& a, const AxisBox& b) const
    {
      const Eigen::Vector3d t = b_in_a_ * b.center - a.center;
      for (int i = 0; i < 3; ++i)
        if (std::abs(t[i]) > a.half[i] + abs_r_.row(i).dot(b.half))
          return false;
      if constexpr (kAxesOfB)
        for (int j = 0; j < 3; ++j)
          if (std::abs(t.dot(b_in_a_.linear().col(j))) > a.half.dot(abs_r_.col(j)) + b.half[j])
            return false;
      return true;
    }

   private:
    Eigen::Isometry3d b_in_a_;
    Eigen::Matrix3d abs_r_;
  };
};

/// AABBs that are tested along all 15 separating axes (Gottschalk, Lin and Manocha 1996, "OBBTree").
struct AxisBoxByAllAxes : AxisBox
{
  static AxisBoxByAllAxes fit(const Points& points) { return {AxisBox::fit(points)}; }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a) : b_in_a_(b_in_a), boxes_(b_in_a.linear()) {}
    bool overlap(const AxisBox& a, const AxisBox& b) const
    {
      return boxes_.overlap(a.half, b.half, b_in_a_ * b.center - a.center);
    }

   private:
    Eigen::Isometry3d b_in_a_;
    BoxPairTest boxes_;
  };
};

/// An oriented box (OBB), tested along all 15 separating axes.
struct OrientedBoxVolume : OrientedBox
{
  static constexpr std::size_t kBytes = 15 * kFloat;

  double size() const { return half.squaredNorm(); }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a) : b_in_a_(b_in_a) {}
    bool overlap(const OrientedBox& a, const OrientedBox& b) const
    {
      return gpu_planning_scene::core::overlap(a, placed(b, b_in_a_), 0.0);
    }

   private:
    Eigen::Isometry3d b_in_a_;
  };
};

/// An oriented box with the fit of the CPU checker.
struct FittedBox : OrientedBoxVolume
{
  static FittedBox fit(const Points& points);
};

/// The oriented box with the smallest surface among several candidates. The candidates start with the frame's axes, the
/// principal axes of the points, and the axes of the largest triangle (three points per triangle). Each is rotated in
/// small steps until no step makes its surface smaller.
struct RefinedOrientedBox : OrientedBoxVolume
{
  static RefinedOrientedBox fit(const Points& points);
};

/// An AABB, and an oriented box for a node with no more triangles than a leaf. Two oriented boxes are tested before the
/// triangles of their nodes.
struct AxisBoxOrientedLeaf
{
  static constexpr std::size_t kBytes =
      AxisBox::kBytes + OrientedBoxVolume::kBytes / 2;  // half of a tree's nodes are leaves

  AxisBoxByAllAxes box;
  bool leaf;
  RefinedOrientedBox oriented;  // only of a leaf

  static AxisBoxOrientedLeaf fit(const Points& points)
  {
    const bool leaf = points.cols() <= 3 * kLeafTriangles;
    return {AxisBoxByAllAxes::fit(points), leaf, leaf ? RefinedOrientedBox::fit(points) : RefinedOrientedBox{}};
  }
  bool contains(const Eigen::Vector3d& point) const
  {
    return box.contains(point) && (!leaf || oriented.contains(point));
  }
  double size() const { return box.size(); }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a) : boxes_(b_in_a), leaves_(b_in_a) {}
    bool overlap(const AxisBoxOrientedLeaf& a, const AxisBoxOrientedLeaf& b) const
    {
      return boxes_.overlap(a.box, b.box) && !(a.leaf && b.leaf && !leaves_.overlap(a.oriented, b.oriented));
    }

   private:
    AxisBoxByAllAxes::Test boxes_;
    OrientedBoxVolume::Test leaves_;
  };
};
}  // namespace gpu_planning_scene::core::volumes
