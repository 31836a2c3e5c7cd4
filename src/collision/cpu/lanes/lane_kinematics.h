// Part of the lane kernel, see lane_kernel_body.h: forward kinematics of eight states side by side. A rotation is a
// constant plus the cosine and the sine of the joint value times constants (Rodrigues' formula), as in Kinematics.
#pragma once

#include "base/strict_arithmetic.h"
#include "collision/cpu/lanes/lane_model.h"
#include "collision/geometry/eight_floats.h"

namespace gpu_planning_scene::core::lanes
{
namespace
{
/// Group `i` of kLanes floats.
inline const float* group(const float* groups, std::size_t i)
{
  return groups + i * kLanes;
}

inline float* group(float* groups, std::size_t i)
{
  return groups + i * kLanes;
}

/// Sine and cosine of |x| <= pi, within 1e-6. Taylor polynomials after a reduction to [-pi/4, pi/4].
inline void sineCosine(const Floats& x, Floats& sine, Floats& cosine)
{
  const Floats quarters = x * 0.63661977F + (x < 0.0F ? all(-0.5F) : all(0.5F));
  const Ints quarter = __builtin_convertvector(quarters, Ints);  // rounded towards zero
  const Floats whole = __builtin_convertvector(quarter, Floats);
  // pi / 2 = 1.5707964 - 4.371139e-8
  const Floats r = x - whole * 1.57079637F + whole * 4.37113883e-8F;
  const Floats s = r * r;
  const Floats sine_of_r =
      r + r * s * (-1.66666667e-1F + s * (8.33333333e-3F + s * (-1.98412698e-4F + s * 2.75573e-6F)));
  const Floats cosine_of_r = 1.0F + s * (-0.5F + s * (4.16666667e-2F + s * (-1.38888889e-3F + s * 2.48015873e-5F)));
  const Ints odd = -(quarter & 1);
  const Floats in_sine = odd ? cosine_of_r : sine_of_r;
  const Floats in_cosine = odd ? sine_of_r : cosine_of_r;
  sine = (quarter & 2) != 0 ? -in_sine : in_sine;
  cosine = ((quarter + 1) & 2) != 0 ? -in_cosine : in_cosine;
}

typedef double Doubles __attribute__((vector_size(64)));

/// Angles modulo 2 pi, in [-pi, pi].
inline Doubles wrapped(const Doubles& angles)
{
  constexpr double kTurn = 6.283185307179586;
  constexpr double kRounds = 0x1.8p52;  // a sum with it has no fraction
  const Doubles turns = angles * (1.0 / kTurn) + kRounds - kRounds;
  return angles - kTurn * turns;
}

inline double wrapped(double angle)
{
  constexpr double kTurn = 6.283185307179586;
  return angle - kTurn * __builtin_rint(angle / kTurn);
}

/// The value of a frame's joint in all lanes. Lanes beyond `count` repeat the first one.
inline Floats jointValues(const Frame& frame, const Model& model, const double* states, int count)
{
  Doubles values;
  for (int lane = 0; lane < kLanes; ++lane)
    values[lane] =
        states[(lane < count ? static_cast<unsigned>(lane) : 0U) * model.width + static_cast<unsigned>(frame.variable)];
  values = frame.multiplier * values + frame.offset;
  return __builtin_convertvector(frame.kind == FrameKind::Revolute ? wrapped(values) : values, Floats);
}

/// Writes the rotation of a frame of kind Turned. A quaternion that is too short for float arithmetic gives NaN, which
/// proves nothing.
inline void turn(const Frame& frame, const Model& model, const double* states, int count, Floats* pose)
{
  constexpr float kLeastSquaredNorm = 1e-12F;
  Floats q[4];
  for (int lane = 0; lane < kLanes; ++lane)
  {
    const double* state = states + (lane < count ? static_cast<unsigned>(lane) : 0U) * model.width;
    for (int k = 0; k < 4; ++k)
      q[k][lane] = static_cast<float>(state[frame.variable + k]);
  }
  const Floats squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const Floats scale = squared > kLeastSquaredNorm ? 2.0F / squared : all(__builtin_nanf(""));
  const Floats x = scale * q[0];
  const Floats y = scale * q[1];
  const Floats z = scale * q[2];
  pose[0] = 1.0F - (y * q[1] + z * q[2]);
  pose[1] = x * q[1] - z * q[3];
  pose[2] = x * q[2] + y * q[3];
  pose[4] = x * q[1] + z * q[3];
  pose[5] = 1.0F - (x * q[0] + z * q[2]);
  pose[6] = y * q[2] - x * q[3];
  pose[8] = x * q[2] - y * q[3];
  pose[9] = y * q[2] + x * q[3];
  pose[10] = 1.0F - (x * q[0] + y * q[1]);
  pose[3] = pose[7] = pose[11] = all(0.0F);
}

/// Writes the pose of a frame relative to its parent.
inline void relativePose(const Frame& frame, const Model& model, const double* states, int count, Floats* pose)
{
  for (int k = 0; k < 12; ++k)
    pose[k] = all(frame.constant[k]);
  switch (frame.kind)
  {
    case FrameKind::Fixed:
      break;
    case FrameKind::Revolute:
    {
      Floats sine;
      Floats cosine;
      sineCosine(jointValues(frame, model, states, count), sine, cosine);
      for (int k = 0; k < 12; ++k)
        if (k % 4 != 3)
          pose[k] += cosine * frame.first[k] + sine * frame.second[k];
      break;
    }
    case FrameKind::Prismatic:
    {
      const Floats value = jointValues(frame, model, states, count);
      for (int k = 3; k < 12; k += 4)
        pose[k] += value * frame.first[k];
      break;
    }
    case FrameKind::Turned:
      turn(frame, model, states, count, pose);
      break;
  }
}

inline std::uint64_t bitsOf(double value)
{
  std::uint64_t bits;
  __builtin_memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// Whether all states have these values of the base's variables, bit for bit.
inline bool allHaveBase(const Model& model, const double* states, int count, const double* values)
{
  for (int lane = 0; lane < count; ++lane)
  {
    const double* const base = states + static_cast<unsigned>(lane) * model.width + model.base.variable;
    std::uint64_t difference = 0;
    for (int k = 0; k < model.base.variables; ++k)
      difference |= bitsOf(base[k]) ^ bitsOf(values[k]);
    if (difference != 0)
      return false;
  }
  return true;
}

/// Whether the frames of the base are still those of these states. If not, the caller must compute them now, and they
/// are kept for the next block if all states have the same base. They then hold in all lanes, because lanes beyond
/// `count` repeat the first one.
inline bool keepsBase(const Model& model, const double* states, int count, const Scratch& scratch)
{
  const bool is_set = scratch.base[0] == scratch.base[0];  // not NaN
  if (is_set && allHaveBase(model, states, count, scratch.base))
    return true;
  const double* const first = states + model.base.variable;
  const bool is_same = allHaveBase(model, states, count, first);
  for (int k = 0; k < model.base.variables; ++k)
    scratch.base[k] = is_same ? first[k] : __builtin_nan("");
  return false;
}

/// Forward kinematics of all lanes.
inline void placeFrames(const Model& model, const double* states, int count, const Scratch& scratch)
{
  const bool is_base_kept = model.base.frames > 0 && keepsBase(model, states, count, scratch);
  for (std::size_t i = is_base_kept ? model.base.frames : 0; i < model.frames.count; ++i)
  {
    const Frame& frame = model.frames[i];
    float* placed = group(scratch.frames, 12 * i);
    Floats relative[12];
    relativePose(frame, model, states, count, relative);
    if (frame.parent < 0)
    {
      for (std::size_t k = 0; k < 12; ++k)
        store(relative[k], group(placed, k));
      continue;
    }
    const float* parent = group(scratch.frames, 12 * static_cast<std::size_t>(frame.parent));
    for (std::size_t row = 0; row < 3; ++row)
    {
      const Floats x = load(group(parent, 4 * row));
      const Floats y = load(group(parent, 4 * row + 1));
      const Floats z = load(group(parent, 4 * row + 2));
      for (std::size_t column = 0; column < 4; ++column)
      {
        Floats sum = x * relative[column] + y * relative[4 + column] + z * relative[8 + column];
        if (column == 3)
          sum += load(group(parent, 4 * row + 3));
        store(sum, group(placed, 4 * row + column));
      }
    }
  }
}

struct Points
{
  Floats x;
  Floats y;
  Floats z;
};

/// The centres of the enclosing balls and of the clusters in all lanes.
inline void placeCenters(const Model& model, const Scratch& scratch)
{
  for (std::size_t b = 0; b < model.instances.count; ++b)
  {
    const Instance& instance = model.instances[b];
    const float* frame = group(scratch.frames, 12 * static_cast<std::size_t>(instance.frame));
    for (std::size_t row = 0; row < 3; ++row)
      store(load(group(frame, 4 * row)) * instance.center[0] + load(group(frame, 4 * row + 1)) * instance.center[1] +
                load(group(frame, 4 * row + 2)) * instance.center[2] + load(group(frame, 4 * row + 3)),
            group(scratch.centers, 3 * b + row));
  }
  for (std::size_t c = 0; c < model.clusters.count; ++c)
  {
    const float* frame = group(scratch.frames, 12 * static_cast<std::size_t>(model.clusters[c].frame));
    for (std::size_t row = 0; row < 3; ++row)
      store(load(group(frame, 4 * row + 3)), group(scratch.centers, 3 * (model.instances.count + c) + row));
  }
}

inline Points centersOf(std::size_t instance, const Scratch& scratch)
{
  const float* centers = group(scratch.centers, 3 * instance);
  return {load(centers), load(group(centers, 1)), load(group(centers, 2))};
}
}  // namespace
}  // namespace gpu_planning_scene::core::lanes
