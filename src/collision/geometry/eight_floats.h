#pragma once

// Before its version 13, GCC does not define __AVX__ after a #pragma GCC target. So the files with such a pragma define
// GPS_AVX.
#if defined(__AVX__) && !defined(GPS_AVX)
#define GPS_AVX
#endif

// Eight floats side by side, in the vector extension of GCC and Clang: operators work on all eight. Each user is
// compiled for several instruction sets, so the functions are private to the file that includes this one, and they call
// no function that other files define inline.
namespace gpu_planning_scene::core
{
namespace
{
typedef float Floats __attribute__((vector_size(32)));
typedef int Ints __attribute__((vector_size(32)));

inline Floats all(float x)
{
  return Floats{x, x, x, x, x, x, x, x};
}

inline Floats load(const float* from)
{
  Floats loaded;
  __builtin_memcpy(&loaded, from, sizeof loaded);
  return loaded;
}

/// Four floats in both halves.
inline Floats loadTwice(const float* from)
{
#if defined(GPS_AVX) && !defined(__clang__)  // clang has no such function, and finds the instruction itself
  typedef float Four __attribute__((vector_size(16)));
  Four loaded;
  __builtin_memcpy(&loaded, from, sizeof loaded);
  return __builtin_ia32_vbroadcastf128_ps256(&loaded);
#else
  return Floats{from[0], from[1], from[2], from[3], from[0], from[1], from[2], from[3]};
#endif
}

/// `a` in the first four elements, `b` in the others.
inline Floats halves(float a, float b)
{
  return Floats{a, a, a, a, b, b, b, b};
}

inline void store(const Floats& values, float* to)
{
  __builtin_memcpy(to, &values, sizeof values);
}

/// Bit i: element i is true.
inline int bits(const Ints& truth)
{
#ifdef GPS_AVX
  return __builtin_ia32_movmskps256(reinterpret_cast<Floats>(truth));
#else
  int found = 0;
  for (int i = 0; i < 8; ++i)
    found |= (truth[i] & 1) << i;
  return found;
#endif
}

inline Floats squareRoot(const Floats& x)
{
#ifdef GPS_AVX
  return __builtin_ia32_sqrtps256(x);
#else
  Floats root;
  for (int i = 0; i < 8; ++i)
    root[i] = __builtin_sqrtf(x[i]);
  return root;
#endif
}

/// Where an element is NaN, the second operand.
inline Floats smaller(const Floats& a, const Floats& b)
{
#ifdef GPS_AVX
  return __builtin_ia32_minps256(a, b);
#else
  return a < b ? a : b;
#endif
}

/// Where an element is NaN, the second operand.
inline Floats larger(const Floats& a, const Floats& b)
{
#ifdef GPS_AVX
  return __builtin_ia32_maxps256(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Floats magnitude(const Floats& x)
{
  return reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) & 0x7fffffff);
}
}  // namespace
}  // namespace gpu_planning_scene::core
