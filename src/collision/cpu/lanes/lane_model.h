#pragma once

#include <cstddef>
#include <cstdint>

#include "collision/proofs/proof.h"

/// The scene as the lane kernel reads it: plain arrays of numbers, because the kernel is compiled for instruction sets
/// that other code must not use. Lengths are in metres. A *lane* is one of the states that the kernel checks at the
/// same time.
namespace gpu_planning_scene::core::lanes
{
constexpr int kLanes = 8;

/// The balls of levels 1 and 2 of a cover follow each other. kLevelBegin[k - 1] is the first ball of level k.
constexpr int kLevels = 2;
constexpr int kLevelBegin[kLevels + 1] = {0, 8, 40};
constexpr int kBalls = kLevelBegin[kLevels];
constexpr int kMostBalls = kBalls - kLevelBegin[kLevels - 1];  ///< of a level

enum class FrameKind : std::uint8_t
{
  Fixed,      ///< pose: constant
  Revolute,   ///< pose: constant + cos(value) * first + sin(value) * second
  Prismatic,  ///< pose: constant + value * first
  Turned      ///< pose: the rotation of a quaternion, whose x, y, z, w are `variable` and the next three
};

/// A frame that a joint moves relative to its parent frame. A planar joint has three of them, two that slide and one
/// that turns; a floating joint has four. Poses are rows of 3x4 matrices.
struct Frame
{
  FrameKind kind;
  int parent;  ///< an earlier frame; -1: the planning frame
  int variable;
  double multiplier;  ///< value = multiplier * variable + offset
  double offset;
  float constant[12];
  float first[12];
  float second[12];
};

/// The first frames of a robot whose first moving joint is planar or floating: those of this joint, and fixed ones
/// before it. Often all states have the same values of its variables, for example if a group moves only the arm. Then
/// these frames are computed once and not in each block.
struct Base
{
  std::uint32_t frames;  ///< their number; 0: the first moving joint is of another type
  int variable;          ///< the joint's first variable
  int variables;
};
constexpr int kMostBaseVariables = 7;  ///< those of a floating joint

/// Balls as arrays of coordinates. Unused places hold copies of used ones.
struct Balls
{
  float x[kBalls];
  float y[kBalls];
  float z[kBalls];
  float radius[kBalls];
};

/// An oriented box around an instance, in its frame.
struct Box
{
  float axes[3][3];  ///< [i][k]: coordinate k of axis i
  float center[3];
  float half[3];
};
constexpr int kBoxNumbers = 12;  ///< of a placed box: three axes and the centre

/// An instance that moves with the robot, with its box and the balls of its cover in its frame.
struct Instance
{
  int frame;
  float center[3];  ///< of the enclosing ball
  float outer;
  float inner;  ///< of the enclosing ball; negative: its centre is not inside the shape
  Box box;
  bool same_centers;  ///< the witnesses are the centres of the outer balls
  Balls outer_balls;
  Balls inner_balls;
};

enum class ObjectKind : std::uint8_t
{
  Box,
  Sphere,
  Cylinder,
  Cone,
  HalfSpace,   ///< all points with x <= 0 in its frame
  BoundingBox  ///< a box around a mesh: it proves only that instances are apart
};

struct Object
{
  ObjectKind kind;
  float from_planning_frame[12];
  float half[3];  ///< Box, BoundingBox: half lengths; Sphere: radius; Cylinder, Cone: radius and half length
};

/// Lengths that a proof needs in addition to the radii of the balls. They include the rounding errors of the kernel.
struct Thresholds
{
  float enclosing;  ///< apart, by the enclosing balls: the distance is greater than the radii plus this
  float cover;      ///< apart, by the balls of the covers: the same
  float inner;      ///< colliding: the distance is less than the inner radii plus this; may be negative
};

/// Additions to the test of two boxes, which make up for the rounding errors of the kernel.
struct BoxThresholds
{
  float growth;    ///< metres, to the half lengths of the second box
  float parallel;  ///< to the absolute values of the relative rotation
};

/// A box along the axes of the planning frame. Its half lengths include the rounding errors of a test.
struct FrameBox
{
  float center[3];
  float half[3];
};

struct SelfPair
{
  std::uint32_t a;
  std::uint32_t b;
  Thresholds thresholds;
  BoxThresholds boxes;
};

/// A ball around several instances, for example those of a hand. They stay in the ball in all states for which
/// LaneScene::isWithinBounds is true. Its centre is the origin of a frame.
struct Cluster
{
  int frame;
  float radius;
};

/// Consecutive self pairs without tables. Each has an instance near the first centre and one near the second. All pairs
/// are apart if the distance of the centres is greater than `reach`.
struct SelfGroup
{
  std::uint32_t centers[2];  ///< numbers in Scratch::centers
  float reach;               ///< includes the rounding errors; infinite: the pairs are always tested
  std::uint32_t first;
  std::uint32_t end;
};

struct WorldPair
{
  std::uint32_t instance;
  std::uint32_t object;
  Thresholds thresholds;
  FrameBox box;  ///< of the centres of the instance's enclosing ball at which it is not proven apart
};

/// Consecutive world pairs of one instance. The box contains their objects, grown by `enclosing`.
struct WorldGroup
{
  std::uint32_t instance;
  std::uint32_t first;
  std::uint32_t end;
  FrameBox box;
};

/// A variable of a joint table.
struct TableAxis
{
  int variable;
  bool wraps;  ///< the angle counts modulo 2 pi
  double lower;
  double cells_per_unit;
  int cells;
};

/// The joint table of a self pair. With one variable, the second one has a single cell.
struct Table
{
  std::uint32_t pair;
  int variables;
  TableAxis variable[2];
  const Proof* cells;
};

template <class T>
struct Array
{
  const T* data;
  std::uint32_t count;

  const T& operator[](std::size_t i) const { return data[i]; }
};

/// Pairs are numbered: first the self pairs, then the world pairs. The self pairs with tables come first, in the order
/// of the tables.
struct Model
{
  std::size_t width;  ///< variables of a state
  Base base;
  Array<Frame> frames;
  Array<Instance> instances;
  Array<Object> objects;
  Array<Table> tables;
  Array<Cluster> clusters;
  Array<SelfPair> self_pairs;
  Array<SelfGroup> self_groups;  ///< of all self pairs without tables
  Array<WorldPair> world_pairs;
  Array<WorldGroup> world_groups;
};

/// How often a test has decided a pair. A test that hardly ever decides a pair is left out.
struct Trial
{
  std::uint16_t tried;
  std::uint16_t decided;
  std::uint16_t left_out;
};

/// The tests of a pair that may be left out: its boxes, then the levels of its balls. Pairs with the world have no test
/// of boxes.
constexpr int kTests = 1 + kLevels;
constexpr int kBoxTest = 0;

/// A pair without a proof in some lanes.
struct OpenPair
{
  std::uint32_t pair;
  std::uint32_t lanes;  ///< bits
};

/// Work space of one thread.
struct Scratch
{
  float* frames;         ///< of each frame: 12 numbers in all lanes; those of the base are kept between calls
  double* base;          ///< kMostBaseVariables values, for which the frames of the base are set; NaN: they are not set
  float* centers;        ///< of each instance: the centre of its enclosing ball in all lanes; then of each cluster
  float* balls;          ///< of each instance: the coordinates of its outer and inner balls in one lane
  float* boxes;          ///< of each instance: its box in all lanes
  std::uint8_t* placed;  ///< of each instance: which of these balls are set
  std::uint8_t* placed_boxes;  ///< of each instance: 1 if its box is set
  std::uint32_t* open;         ///< of each lane: the pairs without a proof; room for all pairs
  OpenPair* open_pairs;        ///< of all lanes; room for all pairs
  Trial* trials;               ///< of each pair: its tests; all 0 at first, kept between calls
};
constexpr int kBallNumbers = 6 * kBalls;

/// The last stage that a state needed.
enum class Stage : std::uint8_t
{
  JointTables,
  EnclosingBalls,  ///< and the boxes of self pairs
  FewBalls,        ///< of the first level of the covers
  ManyBalls,       ///< of the second level
  ExactPairs       ///< the kernel did not decide the state
};
constexpr std::size_t kStages = 5;

/// The verdicts of a block of states.
struct Block
{
  Proof proof[kLanes];
  std::uint32_t pair[kLanes];  ///< proof Colliding: the pair
  int open_count[kLanes];      ///< proof None: the number of pairs without a proof; they are in Scratch::open
  Stage stage[kLanes];
  std::uint64_t (*clock)() = nullptr;       ///< nanoseconds; null: the stages are not timed
  std::uint64_t nanoseconds[kStages] = {};  ///< of each stage of the kernel
};
}  // namespace gpu_planning_scene::core::lanes
