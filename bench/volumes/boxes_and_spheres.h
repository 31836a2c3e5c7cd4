#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "collision/exact/forest.h"
#include "collision/geometry/cpu_box_pair.h"

namespace gpu_planning_scene::core::volumes
{
/// A bounding volume is a class with
///   static Volume fit(points)  a volume that holds the points, and kGrowth more on all sides;
///   holds(point)               whether it does;
///   size()                     a measure by which the larger of two nodes of its kind is opened;
///   kBytes                     what a node's volume takes in float32, without links;
///   Test                       made of the pose of tree b in the frame of tree a, which is the same for all their node
///                              pairs; overlap(a, b) is true where the volumes overlap, and may be where they do not.
/// Volumes are in the frames of their trees. All compute in double, as the CPU checker does.
using Points = Eigen::Ref<const Eigen::Matrix3Xd>;

constexpr double kGrowth = 1e-9;  // metres: for rounding, and for the slack within which triangles count as touching
constexpr std::size_t kFloat = 4;

struct Sphere
{
  static constexpr std::size_t kBytes = 4 * kFloat;

  Eigen::Vector3d center;
  double radius;

  static Sphere fit(const Points& points);
  bool holds(const Eigen::Vector3d& point) const { return (point - center).norm() <= radius; }
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

/// A box along the axes of its tree's frame.
struct AxisBox
{
  static constexpr std::size_t kBytes = 6 * kFloat;

  Eigen::Vector3d center;
  Eigen::Vector3d half;

  static AxisBox fit(const Points& points);
  bool holds(const Eigen::Vector3d& point) const { return ((point - center).cwiseAbs().array() <= half.array()).all(); }
  double size() const { return half.squaredNorm(); }
};

/// Boxes tested along the axes of a (then b's box is taken for the aligned box around it), or along those of a and b.
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

/// Boxes tested along all 15 axes that can separate them.
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

/// A box with axes of its own (OBB), tested along all 15.
struct OwnAxesBox : OrientedBox
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

/// As the CPU checker fits them.
struct FittedBox : OwnAxesBox
{
  static FittedBox fit(const Points& points);
};

/// Of several boxes, each turned until no small turn makes its surface smaller, the one with the least surface: from
/// the frame's axes, the main axes of the points, and those of the largest triangle (three points each).
struct TurnedBox : OwnAxesBox
{
  static TurnedBox fit(const Points& points);
};

/// An AABB, and an oriented box where a node has no more triangles than a leaf: tested where both have one, so before
/// triangles are.
struct AxisBoxOrientedLeaf
{
  static constexpr std::size_t kBytes = AxisBox::kBytes + OwnAxesBox::kBytes / 2;  // half of a tree's nodes are leaves

  AxisBoxByAllAxes box;
  bool leaf;
  TurnedBox oriented;  // where it is one

  static AxisBoxOrientedLeaf fit(const Points& points)
  {
    const bool leaf = points.cols() <= 3 * kLeafTriangles;
    return {AxisBoxByAllAxes::fit(points), leaf, leaf ? TurnedBox::fit(points) : TurnedBox{}};
  }
  bool holds(const Eigen::Vector3d& point) const { return box.holds(point) && (!leaf || oriented.holds(point)); }
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
    OwnAxesBox::Test leaves_;
  };
};
}  // namespace gpu_planning_scene::core::volumes
