#pragma once
// The types and functions of GLSL that the shaders use. Each translated shader (glsl_to_cpp.py) includes this file and
// becomes a library. The arithmetic of Float is adversarial: see arithmetic.h.

#include <string.h>

#include "lanes/arithmetic.h"

namespace lanes
{
template <class T, int N>
struct Components;
template <class T>
struct Components<T, 2>
{
  T x, y;
};
template <class T>
struct Components<T, 3>
{
  T x, y, z;
};
template <class T>
struct Components<T, 4>
{
  T x, y, z, w;
};

inline void requireIndex(bool good, const char* text)
{
  if (!good)
    kernel().run->memory->fault(text);
}

template <class T, int N>
struct vec : Components<T, N>
{
  vec() {}
  vec(T value)
  {
    for (int i = 0; i < N; ++i)
      (*this)[i] = value;
  }
  template <class... A>
  explicit vec(const A&... parts)
  {
    int at = 0;
    (append(parts, at), ...);
    for (; at < N; ++at)
      (*this)[at] = (*this)[0];
  }
  T& operator[](int i)
  {
    requireIndex(i >= 0 && i < N, "an index exceeds a vector");
    return (&this->x)[i];
  }
  const T& operator[](int i) const { return const_cast<vec&>(*this)[i]; }
  template <int... I>
  vec<T, sizeof...(I)> swizzle() const
  {
    return vec<T, sizeof...(I)>((*this)[I]...);
  }

 private:
  template <class S>
  void append(const S& value, int& at)
  {
    if (at < N)
      (*this)[at++] = static_cast<T>(value);
  }
  template <class S, int M>
  void append(const vec<S, M>& values, int& at)
  {
    for (int i = 0; i < M; ++i)
      append(values[i], at);
  }

#define LANES_OPERATOR(op)                           \
  friend vec operator op(const vec& a, const vec& b) \
  {                                                  \
    vec r;                                           \
    for (int i = 0; i < N; ++i)                      \
      r[i] = a[i] op b[i];                           \
    return r;                                        \
  }                                                  \
  friend vec& operator op##=(vec& a, const vec& b)   \
  {                                                  \
    return a = a op b;                               \
  }
  LANES_OPERATOR(+)
  LANES_OPERATOR(-)
  LANES_OPERATOR(*)
  LANES_OPERATOR(/)
#undef LANES_OPERATOR
  friend vec operator-(const vec& a)
  {
    vec r;
    for (int i = 0; i < N; ++i)
      r[i] = -a[i];
    return r;
  }
};

using vec2 = vec<Float, 2>;
using vec3 = vec<Float, 3>;
using vec4 = vec<Float, 4>;
using uvec2 = vec<uint, 2>;
using uvec3 = vec<uint, 3>;
using uvec4 = vec<uint, 4>;
using bvec3 = vec<bool, 3>;
using dvec2 = vec<Double, 2>;
using dvec3 = vec<Double, 3>;
using dvec4 = vec<Double, 4>;

#define LANES_ONE(name)              \
  template <class T, int N>          \
  vec<T, N> name(const vec<T, N>& a) \
  {                                  \
    vec<T, N> r;                     \
    for (int i = 0; i < N; ++i)      \
      r[i] = name(a[i]);             \
    return r;                        \
  }
#define LANES_TWO(name)                                  \
  template <class T, int N>                              \
  vec<T, N> name(const vec<T, N>& a, const vec<T, N>& b) \
  {                                                      \
    vec<T, N> r;                                         \
    for (int i = 0; i < N; ++i)                          \
      r[i] = name(a[i], b[i]);                           \
    return r;                                            \
  }                                                      \
  template <class T, int N>                              \
  vec<T, N> name(const vec<T, N>& a, T b)                \
  {                                                      \
    return name(a, vec<T, N>(b));                        \
  }
LANES_ONE(abs)
LANES_TWO(min)
LANES_TWO(max)
#undef LANES_ONE
#undef LANES_TWO

template <class T, int N>
vec<T, N> clamp(const vec<T, N>& x, const vec<T, N>& low, const vec<T, N>& high)
{
  return min(max(x, low), high);
}
template <class T, int N>
vec<T, N> clamp(const vec<T, N>& x, T low, T high)
{
  return min(max(x, low), high);
}

template <int N>
vec<bool, N> greaterThan(const vec<Float, N>& a, const vec<Float, N>& b)
{
  vec<bool, N> r;
  for (int i = 0; i < N; ++i)
    r[i] = a[i] > b[i];
  return r;
}
template <int N>
vec<bool, N> lessThan(const vec<Float, N>& a, const vec<Float, N>& b)
{
  return greaterThan(b, a);
}
template <int N>
bool any(const vec<bool, N>& a)
{
  bool r = false;
  for (int i = 0; i < N; ++i)
    r = r || a[i];
  return r;
}
template <int N>
bool all(const vec<bool, N>& a)
{
  bool r = true;
  for (int i = 0; i < N; ++i)
    r = r && a[i];
  return r;
}

// The operations within these functions may be contracted and reordered even in a `precise` expression, because
// compilers see only the call.
template <class T, int N>
T dot(const vec<T, N>& a, const vec<T, N>& b)
{
  const FunctionScope scope;
  T sum = a[0] * b[0];
  for (int i = 1; i < N; ++i)
    sum = sum + a[i] * b[i];
  return sum;
}
inline vec3 cross(const vec3& a, const vec3& b)
{
  const FunctionScope scope;
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
template <int N>
Float length(const vec<Float, N>& a)
{
  return sqrt(dot(a, a));
}
template <int N>
vec<Float, N> normalize(const vec<Float, N>& a)
{
  const FunctionScope scope;
  return a * vec<Float, N>(inversesqrt(dot(a, a)));
}

template <class T>
struct Matrix
{
  vec<T, 3> columns[3];

  Matrix() {}
  Matrix(const vec<T, 3>& a, const vec<T, 3>& b, const vec<T, 3>& c) : columns{a, b, c} {}
  Matrix(T a, T b, T c, T d, T e, T f, T g, T h, T i)
    : columns{vec<T, 3>(a, b, c), vec<T, 3>(d, e, f), vec<T, 3>(g, h, i)}
  {
  }
  explicit Matrix(T diagonal) : Matrix(diagonal, T(0), T(0), T(0), diagonal, T(0), T(0), T(0), diagonal) {}
  template <class S>
  explicit Matrix(const Matrix<S>& m) : columns{vec<T, 3>(m[0]), vec<T, 3>(m[1]), vec<T, 3>(m[2])}
  {
  }
  vec<T, 3>& operator[](int i)
  {
    requireIndex(i >= 0 && i < 3, "an index exceeds a matrix");
    return columns[i];
  }
  const vec<T, 3>& operator[](int i) const { return const_cast<Matrix&>(*this)[i]; }

  friend vec<T, 3> operator*(const vec<T, 3>& v, const Matrix& m)
  {
    return vec<T, 3>(dot(v, m[0]), dot(v, m[1]), dot(v, m[2]));
  }
  friend vec<T, 3> operator*(const Matrix& m, const vec<T, 3>& v) { return v * transpose(m); }
  friend Matrix operator*(const Matrix& a, const Matrix& b) { return Matrix(a * b[0], a * b[1], a * b[2]); }
  friend Matrix transpose(const Matrix& m)
  {
    return Matrix(m[0].x, m[1].x, m[2].x, m[0].y, m[1].y, m[2].y, m[0].z, m[1].z, m[2].z);
  }
};
using mat3 = Matrix<Float>;
using dmat3 = Matrix<Double>;

template <class T, int N>
struct array
{
  T elements[N];
  T& operator[](long long i)
  {
    requireIndex(i >= 0 && i < N, "an index exceeds an array");
    return elements[i >= 0 && i < N ? i : 0];
  }
  const T& operator[](long long i) const { return const_cast<array&>(*this)[i]; }
};
template <class T, class... A>
array<T, sizeof...(A)> makeArray(const A&... values)
{
  return {{values...}};
}

// `precise`: the result takes no part in later contractions.
template <class T>
void settle(T&)
{
}
template <class T>
void settle(Real<T>& x)
{
  x.count = 0;
}
template <class T, int N>
void settle(vec<T, N>& x)
{
  for (int i = 0; i < N; ++i)
    settle(x[i]);
}
template <class F>
auto precisely(const F& compute)
{
  Lane& lane = *kernel().run->lane;
  const bool before = lane.precise;
  lane.precise = true;
  auto result = compute();
  kernel().run->lane->precise = before;
  settle(result);
  return result;
}

inline int findLSB(uint x)
{
  return __builtin_ffs(static_cast<int>(x)) - 1;
}
inline int bitCount(uint x)
{
  return __builtin_popcount(x);
}
template <int N>
vec<Float, N> uintBitsToFloat(const vec<uint, N>& bits)
{
  vec<Float, N> r;
  for (int i = 0; i < N; ++i)
    r[i] = uintBitsToFloat(bits[i]);
  return r;
}
template <int N>
vec<uint, N> floatBitsToUint(const vec<Float, N>& values)
{
  vec<uint, N> r;
  for (int i = 0; i < N; ++i)
    r[i] = floatBitsToUint(values[i]);
  return r;
}
inline Double packDouble2x32(const uvec2& words)
{
  double value;
  memcpy(&value, &words, sizeof(value));
  return Double(value);
}

// --- Variables of a kernel -----------------------------------------------------------------------------------------
inline Variable& addVariable(Variable::Kind kind, uint place, const char* name)
{
  Variable& added = kernel().variables[kernel().variable_count++];
  added = {kind, place, 0, 0, 0, name, nullptr};
  return added;
}

struct WorkGroupSize
{
  explicit WorkGroupSize(uint size) { kernel().group_size = size; }
};
struct UniformPlace
{
  UniformPlace(uint location, void* value) { addVariable(Variable::Uniform, location, "").value = value; }
};
struct usamplerBuffer
{
  uint unit;
};
inline uvec4 texelFetch(usamplerBuffer texels, int at)
{
  uvec4 values;
  kernel().run->memory->fetch(texels.unit, at, &values.x);
  return values;
}

// The words of a value in a storage buffer.
inline void pack(uint value, uint*& words)
{
  *words++ = value;
}
inline void pack(Float value, uint*& words)
{
  *words++ = floatBitsToUint(value);
}
inline void pack(Double value, uint*& words)
{
  memcpy(words, &value.value, sizeof(double));
  words += 2;
}
template <class T, int N>
void pack(const vec<T, N>& value, uint*& words)
{
  for (int i = 0; i < N; ++i)
    pack(value[i], words);
}
inline void unpack(uint& value, const uint*& words)
{
  value = *words++;
}
inline void unpack(Float& value, const uint*& words)
{
  value = uintBitsToFloat(*words++);
}
inline void unpack(Double& value, const uint*& words)
{
  value = Double();
  memcpy(&value.value, words, sizeof(double));
  words += 2;
}
template <class T, int N>
void unpack(vec<T, N>& value, const uint*& words)
{
  for (int i = 0; i < N; ++i)
    unpack(value[i], words);
}
template <class T>
constexpr int kWords = sizeof(T) / 4;
template <>
inline constexpr int kWords<Float> = 1;
template <int N>
inline constexpr int kWords<vec<Float, N>> = N;
template <>
inline constexpr int kWords<Double> = 2;
template <int N>
inline constexpr int kWords<vec<Double, N>> = 2 * N;

/// A place to which the operators of assignment store.
template <class M, class T>
struct Place
{
  const M& memory;
  uint index;
  void operator=(const T& value) const { memory.set(index, value); }
  void operator+=(const T& value) const { memory.set(index, memory.load(index) + value); }
  T operator++(int) const
  {
    const T before = memory.load(index);
    memory.set(index, before + T(1));
    return before;
  }
};

/// An atomic operation's first argument: a word of a storage buffer or of shared memory.
template <class M>
struct AtomicPlace
{
  const M& memory;
  uint index;
};
template <class M>
uint atomicAdd(AtomicPlace<M> place, uint value)
{
  return place.memory.update(place.index, AtomicOperation::Add, value);
}
template <class M>
uint atomicOr(AtomicPlace<M> place, uint value)
{
  return place.memory.update(place.index, AtomicOperation::Or, value);
}
template <class M>
uint atomicMax(AtomicPlace<M> place, uint value)
{
  return place.memory.update(place.index, AtomicOperation::Max, value);
}

template <class M>
uint atomicExchange(AtomicPlace<M> place, uint value)
{
  return place.memory.update(place.index, AtomicOperation::Exchange, value);
}
template <class M>
uint atomicCompSwap(AtomicPlace<M> place, uint compared, uint value)
{
  return place.memory.update(place.index, AtomicOperation::CompareSwap, value, compared);
}

template <class T>
struct Storage
{
  Storage(uint binding, uint flags, const char* name) : binding(binding)
  {
    addVariable(Variable::StorageBlock, binding, name).flags = flags;
  }
  T load(uint i) const
  {
    uint words[kWords<T>];
    kernel().run->memory->load(binding, static_cast<unsigned long long>(i) * kWords<T>, kWords<T>, words);
    T value;
    const uint* at = words;
    unpack(value, at);
    return value;
  }
  void set(uint i, const T& value) const
  {
    uint words[kWords<T>];
    uint* at = words;
    pack(value, at);
    kernel().run->memory->store(binding, static_cast<unsigned long long>(i) * kWords<T>, kWords<T>, words);
  }
  Place<Storage, T> store(uint i) const { return {*this, i}; }
  AtomicPlace<Storage> atomic(uint i) const { return {*this, i}; }
  uint update(uint i, AtomicOperation operation, uint value, uint compared = 0) const
  {
    return kernel().run->memory->atomic(binding, i, operation, value, compared);
  }
  uint binding;
};

template <class T, int N>
struct Shared
{
  explicit Shared(const char* name) : offset(kernel().shared_bytes)
  {
    Variable& variable = addVariable(Variable::SharedMemory, offset, name);
    variable.size = sizeof(T);
    variable.count = N;
    kernel().shared_bytes += (N * sizeof(T) + 15) / 16 * 16;
  }
  T load(uint i) const { return at(i, SharedAccess::Read); }
  void set(uint i, const T& value) const
  {
    T& place = at(i, SharedAccess::Read, false);
    const bool same = memcmp(&place, &value, sizeof(T)) == 0;
    at(i, same ? SharedAccess::WriteSame : SharedAccess::Write) = value;
  }
  Place<Shared, T> store(uint i) const { return {*this, i}; }
  AtomicPlace<Shared> atomic(uint i) const { return {*this, i}; }
  /// The whole array, for calls that read or write all of it.
  array<T, N>& whole() const
  {
    for (uint i = 0; i < N; ++i)
      at(i, SharedAccess::Write);
    return reinterpret_cast<array<T, N>&>(at(0, SharedAccess::Write));
  }
  uint update(uint i, AtomicOperation operation, uint value) const
  {
    T& place = at(i, SharedAccess::Atomic);
    const uint before = place;
    place = operation == AtomicOperation::Add  ? before + value
            : operation == AtomicOperation::Or ? before | value
                                               : (before > value ? before : value);
    return before;
  }

 private:
  T& at(uint i, SharedAccess access, bool counted = true) const
  {
    requireIndex(i < N, "an index exceeds a shared array");
    if (i >= N)
      i = 0;
    if (!counted)
      return *static_cast<T*>(kernel().run->memory->shared(offset + i * sizeof(T), kNoPlace, access));
    return *static_cast<T*>(kernel().run->memory->shared(offset + i * sizeof(T), i, access));
  }
  uint offset;
};

inline void barrier(int site)
{
  kernel().run->memory->barrier(site);
}
#define gl_WorkGroupSize (uvec3(kernel().group_size, 1u, 1u))
#define gl_LocalInvocationID (uvec3(kernel().run->lane->local, 0u, 0u))
#define gl_WorkGroupID (uvec3(kernel().run->lane->group[0], kernel().run->lane->group[1], kernel().run->lane->group[2]))
#define gl_NumWorkGroups \
  (uvec3(kernel().run->lane->groups[0], kernel().run->lane->groups[1], kernel().run->lane->groups[2]))
}  // namespace lanes

extern "C" lanes::Kernel* lanesKernel()
{
  return &lanes::kernel();
}
