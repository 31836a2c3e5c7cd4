#pragma once

// VAMP's headers include a sorting library of this name. Their trees of point clouds are the only users, and no
// benchmark has point clouds.

#include <algorithm>

template <class Iterator>
void pdqsort(Iterator begin, Iterator end)
{
  std::sort(begin, end);
}

template <class Iterator, class Less>
void pdqsort(Iterator begin, Iterator end, Less less)
{
  std::sort(begin, end, less);
}

template <class Iterator>
void pdqsort_branchless(Iterator begin, Iterator end)
{
  std::sort(begin, end);
}

template <class Iterator, class Less>
void pdqsort_branchless(Iterator begin, Iterator end, Less less)
{
  std::sort(begin, end, less);
}
