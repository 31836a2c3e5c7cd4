#pragma once

#include <array>
#include <cstddef>

#include "volumes/boxes_and_spheres.h"

namespace gpu_planning_scene::core::volumes
{
/// A direction as a combination of three directions of a k-DOP, with weights of at least 0. The same combination of the
/// extents is an upper bound on the extent along the direction.
struct Cone
{
  std::array<unsigned, 3> directions;
  std::array<double, 3> weights;
};

/// The directions of a k-DOP. Direction 2 i + 1 is the opposite of direction 2 i. 14-DOP: the axes and the space
/// diagonals of a cube. 18-DOP: the axes and the face diagonals. 26-DOP: all of these.
template <int kDirections>
class DopDirections
{
 public:
  DopDirections();
  const Eigen::Vector3d& operator[](unsigned number) const { return directions_[number]; }

  /// The three directions around `direction` (unit length), and the coordinates of `direction` in them, all at least 0.
  Cone around(const Eigen::Vector3d& direction) const;

 private:
  std::array<Eigen::Vector3d, kDirections> directions_;  // unit length
  std::array<unsigned, 27> numbers_;                     // by the signs of the components
};

/// A k-DOP: the extents of a volume along k fixed directions of its tree's frame (Klosowski et al., "Efficient
/// Collision Detection Using Bounding Volume Hierarchies of k-DOPs", 1998). The test compares slabs along the
/// directions of a, and with kBothSides also along the directions of b. For the comparison, the other DOP is enclosed
/// in a DOP that is aligned with these directions (Zachmann, "Rapid Collision Detection by Dynamically Aligned
/// DOP-Trees", 1998). The symmetries of a cube map the set of directions to itself. So the order of a direction's
/// components gives the three directions around it. FCL's 24-DOP leaves out one diagonal of the 26-DOP and does not
/// have this property.
template <int kDirections, bool kBothSides>
struct Dop
{
  static constexpr std::size_t kBytes = kDirections * kFloat;

  std::array<double, kDirections> reach;

  static const DopDirections<kDirections>& directions()
  {
    static const DopDirections<kDirections> made;
    return made;
  }

  static Dop fit(const Points& points)
  {
    Dop dop;
    for (unsigned i = 0; i < kDirections; ++i)
      dop.reach[i] = (directions()[i].transpose() * points).maxCoeff() + kGrowth;
    return dop;
  }

  bool contains(const Eigen::Vector3d& point) const
  {
    for (unsigned i = 0; i < kDirections; ++i)
      if (directions()[i].dot(point) > reach[i])
        return false;
    return true;
  }

  double size() const
  {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      sum += (reach[2 * axis] + reach[2 * axis + 1]) * (reach[2 * axis] + reach[2 * axis + 1]);
    return sum;
  }

  class Test
  {
   public:
    explicit Test(const Eigen::Isometry3d& b_in_a)
    {
      for (unsigned i = 0; i < kSlabs; ++i)
      {
        const Eigen::Vector3d& direction = directions()[2 * i];
        along_a_[i] = {directions().around(b_in_a.linear().transpose() * direction),
                       direction.dot(b_in_a.translation())};
        if constexpr (kBothSides)
        {
          const Eigen::Vector3d of_b = b_in_a.linear() * direction;
          along_b_[i] = {directions().around(of_b), -of_b.dot(b_in_a.translation())};
        }
      }
    }

    bool overlap(const Dop& a, const Dop& b) const
    {
      if (apart(a, b, along_a_))
        return false;
      if constexpr (kBothSides)
        return !apart(b, a, along_b_);
      return true;
    }

   private:
    static constexpr unsigned kSlabs = kDirections / 2;
    struct Slab
    {
      Cone cone;
      double shift;
    };

    static bool apart(const Dop& own, const Dop& other, const std::array<Slab, kSlabs>& slabs)
    {
      for (unsigned i = 0; i < kSlabs; ++i)
      {
        const Slab& slab = slabs[i];
        double up = 0.0;
        double down = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          up += slab.cone.weights[k] * other.reach[slab.cone.directions[k]];
          down += slab.cone.weights[k] * other.reach[slab.cone.directions[k] ^ 1U];
        }
        if (slab.shift - down > own.reach[2 * i] || slab.shift + up < -own.reach[2 * i + 1])
          return true;
      }
      return false;
    }

    std::array<Slab, kSlabs> along_a_;
    std::array<Slab, kBothSides ? kSlabs : 0> along_b_;
  };
};
}  // namespace gpu_planning_scene::core::volumes
