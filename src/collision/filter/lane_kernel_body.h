// The source of the lane kernel, included once for each instruction set, see lane_kernel.h.
//
// Eight states are checked side by side (as in Thomason, Kingston and Kavraki, "Motions in microseconds via vectorized
// sampling-based planning", 2024), first by joint tables and enclosing balls. The few pairs that remain are checked one
// state at a time, with eight balls side by side.
#ifndef GPS_LANE_KERNEL
#error "define the kernel's name before this file is included"
#endif

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

/// NaN stays NaN, so that it proves nothing.
inline Floats atLeastZero(const Floats& x)
{
  return x < 0.0F ? all(0.0F) : x;
}

inline Floats smaller(const Floats& a, const Floats& b)
{
  return a < b ? a : b;
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

/// Angles modulo 2 pi, in [-pi, pi].
inline double wrapped(double angle)
{
  constexpr double kTurn = 6.283185307179586;
  return angle - kTurn * __builtin_rint(angle / kTurn);
}

/// The value of a frame's joint in all lanes. Lanes beyond `count` repeat the first one.
inline Floats jointValues(const Frame& frame, const Model& model, const double* states, int count)
{
  Floats values;
  for (int lane = 0; lane < kLanes; ++lane)
  {
    const double* state = states + (lane < count ? static_cast<unsigned>(lane) : 0U) * model.width;
    const double value = frame.multiplier * state[frame.variable] + frame.offset;
    values[lane] = static_cast<float>(frame.kind == FrameKind::Turning ? wrapped(value) : value);
  }
  return values;
}

/// Writes the pose of a frame relative to its parent.
inline void relativePose(const Frame& frame, const float* given, const Model& model, const double* states, int count,
                         Floats* pose)
{
  for (int k = 0; k < 12; ++k)
    pose[k] = all(frame.constant[k]);
  switch (frame.kind)
  {
    case FrameKind::Fixed:
      break;
    case FrameKind::Turning:
    {
      Floats sine;
      Floats cosine;
      sineCosine(jointValues(frame, model, states, count), sine, cosine);
      for (int k = 0; k < 12; ++k)
        if (k % 4 != 3)
          pose[k] += cosine * frame.first[k] + sine * frame.second[k];
      break;
    }
    case FrameKind::Sliding:
    {
      const Floats value = jointValues(frame, model, states, count);
      for (int k = 3; k < 12; k += 4)
        pose[k] += value * frame.first[k];
      break;
    }
    case FrameKind::Given:
      for (std::size_t k = 0; k < 12; ++k)
        pose[k] = load(group(given, k));
      break;
  }
}

/// Forward kinematics of all lanes.
inline void placeFrames(const Model& model, const double* states, int count, const Scratch& scratch)
{
  for (std::size_t i = 0; i < model.frames.count; ++i)
  {
    const Frame& frame = model.frames[i];
    float* placed = group(scratch.frames, 12 * i);
    Floats relative[12];
    relativePose(frame, group(scratch.given, 12 * i), model, states, count, relative);
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

/// The centres of the enclosing balls in all lanes.
inline void placeCenters(const Model& model, const Scratch& scratch)
{
  for (std::size_t b = 0; b < model.bodies.count; ++b)
  {
    const Body& body = model.bodies[b];
    const float* frame = group(scratch.frames, 12 * static_cast<std::size_t>(body.frame));
    for (std::size_t row = 0; row < 3; ++row)
      store(load(group(frame, 4 * row)) * body.center[0] + load(group(frame, 4 * row + 1)) * body.center[1] +
                load(group(frame, 4 * row + 2)) * body.center[2] + load(group(frame, 4 * row + 3)),
            group(scratch.centers, 3 * b + row));
  }
}

inline Points centersOf(std::size_t body, const Scratch& scratch)
{
  const float* centers = group(scratch.centers, 3 * body);
  return {load(centers), load(group(centers, 1)), load(group(centers, 2))};
}

inline Floats squaredDistance(const Points& a, const Points& b)
{
  const Floats x = a.x - b.x;
  const Floats y = a.y - b.y;
  const Floats z = a.z - b.z;
  return x * x + y * y + z * z;
}

inline Floats squaredDistanceToBox(const Floats& x, const Floats& y, const Floats& z, const float* half)
{
  const Floats beyond_x = atLeastZero(magnitude(x) - half[0]);
  const Floats beyond_y = atLeastZero(magnitude(y) - half[1]);
  const Floats beyond_z = atLeastZero(magnitude(z) - half[2]);
  return beyond_x * beyond_x + beyond_y * beyond_y + beyond_z * beyond_z;
}

/// Squared distance, in a plane, from a segment that begins at (x, y) and runs along (dx, dy).
inline Floats squaredDistanceToSegment(const Floats& x, const Floats& y, float dx, float dy)
{
  Floats share = (x * dx + y * dy) * (1.0F / (dx * dx + dy * dy));
  share = smaller(atLeastZero(share), all(1.0F));
  const Floats beside_x = x - share * dx;
  const Floats beside_y = y - share * dy;
  return beside_x * beside_x + beside_y * beside_y;
}

/// The squared distances of points from a solid cone; 0 inside. In the half plane through the axis and the point, the
/// cone is a triangle.
inline Floats squaredDistanceToCone(const Floats& from_axis, const Floats& z, float radius, float half)
{
  const Floats to_base = squaredDistanceToSegment(from_axis, z + half, radius, 0.0F);
  const Floats to_side = squaredDistanceToSegment(from_axis - radius, z + half, -radius, 2.0F * half);
  const Ints inside = (z >= -half) & (2.0F * half * (from_axis - radius) + radius * (z + half) <= 0.0F);
  return inside ? all(0.0F) : smaller(to_base, to_side);
}

/// The squared distances of points in the planning frame from an object; 0 inside.
inline Floats squaredDistanceTo(const Object& object, const Points& points)
{
  const float* pose = object.from_planning_frame;
  const Floats x = pose[0] * points.x + pose[1] * points.y + pose[2] * points.z + pose[3];
  if (object.kind == ObjectKind::HalfSpace)
  {
    const Floats above = atLeastZero(x);
    return above * above;
  }
  const Floats y = pose[4] * points.x + pose[5] * points.y + pose[6] * points.z + pose[7];
  const Floats z = pose[8] * points.x + pose[9] * points.y + pose[10] * points.z + pose[11];
  switch (object.kind)
  {
    case ObjectKind::Sphere:
    {
      const Floats beyond = atLeastZero(squareRoot(x * x + y * y + z * z) - object.half[0]);
      return beyond * beyond;
    }
    case ObjectKind::Cylinder:
    {
      const Floats beside = atLeastZero(squareRoot(x * x + y * y) - object.half[0]);
      const Floats beyond = atLeastZero(magnitude(z) - object.half[1]);
      return beside * beside + beyond * beyond;
    }
    case ObjectKind::Cone:
      return squaredDistanceToCone(squareRoot(x * x + y * y), z, object.half[0], object.half[1]);
    default:
      return squaredDistanceToBox(x, y, z, object.half);
  }
}

/// The proofs of all lanes of a block, and the pairs that are still open.
struct Lanes
{
  int active;  ///< bits: lanes with a state that is not known to collide
  Block& block;
  std::uint32_t* open;
  std::uint32_t pairs;

  void collide(int lanes, std::uint32_t pair)
  {
    lanes &= active;
    active &= ~lanes;
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(static_cast<unsigned>(lanes));
      block.proof[lane] = Proof::Colliding;
      block.pair[lane] = pair;
    }
  }
  void keepOpen(int lanes, std::uint32_t pair)
  {
    for (lanes &= active; lanes != 0; lanes &= lanes - 1)
    {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(static_cast<unsigned>(lanes)));
      open[lane * pairs + static_cast<unsigned>(block.open_count[lane]++)] = pair;
    }
  }
};

inline Proof lookUp(const Table& table, const double* state)
{
  int cell = 0;
  for (int k = 0; k < table.variables; ++k)
  {
    const TableVariable& variable = table.variable[k];
    const double value = variable.wraps ? wrapped(state[variable.variable]) : state[variable.variable];
    const double place = (value - variable.lower) * variable.cells_per_unit;
    if (!(place >= 0.0 && place < variable.cells))
      return Proof::None;
    cell = cell * variable.cells + static_cast<int>(place);
  }
  return table.cells[cell];
}

inline void proveByTables(const Model& model, const double* states, Lanes& lanes)
{
  for (std::uint32_t t = 0; t < model.tables.count && lanes.active != 0; ++t)
  {
    const Table& table = model.tables[t];
    int colliding = 0;
    int open = 0;
    for (int left = lanes.active; left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(static_cast<unsigned>(left));
      const Proof proof = lookUp(table, states + static_cast<unsigned>(lane) * model.width);
      colliding |= (proof == Proof::Colliding ? 1 : 0) << lane;
      open |= (proof == Proof::None ? 1 : 0) << lane;
    }
    lanes.collide(colliding, table.pair);
    lanes.keepOpen(open, table.pair);
  }
}

inline float square(float x)
{
  return x * x;
}

/// Margins of the bodies and self pairs, if there are any.
template <bool kGiven>
struct MarginRows
{
  const float* rows;

  /// The squared sum of a length and the margins of a row.
  Floats squaredSum(float length, std::size_t row) const
  {
    if constexpr (kGiven)
    {
      const Floats sum = length + load(group(rows, row));
      return sum * sum;
    }
    return all(square(length));
  }
  float of(std::size_t row, int lane) const { return kGiven ? group(rows, row)[lane] : 0.0F; }
};

/// Proves by enclosing balls, for all lanes at once. Without margins, the tables have decided their pairs before.
template <bool kWithMargins>
inline void proveByEnclosingBalls(const Model& model, const Scratch& scratch, const MarginRows<kWithMargins>& margins,
                                  Lanes& lanes)
{
  const std::uint32_t first = kWithMargins ? 0 : model.tables.count;
  for (std::uint32_t p = first; p < model.self_pairs.count && lanes.active != 0; ++p)
  {
    const SelfPair& pair = model.self_pairs[p];
    const Body& a = model.bodies[pair.a];
    const Body& b = model.bodies[pair.b];
    const Floats squared = squaredDistance(centersOf(pair.a, scratch), centersOf(pair.b, scratch));
    const Floats apart = margins.squaredSum(a.outer + b.outer + pair.thresholds.enclosing, model.bodies.count + p);
    const float inner = a.inner + b.inner + pair.thresholds.inner;
    if (a.inner >= 0.0F && b.inner >= 0.0F && inner > 0.0F)
      lanes.collide(bits(squared < square(inner)), p);
    lanes.keepOpen(bits(~(squared > apart)), p);
  }
  for (std::uint32_t g = 0; g < model.world_groups.count && lanes.active != 0; ++g)
  {
    const WorldGroup& group = model.world_groups[g];
    const Body& body = model.bodies[group.body];
    const Points center = centersOf(group.body, scratch);
    const Floats to_group = squaredDistanceToBox(center.x - group.center[0], center.y - group.center[1],
                                                 center.z - group.center[2], group.half);
    if ((bits(~(to_group > margins.squaredSum(body.outer, group.body))) & lanes.active) == 0)
      continue;
    for (std::uint32_t w = group.first; w < group.end && lanes.active != 0; ++w)
    {
      const WorldPair& pair = model.world_pairs[w];
      const Object& object = model.objects[pair.object];
      const std::uint32_t number = model.self_pairs.count + w;
      const Floats squared = squaredDistanceTo(object, center);
      const float inner = body.inner + pair.thresholds.inner;
      if (body.inner >= 0.0F && inner > 0.0F && object.kind != ObjectKind::Hull)
        lanes.collide(bits(squared < square(inner)), number);
      const Floats apart = margins.squaredSum(body.outer + pair.thresholds.enclosing, group.body);
      lanes.keepOpen(bits(~(squared > apart)), number);
    }
  }
}

/// The distance between arrays of coordinates of placed balls.
constexpr std::ptrdiff_t kAxis = kBalls;

/// The balls of the bodies in one lane, in the planning frame.
class PlacedBalls
{
 public:
  PlacedBalls(const Model& model, const Scratch& scratch, int lane) : model_(model), scratch_(scratch), lane_(lane)
  {
    for (std::uint32_t b = 0; b < model.bodies.count; ++b)
      scratch.placed[b] = 0;
  }

  /// Coordinates x, y, z in arrays of kBalls: the outer balls, then the inner ones.
  const float* of(std::uint32_t body, int level) const
  {
    float* placed = scratch_.balls + std::size_t{kBallNumbers} * body;
    if ((scratch_.placed[body] & (1 << level)) == 0)
    {
      const Body& shape = model_.bodies[body];
      place(shape.frame, shape.outer_balls, level, placed);
      if (!shape.same_centers)
        place(shape.frame, shape.inner_balls, level, placed + 3 * kAxis);
      scratch_.placed[body] = static_cast<std::uint8_t>(scratch_.placed[body] | (1 << level));
    }
    return placed;
  }
  const float* innerOf(std::uint32_t body, int level) const
  {
    return of(body, level) + (model_.bodies[body].same_centers ? 0 : 3 * kAxis);
  }

  float center(std::size_t body, std::size_t axis) const { return group(scratch_.centers, 3 * body + axis)[lane_]; }

 private:
  void place(int frame, const Balls& balls, int level, float* placed) const
  {
    float pose[12];
    for (std::size_t k = 0; k < 12; ++k)
      pose[k] = group(scratch_.frames, 12 * static_cast<std::size_t>(frame) + k)[lane_];
    for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
    {
      const Floats x = load(balls.x + i);
      const Floats y = load(balls.y + i);
      const Floats z = load(balls.z + i);
      for (std::size_t row = 0; row < 3; ++row)
        store(pose[4 * row] * x + pose[4 * row + 1] * y + pose[4 * row + 2] * z + pose[4 * row + 3],
              placed + row * kAxis + i);
    }
  }

  const Model& model_;
  const Scratch& scratch_;
  int lane_;
};

inline Points pointsAt(const float* placed, int i)
{
  return {load(placed + i), load(placed + kAxis + i), load(placed + 2 * kAxis + i)};
}

inline Proof proveWorldPair(const Model& model, const WorldPair& pair, float margin, const PlacedBalls& balls,
                            int level)
{
  const Body& body = model.bodies[pair.body];
  const Object& object = model.objects[pair.object];
  const float* outer = balls.of(pair.body, level);
  const float* inner = balls.innerOf(pair.body, level);
  const float cover = pair.thresholds.cover + margin;
  Ints near = {};
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Floats squared = squaredDistanceTo(object, pointsAt(outer, i));
    const Floats apart = load(body.outer_balls.radius + i) + cover;
    near |= ~(squared > apart * apart);
    if (object.kind == ObjectKind::Hull)
      continue;
    const Floats within = load(body.inner_balls.radius + i) + pair.thresholds.inner;
    const Floats squared_inner = body.same_centers ? squared : squaredDistanceTo(object, pointsAt(inner, i));
    if (bits((within > 0.0F) & (squared_inner < within * within)) != 0)
      return Proof::Colliding;
  }
  return bits(near) == 0 ? Proof::Apart : Proof::None;
}

/// The balls of `b` on a level that are near the balls of `a` on the first level. Returns their number.
inline int nearBalls(const Body& a, const float* balls_of_a, const Body& b, const float* balls_of_b, float threshold,
                     int level, int* near)
{
  int count = 0;
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Points points = pointsAt(balls_of_b, i);
    const Floats reach = load(b.outer_balls.radius + i) + threshold;
    Ints is_near = {};
    for (int j = 0; j < kLevelBegin[1]; ++j)
    {
      const Points other = {all(balls_of_a[j]), all(balls_of_a[kAxis + j]), all(balls_of_a[2 * kAxis + j])};
      const Floats sum = reach + a.outer_balls.radius[j];
      is_near |= ~(squaredDistance(points, other) > sum * sum);
    }
    for (int left = bits(is_near); left != 0; left &= left - 1)
      near[count++] = i + __builtin_ctz(static_cast<unsigned>(left));
  }
  return count;
}

/// Proves by the balls of both bodies that are near the other body.
inline Proof proveSelfPair(const Model& model, const SelfPair& pair, float margin, const PlacedBalls& balls, int level)
{
  const Body& a = model.bodies[pair.a];
  const Body& b = model.bodies[pair.b];
  const float cover = pair.thresholds.cover + margin;
  const float* outer_a = balls.of(pair.a, level);
  const float* inner_a = balls.innerOf(pair.a, level);
  const float* outer_b = balls.of(pair.b, level);
  const float* inner_b = balls.innerOf(pair.b, level);
  const Points center_b = {all(balls.center(pair.b, 0)), all(balls.center(pair.b, 1)), all(balls.center(pair.b, 2))};

  int near_b[kMostBalls];
  const int near_count = nearBalls(a, balls.of(pair.a, 0), b, outer_b, cover, level, near_b);
  if (near_count == 0)
    return Proof::Apart;
  Ints near = {};
  for (int i = kLevelBegin[level]; i < kLevelBegin[level + 1]; i += kLanes)
  {
    const Points points = pointsAt(outer_a, i);
    const Floats reach = load(a.outer_balls.radius + i) + (b.outer + cover);
    if (bits(~(squaredDistance(points, center_b) > reach * reach)) == 0)
      continue;
    const Points witnesses = a.same_centers ? points : pointsAt(inner_a, i);
    const Floats apart = load(a.outer_balls.radius + i) + cover;
    const Floats within = load(a.inner_balls.radius + i) + pair.thresholds.inner;
    for (int k = 0; k < near_count; ++k)
    {
      const int j = near_b[k];
      const Points other = {all(outer_b[j]), all(outer_b[kAxis + j]), all(outer_b[2 * kAxis + j])};
      const Floats squared = squaredDistance(points, other);
      const Floats sum = apart + b.outer_balls.radius[j];
      near |= ~(squared > sum * sum);
      const Floats inner_sum = within + b.inner_balls.radius[j];
      const Points other_witness = {all(inner_b[j]), all(inner_b[kAxis + j]), all(inner_b[2 * kAxis + j])};
      const Floats squared_inner =
          a.same_centers && b.same_centers ? squared : squaredDistance(witnesses, other_witness);
      if (bits((inner_sum > 0.0F) & (squared_inner < inner_sum * inner_sum)) != 0)
        return Proof::Colliding;
    }
  }
  return bits(near) == 0 ? Proof::Apart : Proof::None;
}

/// Whether the balls of a level are worth testing: they decide the pair often enough, or too little is known, or it is
/// time to try again. The test of a level takes about 1 / kWorth of the time of the exact test.
inline bool isWorthwhile(Trial& trial, int level)
{
  constexpr unsigned kWorth[kLevels] = {25, 6};
  constexpr unsigned kFewTrials = 32;
  constexpr unsigned kAgain = 64;
  return trial.tried < kFewTrials || trial.decided * kWorth[level] >= trial.tried || ++trial.left_out % kAgain == 0;
}

inline void record(bool decided, Trial& trial)
{
  constexpr unsigned kManyTrials = 4096;
  if (++trial.tried == kManyTrials)  // so that the latest trials count most
  {
    trial.tried /= 2;
    trial.decided /= 2;
  }
  trial.decided = static_cast<std::uint16_t>(trial.decided + (decided ? 1 : 0));
}

/// Proves the open pairs of one lane by the balls of the covers, the coarse ones first.
template <bool kWithMargins>
inline void proveByCovers(const Model& model, const Scratch& scratch, const MarginRows<kWithMargins>& margins, int lane,
                          Lanes& lanes)
{
  const auto prove = [&](std::uint32_t number, const PlacedBalls& balls, int level)
  {
    if (number < model.self_pairs.count)
      return proveSelfPair(model, model.self_pairs[number], margins.of(model.bodies.count + number, lane), balls,
                           level);
    const WorldPair& pair = model.world_pairs[number - model.self_pairs.count];
    return proveWorldPair(model, pair, margins.of(pair.body, lane), balls, level);
  };
  const PlacedBalls balls(model, scratch, lane);
  std::uint32_t* open = lanes.open + static_cast<std::size_t>(lane) * lanes.pairs;
  for (int level = 0; level < kLevels; ++level)
  {
    int kept = 0;
    for (int k = 0; k < lanes.block.open_count[lane]; ++k)
    {
      const std::uint32_t number = open[k];
      Trial& trial = scratch.trials[std::size_t{kLevels} * number + static_cast<std::size_t>(level)];
      if (!isWorthwhile(trial, level))
      {
        open[kept++] = number;
        continue;
      }
      const Proof proof = prove(number, balls, level);
      record(proof != Proof::None, trial);
      if (proof == Proof::Colliding)
        return lanes.collide(1 << lane, number);
      if (proof == Proof::None)
        open[kept++] = number;
    }
    lanes.block.open_count[lane] = kept;
  }
}

template <bool kWithMargins>
inline void proveBlock(const Model& model, const double* states, int count, const MarginRows<kWithMargins>& margins,
                       const Scratch& scratch, Block& block)
{
  Lanes lanes{(1 << count) - 1, block, scratch.open, model.self_pairs.count + model.world_pairs.count};
  for (int lane = 0; lane < kLanes; ++lane)
  {
    block.proof[lane] = Proof::Apart;
    block.open_count[lane] = 0;
  }
  if constexpr (!kWithMargins)
    proveByTables(model, states, lanes);
  if (lanes.active == 0)
    return;
  placeFrames(model, states, count, scratch);
  placeCenters(model, scratch);
  proveByEnclosingBalls(model, scratch, margins, lanes);
  for (int lane = 0; lane < count; ++lane)
  {
    if ((lanes.active & (1 << lane)) == 0 || block.open_count[lane] == 0)
      continue;
    proveByCovers(model, scratch, margins, lane, lanes);
    if (block.proof[lane] != Proof::Colliding && block.open_count[lane] > 0)
      block.proof[lane] = Proof::None;
  }
}
}  // namespace

void GPS_LANE_KERNEL(const Model& model, const double* states, int count, const float* margins, const Scratch& scratch,
                     Block& block)
{
  if (margins)
    proveBlock(model, states, count, MarginRows<true>{margins}, scratch, block);
  else
    proveBlock(model, states, count, MarginRows<false>{nullptr}, scratch, block);
}
}  // namespace gpu_planning_scene::core::lanes
