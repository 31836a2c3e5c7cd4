#pragma once
// Float32 arithmetic that uses every freedom of docs/error_bounds.md, as the seed chooses. Own method: a Float keeps
// the terms of the sum that it is, so that a later addition may evaluate all terms in another order, with fused
// operations. A `precise` expression rounds each operation on its own.

#include <math.h>
#include <string.h>

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
  memcpy(&value, &bits, sizeof(value));
  return value;
}
inline uint floatToBits(float value)
{
  uint bits;
  memcpy(&bits, &value, sizeof(bits));
  return bits;
}

inline float flushed(float x)
{
  if (x != 0.0f && fabsf(x) < 1.17549435e-38f && kernel().run->choose(kernel().run->arithmetic.flush))
    return 0.0f;
  return x;
}

/// The float that is `steps` floats above a finite one (below, if negative).
inline float stepped(float x, int steps)
{
  if (!isfinite(x) || steps == 0)
    return x;
  const float target = steps > 0 ? INFINITY : -INFINITY;
  for (int i = steps < 0 ? -steps : steps; i > 0 && isfinite(x); --i)
    x = nextafterf(x, target);
  return x;
}

/// `exact` as a float, in the direction of rounding that the seed chose.
inline float rounded(double exact)
{
  using Rounding = Arithmetic::Rounding;
  Run& run = *kernel().run;
  const float nearest = static_cast<float>(exact);
  float result = nearest;
  const Rounding rounding = run.arithmetic.rounding;
  if (rounding != Rounding::Nearest && isfinite(nearest) && static_cast<double>(nearest) != exact)
  {
    const bool random_up = rounding == Rounding::Random && (run.next() & 1U) != 0;
    const bool up = rounding == Rounding::Up || random_up || (rounding == Rounding::ToZero && exact < 0.0);
    if (up && nearest < exact)
      result = stepped(nearest, 1);
    if (!up && nearest > exact)
      result = stepped(nearest, -1);
  }
  return flushed(result);
}

/// `exact` with the error of a division or square root: up to 2.5 units in the last place.
inline float approximate(double exact)
{
  Run& run = *kernel().run;
  const int steps =
      run.arithmetic.steps == Arithmetic::kRandomSteps ? static_cast<int>(run.next() % 5) - 2 : run.arithmetic.steps;
  const float nearest = static_cast<float>(exact);
  return nearest == 0.0f ? nearest : flushed(stepped(nearest, steps));
}

struct Float
{
  static constexpr int kTerms = 4;
  struct Term  // a * b, rounded only when it is added
  {
    float a, b;
  };
  float value;
  int count;  // 0: `value` alone
  Term terms[kTerms];

  Float() : count(0) { value = bitsToFloat(0x7fc00001u); }
  explicit Float(float x) : value(x), count(0) {}
  explicit Float(double x) : value(static_cast<float>(x)), count(0) {}
  Float(int x) : value(static_cast<float>(x)), count(0) {}
  Float(uint x) : value(static_cast<float>(x)), count(0) {}
  Float(const Float& other) : value(other.value), count(other.count)
  {
    for (int i = 0; i < count; ++i)
      terms[i] = other.terms[i];
  }
  Float& operator=(const Float& other)
  {
    value = other.value;
    count = other.count;
    for (int i = 0; i < count; ++i)
      terms[i] = other.terms[i];
    return *this;
  }
  explicit operator uint() const { return value >= 4294967296.0f ? ~0U : value > 0.0f ? static_cast<uint>(value) : 0U; }
  explicit operator int() const { return static_cast<int>(value); }

  friend Float operator+(const Float& x, const Float& y) { return sum(x, y, 1.0f); }
  friend Float operator-(const Float& x, const Float& y) { return sum(x, y, -1.0f); }
  friend Float operator*(const Float& x, const Float& y)
  {
    Float r(rounded(static_cast<double>(x.value) * y.value));
    if (!kernel().run->lane->precise)
    {
      r.count = 1;
      r.terms[0] = {x.value, y.value};
    }
    return r;
  }
  friend Float operator/(const Float& x, const Float& y)
  {
    return Float(approximate(static_cast<double>(x.value) / y.value));
  }
  friend Float operator-(const Float& x)
  {
    Float r(x);
    r.value = -r.value;
    for (int i = 0; i < r.count; ++i)
      r.terms[i].a = -r.terms[i].a;
    return r;
  }
  friend Float& operator+=(Float& x, const Float& y) { return x = x + y; }
  friend Float& operator-=(Float& x, const Float& y) { return x = x - y; }
  friend Float& operator*=(Float& x, const Float& y) { return x = x * y; }
  friend Float& operator/=(Float& x, const Float& y) { return x = x / y; }

  friend bool operator<(const Float& x, const Float& y) { return compared(x, y, x.value < y.value); }
  friend bool operator>(const Float& x, const Float& y) { return compared(x, y, x.value > y.value); }
  friend bool operator<=(const Float& x, const Float& y) { return compared(x, y, x.value <= y.value); }
  friend bool operator>=(const Float& x, const Float& y) { return compared(x, y, x.value >= y.value); }
  friend bool operator==(const Float& x, const Float& y) { return compared(x, y, x.value == y.value); }
  friend bool operator!=(const Float& x, const Float& y) { return !(x == y); }

 private:
  static bool compared(const Float& x, const Float& y, bool result)
  {
    if (isnan(x.value) || isnan(y.value))
      return kernel().run->choose(kernel().run->arithmetic.nan_is_true);
    return result;
  }
  static void addTerms(const Float& x, float sign, Float& to)
  {
    if (x.count == 0)
      to.terms[to.count++] = {sign * x.value, 1.0f};
    for (int i = 0; i < x.count; ++i)
      to.terms[to.count++] = {sign * x.terms[i].a, x.terms[i].b};
  }
  static int termsOf(const Float& x) { return x.count == 0 ? 1 : x.count; }

  static Float sum(const Float& x, const Float& y, float sign)
  {
    Run& run = *kernel().run;
    const double plain = static_cast<double>(x.value) + static_cast<double>(sign) * y.value;
    if (run.lane->precise)
      return Float(rounded(plain));
    Float r;
    if (termsOf(x) + termsOf(y) > kTerms)
    {
      r.terms[0] = {x.value, 1.0f};
      r.terms[1] = {sign * y.value, 1.0f};
      r.count = 2;
      r.value = rounded(plain);
      return r;
    }
    addTerms(x, 1.0f, r);
    addTerms(y, sign, r);
    if (run.choose(run.arithmetic.reorder))
      r.value = reordered(r);
    else if (y.count == 1 && run.choose(run.arithmetic.contract))
      r.value = rounded(static_cast<double>(sign) * y.terms[0].a * y.terms[0].b + x.value);
    else if (x.count == 1 && run.choose(run.arithmetic.contract))
      r.value = rounded(static_cast<double>(x.terms[0].a) * x.terms[0].b + static_cast<double>(sign) * y.value);
    else
      r.value = rounded(plain);
    return r;
  }

  /// The sum of all terms in a random order. A fused operation adds a product before it is rounded.
  static float reordered(const Float& x)
  {
    Run& run = *kernel().run;
    double exact[kTerms];  // of each summand
    bool open[kTerms];     // it is a product that is not rounded yet
    int left = x.count;
    for (int i = 0; i < left; ++i)
    {
      exact[i] = static_cast<double>(x.terms[i].a) * x.terms[i].b;
      open[i] = x.terms[i].b != 1.0f;
    }
    while (left > 1)
    {
      const int i = static_cast<int>(run.next() % static_cast<uint>(left));
      int j = static_cast<int>(run.next() % static_cast<uint>(left - 1));
      j += j >= i ? 1 : 0;
      if (open[j])
        exact[j] = rounded(exact[j]);
      if (open[i] && !run.choose(run.arithmetic.contract))
        exact[i] = rounded(exact[i]);
      exact[i] = rounded(exact[i] + exact[j]);
      open[i] = false;
      --left;
      exact[j] = exact[left];
      open[j] = open[left];
    }
    return static_cast<float>(exact[0]);
  }
};

inline Float uintBitsToFloat(uint bits)
{
  return Float(flushed(bitsToFloat(bits)));
}
inline uint floatBitsToUint(const Float& x)
{
  return floatToBits(x.value);
}
inline Float sqrt(const Float& x)
{
  return Float(approximate(::sqrt(static_cast<double>(x.value))));
}
inline Float inversesqrt(const Float& x)
{
  return Float(approximate(1.0 / ::sqrt(static_cast<double>(x.value))));
}
inline Float abs(const Float& x)
{
  return Float(fabsf(x.value));
}
inline Float min(const Float& x, const Float& y)
{
  return y < x ? y : x;
}
inline Float max(const Float& x, const Float& y)
{
  return x < y ? y : x;
}
inline Float clamp(const Float& x, const Float& low, const Float& high)
{
  return min(max(x, low), high);
}
inline double sqrt(double x)
{
  return ::sqrt(x);
}
inline double abs(double x)
{
  return fabs(x);
}
inline double roundEven(double x)
{
  return nearbyint(x);
}
inline double min(double x, double y)
{
  return y < x ? y : x;
}
inline double max(double x, double y)
{
  return x < y ? y : x;
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
