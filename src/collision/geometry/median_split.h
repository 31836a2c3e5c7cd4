#pragma once

#include <algorithm>
#include <iterator>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Splits elements at the median of the longest extent of their centres: the step of a top-down build of a bounding
/// volume tree (Ericson, "Real-Time Collision Detection", 2005, chapter 6). Reorders the elements and returns the first
/// element of the second half. `center_of`: returns the centre of an element, an Eigen::Vector3d.
template <class Iterator, class CenterOf>
Iterator splitAtMedian(Iterator begin, Iterator end, const CenterOf& center_of)
{
  Eigen::AlignedBox3d centers;
  for (Iterator element = begin; element != end; ++element)
    centers.extend(Eigen::Vector3d(center_of(*element)));
  int axis;
  centers.sizes().maxCoeff(&axis);
  const Iterator middle = begin + std::distance(begin, end) / 2;
  std::nth_element(begin, middle, end,
                   [&center_of, axis](const auto& a, const auto& b)
                   { return center_of(a)[axis] < center_of(b)[axis]; });
  return middle;
}

/// Orders elements so that neighbours in the sequence are near each other: each half is split again.
template <class Iterator, class CenterOf>
void sortBySplits(Iterator begin, Iterator end, const CenterOf& center_of)
{
  if (std::distance(begin, end) < 2)
    return;
  const Iterator middle = splitAtMedian(begin, end, center_of);
  sortBySplits(begin, middle, center_of);
  sortBySplits(middle, end, center_of);
}
}  // namespace gpu_planning_scene::core
