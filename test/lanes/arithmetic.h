#pragma once
// Arithmetic of floats and doubles that uses every freedom of docs/error_bounds.md, as the seed chooses. Own method: a
// number keeps the terms of the sum that it is, so that a later addition may evaluate all terms in another order, with
// fused operations, and a later product may multiply each term. A `precise` expression rounds each operation on its
// own.

#include <cmath>
#include <cstring>
#include <type_traits>

#include "lanes/host.h"

namespace lanes
{
using uint = std::uint32_t;

inline Kernel& kernel()
{
  static Kernel instance;
  return instance;
}

/// The body of a function: `precise` does not reach into it.
struct FunctionScope
{
  FunctionScope() : lane(*kernel().run->lane), before(lane.precise) { lane.precise = false; }
  ~FunctionScope() { lane.precise = before; }
  Lane& lane;
  bool before;
};

inline float bitsToFloat(uint bits)
{
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}
inline uint floatToBits(float value)
{
  uint bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// A float or double, and a wider type in which its operations have no error, or one that does not matter.
template <class T>
struct Format;
template <>
struct Format<float>
{
  using Wide = double;
  static constexpr float kLeastNormal = 1.17549435e-38f;
};
template <>
struct Format<double>
{
  using Wide = long double;
  static constexpr double kLeastNormal = 2.2250738585072014e-308;
};

template <class T>
T flushed(T x)
{
  if (x != T(0) && fabs(x) < Format<T>::kLeastNormal && kernel().run->choose(kernel().run->arithmetic.flush))
    return T(0);
  return x;
}

/// The number that is `steps` numbers of its format above a finite one (below, if negative).
template <class T>
T stepped(T x, int steps)
{
  if (!std::isfinite(x) || steps == 0)
    return x;
  const T target = steps > 0 ? T(INFINITY) : T(-INFINITY);
  for (int i = steps < 0 ? -steps : steps; i > 0 && std::isfinite(x); --i)
    x = std::nextafter(x, target);
  return x;
}

/// `exact` as a T, in the direction of rounding that the seed chose.
template <class T>
T rounded(typename Format<T>::Wide exact)
{
  using Rounding = Arithmetic::Rounding;
  Run& run = *kernel().run;
  const T nearest = static_cast<T>(exact);
  T result = nearest;
  const Rounding rounding = run.arithmetic.rounding;
  if (rounding != Rounding::Nearest && std::isfinite(nearest) && nearest != exact)
  {
    const bool random_up = rounding == Rounding::Random && (run.next() & 1U) != 0;
    const bool up = rounding == Rounding::Up || random_up || (rounding == Rounding::ToZero && exact < 0);
    if (up && nearest < exact)
      result = stepped(nearest, 1);
    if (!up && nearest > exact)
      result = stepped(nearest, -1);
  }
  return flushed(result);
}

/// `exact` with the error of a division or square root: up to 2.5 units in the last place.
template <class T>
T approximate(typename Format<T>::Wide exact)
{
  Run& run = *kernel().run;
  const int steps =
      run.arithmetic.steps == Arithmetic::kRandomSteps ? static_cast<int>(run.next() % 5) - 2 : run.arithmetic.steps;
  const T nearest = static_cast<T>(exact);
  return nearest == T(0) ? nearest : flushed(stepped(nearest, steps));
}

template <class T>
struct Real
{
  using Wide = typename Format<T>::Wide;
  static constexpr int kTerms = 4;
  struct Term  // a * b, rounded only when it is added
  {
    T a, b;
  };
  T value;
  int count;  // 0: `value` alone
  Term terms[kTerms];

  Real() : value(static_cast<T>(bitsToFloat(0x7fc00001u))), count(0) {}
  explicit Real(T x) : value(x), count(0) {}
  Real(int x) : value(static_cast<T>(x)), count(0) {}
  Real(uint x) : value(static_cast<T>(x)), count(0) {}
  template <class S>
  explicit Real(const Real<S>& x) : value(static_cast<T>(x.value)), count(0)
  {
  }
  Real(const Real& other) : value(other.value), count(other.validCount())
  {
    for (int i = 0; i < count; ++i)
      terms[i] = other.terms[i];
  }
  Real& operator=(const Real& other)
  {
    value = other.value;
    count = other.validCount();
    for (int i = 0; i < count; ++i)
      terms[i] = other.terms[i];
    return *this;
  }
  explicit operator uint() const { return value >= T(4294967296) ? ~0U : value > T(0) ? static_cast<uint>(value) : 0U; }
  explicit operator int() const { return static_cast<int>(value); }

  friend Real operator+(const Real& x, const Real& y) { return sum(x, y, T(1)); }
  friend Real operator-(const Real& x, const Real& y) { return sum(x, y, T(-1)); }
  friend Real operator*(const Real& x, const Real& y)
  {
    Run& run = *kernel().run;
    if (!run.lane->precise && x.count > 1 && y.count > 1 && x.count * y.count <= kTerms &&
        run.choose(run.arithmetic.distribute))
      return expanded(x, y);
    if (!run.lane->precise && x.count > 1 && run.choose(run.arithmetic.distribute))
      return distributed(x, y.value);
    if (!run.lane->precise && y.count > 1 && run.choose(run.arithmetic.distribute))
      return distributed(y, x.value);
    Real r(rounded<T>(static_cast<Wide>(x.value) * y.value));
    if (!run.lane->precise)
    {
      r.count = 1;
      r.terms[0] = {x.value, y.value};
    }
    return r;
  }
  friend Real operator/(const Real& x, const Real& y)
  {
    return Real(approximate<T>(static_cast<Wide>(x.value) / y.value));
  }
  friend Real operator-(const Real& x)
  {
    Real r(x);
    r.value = -r.value;
    for (int i = 0; i < r.count; ++i)
      r.terms[i].a = -r.terms[i].a;
    return r;
  }
  friend Real& operator+=(Real& x, const Real& y) { return x = x + y; }
  friend Real& operator-=(Real& x, const Real& y) { return x = x - y; }
  friend Real& operator*=(Real& x, const Real& y) { return x = x * y; }
  friend Real& operator/=(Real& x, const Real& y) { return x = x / y; }

  friend bool operator<(const Real& x, const Real& y) { return compared(x, y, x.value < y.value); }
  friend bool operator>(const Real& x, const Real& y) { return compared(x, y, x.value > y.value); }
  friend bool operator<=(const Real& x, const Real& y) { return compared(x, y, x.value <= y.value); }
  friend bool operator>=(const Real& x, const Real& y) { return compared(x, y, x.value >= y.value); }
  friend bool operator==(const Real& x, const Real& y) { return compared(x, y, x.value == y.value); }
  friend bool operator!=(const Real& x, const Real& y) { return !(x == y); }

 private:
  /// Shared memory that nobody wrote has random bytes, so `count` may be any number there.
  int validCount() const { return count >= 0 && count <= kTerms ? count : 0; }

  static bool compared(const Real& x, const Real& y, bool result)
  {
    if (std::isnan(x.value) || std::isnan(y.value))
      return kernel().run->choose(kernel().run->arithmetic.nan_is_true);
    return result;
  }
  static void addTerms(const Real& x, T sign, Real& to)
  {
    if (x.count == 0)
      to.terms[to.count++] = {sign * x.value, T(1)};
    for (int i = 0; i < x.count; ++i)
      to.terms[to.count++] = {sign * x.terms[i].a, x.terms[i].b};
  }
  static int termsOf(const Real& x) { return x.count == 0 ? 1 : x.count; }

  static Real sum(const Real& x, const Real& y, T sign)
  {
    Run& run = *kernel().run;
    const Wide plain = static_cast<Wide>(x.value) + static_cast<Wide>(sign) * y.value;
    if (run.lane->precise)
      return Real(rounded<T>(plain));
    Real r;
    if (termsOf(x) + termsOf(y) > kTerms)
    {
      r.terms[0] = {x.value, T(1)};
      r.terms[1] = {sign * y.value, T(1)};
      r.count = 2;
      r.value = rounded<T>(plain);
      return r;
    }
    addTerms(x, T(1), r);
    addTerms(y, sign, r);
    if (run.choose(run.arithmetic.reorder))
      r.value = reordered(r);
    else if (y.count == 1 && run.choose(run.arithmetic.contract))
      r.value = rounded<T>(static_cast<Wide>(sign) * y.terms[0].a * y.terms[0].b + x.value);
    else if (x.count == 1 && run.choose(run.arithmetic.contract))
      r.value = rounded<T>(static_cast<Wide>(x.terms[0].a) * x.terms[0].b + static_cast<Wide>(sign) * y.value);
    else
      r.value = rounded<T>(plain);
    return r;
  }

  /// The product of a sum and a factor, as the sum of the products of its terms.
  static Real distributed(const Real& x, T factor)
  {
    Real r;
    for (int i = 0; i < x.count; ++i)
      r.terms[i] = {valueOf(x.terms[i]), factor};
    r.count = x.count;
    r.value = reordered(r);
    return r;
  }

  /// The product of two sums, as the sum of the products of their terms.
  static Real expanded(const Real& x, const Real& y)
  {
    Real r;
    for (int i = 0; i < x.count; ++i)
      for (int j = 0; j < y.count; ++j)
        r.terms[r.count++] = {valueOf(x.terms[i]), valueOf(y.terms[j])};
    r.value = reordered(r);
    return r;
  }
  static T valueOf(const Term& term)
  {
    return term.b == T(1) ? term.a : rounded<T>(static_cast<Wide>(term.a) * term.b);
  }

  /// The sum of all terms in a random order. A fused operation adds a product before it is rounded.
  static T reordered(const Real& x)
  {
    Run& run = *kernel().run;
    Wide exact[kTerms];  // of each summand
    bool open[kTerms];   // it is a product that is not rounded yet
    int left = x.count;
    for (int i = 0; i < left; ++i)
    {
      exact[i] = static_cast<Wide>(x.terms[i].a) * x.terms[i].b;
      open[i] = x.terms[i].b != T(1);
    }
    while (left > 1)
    {
      const int i = static_cast<int>(run.next() % static_cast<uint>(left));
      int j = static_cast<int>(run.next() % static_cast<uint>(left - 1));
      j += j >= i ? 1 : 0;
      if (open[j])
        exact[j] = rounded<T>(exact[j]);
      if (open[i] && !run.choose(run.arithmetic.contract))
        exact[i] = rounded<T>(exact[i]);
      exact[i] = rounded<T>(exact[i] + exact[j]);
      open[i] = false;
      --left;
      exact[j] = exact[left];
      open[j] = open[left];
    }
    return static_cast<T>(exact[0]);
  }
};
using Float = Real<float>;
using Double = Real<double>;

inline Float uintBitsToFloat(uint bits)
{
  return Float(flushed(bitsToFloat(bits)));
}
inline uint floatBitsToUint(const Float& x)
{
  return floatToBits(x.value);
}
inline Float inversesqrt(const Float& x)
{
  return Float(approximate<float>(1.0 / ::sqrt(static_cast<double>(x.value))));
}
template <class T>
Real<T> sqrt(const Real<T>& x)
{
  return Real<T>(approximate<T>(std::sqrt(static_cast<typename Format<T>::Wide>(x.value))));
}
template <class T>
Real<T> abs(const Real<T>& x)
{
  return Real<T>(std::abs(x.value));
}
template <class T>
Real<T> min(const Real<T>& x, const Real<T>& y)
{
  return y < x ? y : x;
}
template <class T>
Real<T> max(const Real<T>& x, const Real<T>& y)
{
  return x < y ? y : x;
}
inline Float clamp(const Float& x, const Float& low, const Float& high)
{
  return min(max(x, low), high);
}
/// A device without such an operation rounds the product first, also in a `precise` expression.
template <class T>
Real<T> fma(const Real<T>& x, const Real<T>& y, const Real<T>& z)
{
  using Wide = typename Format<T>::Wide;
  Run& run = *kernel().run;
  if (!run.lane->precise)
    return x * y + z;
  const Wide exact = static_cast<Wide>(x.value) * y.value;
  const Wide product = run.choose(run.arithmetic.contract) ? exact : static_cast<Wide>(rounded<T>(exact));
  return Real<T>(rounded<T>(product + static_cast<Wide>(z.value)));
}
inline Double roundEven(const Double& x)
{
  return Double(nearbyint(x.value));
}
inline uint min(uint x, uint y)
{
  return y < x ? y : x;
}
inline uint max(uint x, uint y)
{
  return x < y ? y : x;
}
}  // namespace lanes
