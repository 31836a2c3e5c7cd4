#include "model/meshes/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>

// A floating-point filter with the error bound of J. R. Shewchuk: Adaptive Precision Floating-Point Arithmetic and Fast
// Robust Geometric Predicates, 1997. What the filter leaves open is computed in integers of any length.
namespace gpu_planning_scene::core
{
namespace
{
using Integer = boost::multiprecision::cpp_int;

constexpr int kDigits = 53;  // of a double

/// The exponent of the last digit.
int lastDigit(double value)
{
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent - kDigits;
}

/// value / 2^unit; unit: at most lastDigit(value), unless the value is 0.
Integer integer(double value, int unit)
{
  if (value == 0.0)
    return 0;
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  const Integer digits = static_cast<std::int64_t>(std::ldexp(fraction, kDigits));
  return digits * (Integer(1) << static_cast<unsigned>(exponent - kDigits - unit));
}

int exactOrientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
  int unit = 0;
  for (const double value : {a.x(), a.y(), b.x(), b.y(), c.x(), c.y()})
    unit = value == 0.0 ? unit : std::min(unit, lastDigit(value));
  const Integer ax = integer(a.x(), unit);
  const Integer ay = integer(a.y(), unit);
  const Integer left = (integer(b.x(), unit) - ax) * (integer(c.y(), unit) - ay);
  const Integer right = (integer(b.y(), unit) - ay) * (integer(c.x(), unit) - ax);
  return left.compare(right);
}
}  // namespace

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d ac = c - a;
  // A difference of doubles is 0 only if they are equal. So these products are exact.
  if ((ab.x() == 0.0 || ac.y() == 0.0) && (ab.y() == 0.0 || ac.x() == 0.0))
    return 0;
  const double left = ab.x() * ac.y();
  const double right = ab.y() * ac.x();
  constexpr double kErrorBound = 3.3306690738754716e-16;  // (3 + 16 u) u, u = 2^-53
  constexpr double kUnderflow = 1e-300;                   // more than the errors of products that underflow
  if (std::abs(left - right) > kErrorBound * (std::abs(left) + std::abs(right)) + kUnderflow)
    return left > right ? 1 : -1;
  const int sign = exactOrientation(a, b, c);
  return sign > 0 ? 1 : (sign < 0 ? -1 : 0);
}
}  // namespace gpu_planning_scene::core
