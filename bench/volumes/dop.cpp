#include "volumes/dop.h"

#include <algorithm>
#include <cmath>

namespace gpu_planning_scene::core::volumes
{
namespace
{
using Eigen::Vector3d;
using Signs = Eigen::Vector3i;

std::size_t indexOf(const Signs& signs)
{
  return static_cast<std::size_t>(9 * (signs.x() + 1) + 3 * (signs.y() + 1) + signs.z() + 1);
}

/// `kind`: 1 for an axis, 2 for a face diagonal, 3 for a space diagonal.
bool belongs(int kind, int directions)
{
  return kind == 1 || (kind == 2 && directions != 14) || (kind == 3 && directions != 18);
}
}  // namespace

template <int kDirections>
DopDirections<kDirections>::DopDirections() : numbers_{}
{
  unsigned count = 0;
  for (int kind = 1; kind <= 3; ++kind)
    for (int code = 26; code > 13; --code)  // half of all sign patterns; the other half are their opposites
    {
      const Signs signs(code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
      if (signs.cwiseAbs().sum() != kind || !belongs(kind, kDirections))
        continue;
      numbers_[indexOf(signs)] = count;
      directions_[count++] = signs.cast<double>().normalized();
      numbers_[indexOf(-signs)] = count;
      directions_[count++] = -signs.cast<double>().normalized();
    }
}

template <int kDirections>
Cone DopDirections<kDirections>::around(const Vector3d& direction) const
{
  // By symmetry, the components are sorted to x >= y >= z >= 0.
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&direction](int i, int j) { return std::abs(direction[i]) > std::abs(direction[j]); });
  const double x = std::abs(direction[order[0]]);
  const double y = std::abs(direction[order[1]]);
  const double z = std::abs(direction[order[2]]);
  Cone cone{};
  int filled = 0;
  const auto add = [&](double weight, int along_x, int along_y, int along_z)
  {
    Signs signs;
    const std::array<int, 3> along = {along_x, along_y, along_z};
    for (int k = 0; k < 3; ++k)
      signs[order[k]] = direction[order[k]] < 0.0 ? -along[k] : along[k];
    cone.directions[filled] = numbers_[indexOf(signs)];
    cone.weights[filled++] = weight * std::sqrt(static_cast<double>(signs.squaredNorm()));
  };
  if (kDirections == 26)
  {
    add(x - y, 1, 0, 0);
    add(y - z, 1, 1, 0);
    add(z, 1, 1, 1);
  }
  else if (kDirections == 14)
  {
    add(x - y, 1, 0, 0);
    add(0.5 * (y + z), 1, 1, 1);
    add(0.5 * (y - z), 1, 1, -1);
  }
  else if (x >= y + z)
  {
    add(x - y - z, 1, 0, 0);
    add(y, 1, 1, 0);
    add(z, 1, 0, 1);
  }
  else
  {
    add(0.5 * (x + y - z), 1, 1, 0);
    add(0.5 * (x + z - y), 1, 0, 1);
    add(0.5 * (y + z - x), 0, 1, 1);
  }
  return cone;
}

template class DopDirections<14>;
template class DopDirections<18>;
template class DopDirections<26>;
}  // namespace gpu_planning_scene::core::volumes
