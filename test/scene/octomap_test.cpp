// Octomaps as objects: their leaves are those of liboctomap, wrong data are refused, and changes keep or clear them.

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <sstream>

#include "gpu_planning_scene/error.h"
#include "scene/change_testing.h"
#include "scene/changes/octree_cubes.h"
#include "scene/random_octree.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

/// Centre and edge length of a cube.
using CubeNumbers = std::array<double, 4>;

std::vector<CubeNumbers> sorted(std::vector<CubeNumbers> cubes)
{
  std::sort(cubes.begin(), cubes.end());
  return cubes;
}

std::vector<CubeNumbers> numbersOf(const std::vector<PlacedShape>& cubes)
{
  std::vector<CubeNumbers> numbers;
  for (const PlacedShape& cube : cubes)
  {
    const Eigen::Vector3d& size = std::get<Box>(cube.shape).size;
    EXPECT_TRUE(size == Eigen::Vector3d::Constant(size.x()));
    EXPECT_TRUE(cube.pose.linear() == Eigen::Matrix3d::Identity());
    const Eigen::Vector3d center = cube.pose.translation();
    numbers.push_back({center.x(), center.y(), center.z(), size.x()});
  }
  return sorted(numbers);
}

template <class Tree>
std::vector<CubeNumbers> occupiedOf(const Tree& tree)
{
  std::vector<CubeNumbers> numbers;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    if (tree.isNodeOccupied(*leaf))
    {
      const octomap::OcTreeKey& key = leaf.getKey();
      const unsigned depth = leaf.getDepth();
      numbers.push_back({tree.keyToCoord(key[0], depth), tree.keyToCoord(key[1], depth), tree.keyToCoord(key[2], depth),
                         leaf.getSize()});
    }
  return sorted(numbers);
}

/// Reads the data as liboctomap does.
octomap::OcTree read(const SerializedOctree& octree)
{
  octomap::OcTree tree(octree.resolution);
  std::stringstream stream(std::string(octree.bytes.begin(), octree.bytes.end()));
  if (octree.binary)
    tree.readBinaryData(stream);
  else
    tree.readData(stream);
  return tree;
}

std::string errorOfOctree(const SerializedOctree& octree, std::size_t max_leaves = kNoLimit)
{
  try
  {
    occupiedLeaves(octree, max_leaves);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

void expectError(const std::string& fragment, const SerializedOctree& octree, std::size_t max_leaves = kNoLimit)
{
  const std::string error = errorOfOctree(octree, max_leaves);
  EXPECT_NE(error.find(fragment), std::string::npos) << "found: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos);
}

template <class Tree>
void expectTheLeavesOfLiboctomap(std::uint64_t seed)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  Tree tree(0.01 + 0.03 * static_cast<double>(seed));
  fillAtRandom(tree, 200.0 * tree.getResolution(), 60, generator);
  const std::vector<CubeNumbers> expected = occupiedOf(tree);
  ASSERT_GT(expected.size(), 20U);
  const auto has_size = [&expected](double size) {
    return std::any_of(expected.begin(), expected.end(), [size](const CubeNumbers& cube) { return cube[3] == size; });
  };
  for (const double scale : {1.0, 2.0, 4.0, 8.0})
    EXPECT_TRUE(has_size(scale * tree.getResolution())) << scale;
  EXPECT_EQ(expected, numbersOf(occupiedLeaves(serialized(tree, true), kNoLimit)));
  EXPECT_EQ(expected, numbersOf(occupiedLeaves(serialized(tree, false), kNoLimit)));
}

TEST(Octomap, HasTheOccupiedLeavesOfLiboctomapAtAllDepths)
{
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
  {
    expectTheLeavesOfLiboctomap<octomap::OcTree>(seed);
    expectTheLeavesOfLiboctomap<octomap::ColorOcTree>(seed);
  }
}

TEST(Octomap, IsWrittenSoThatLiboctomapReadsTheSameLeaves)
{
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    octomap::OcTree tree(0.05);
    fillAtRandom(tree, 12.0, 60, generator);
    const std::vector<PlacedShape> leaves = occupiedLeaves(serialized(tree, seed % 2 == 0), kNoLimit);
    std::vector<PlacedShape> shuffled = leaves;
    std::shuffle(shuffled.begin(), shuffled.end(), generator);
    const SerializedOctree written = octreeOf(shuffled);
    EXPECT_EQ(occupiedOf(tree), occupiedOf(read(written)));
    EXPECT_EQ(numbersOf(leaves), numbersOf(occupiedLeaves(written, kNoLimit)));
  }
}

TEST(Octomap, ThatIsPrunedToItsRootIsOneCube)
{
  const SerializedOctree root{"OcTree", true, 0.5, {0, 0}};
  EXPECT_EQ(occupiedOf(read(root)), numbersOf(occupiedLeaves(root, kNoLimit)));
  const SerializedOctree written = octreeOf(occupiedLeaves(root, kNoLimit));
  EXPECT_EQ(0.5, written.resolution);
  EXPECT_EQ(root.bytes, written.bytes);
}

TEST(Octomap, WithoutDataHasNoLeaves)
{
  EXPECT_TRUE(occupiedLeaves({"cleared", true, 0.0, {}}, kNoLimit).empty());
  octomap::OcTree free_space(0.1);
  free_space.updateNode(octomap::point3d(1.0F, 1.0F, 1.0F), false);
  EXPECT_TRUE(occupiedLeaves(serialized(free_space, true), kNoLimit).empty());
  EXPECT_TRUE(occupiedLeaves(serialized(free_space, false), kNoLimit).empty());
}

TEST(Octomap, WithWrongDataIsRefused)
{
  octomap::OcTree tree(0.1);
  tree.updateNode(octomap::point3d(1.0F, 1.0F, 1.0F), true);
  tree.updateNode(octomap::point3d(-1.0F, 1.0F, 1.0F), true);
  for (const bool binary : {true, false})
  {
    const SerializedOctree good = serialized(tree, binary);
    for (std::size_t size = 1; size < good.bytes.size(); ++size)
    {
      SerializedOctree cut = good;
      cut.bytes.resize(size);
      expectError("the data end inside of the octree", cut);
    }
    SerializedOctree longer = good;
    longer.bytes.push_back(0);
    expectError("1 bytes follow the end", longer);
    expectError("more than 1 occupied leaves", good, 1);
    EXPECT_EQ("", errorOfOctree(good, 2));
  }
  SerializedOctree other = serialized(tree, true);
  other.id = "OcTreeStamped";
  expectError("'OcTreeStamped'; known are OcTree and ColorOcTree", other);
  for (const double resolution : {0.0, -1.0, std::nan(""), HUGE_VAL})
  {
    SerializedOctree wrong = serialized(tree, true);
    wrong.resolution = resolution;
    expectError("the resolution is", wrong);
  }
  SerializedOctree unknown = serialized(tree, false);
  const float nan = std::nanf("");
  std::memcpy(unknown.bytes.data() + unknown.bytes.size() - 5, &nan, sizeof(nan));  // the last leaf
  expectError("the occupancy of a leaf is not a number", unknown);
}

TEST(Octomap, DeeperThanAnOctreeIsRefusedAndNeverExhaustsTheStack)
{
  const std::vector<std::int8_t> only_inner_nodes(std::size_t{8} << 20U, -1);
  expectError("more than 16 levels", {"OcTree", true, 0.1, only_inner_nodes});
  std::vector<std::int8_t> only_first_children;
  for (int i = 0; i < 1000000; ++i)
    only_first_children.insert(only_first_children.end(), {0, 0, 0, 0, 1});
  expectError("more than 16 levels", {"OcTree", false, 0.1, only_first_children});
}

TEST(Octomap, OfArbitraryBytesIsReadOrRefusedWithinItsLimit)
{
  const std::uint64_t seed = 5;
  std::mt19937_64 generator(seed);
  std::uniform_int_distribution<int> byte(-128, 127);
  octomap::OcTree tree(0.1);
  fillAtRandom(tree, 10.0, 20, generator);
  const std::array<SerializedOctree, 2> written = {serialized(tree, true), serialized(tree, false)};
  for (int i = 0; i < 20000; ++i)
  {
    SerializedOctree octree = written[static_cast<std::size_t>(i % 2)];
    octree.id = i % 3 == 0 ? "ColorOcTree" : "OcTree";
    for (int change = 0; change <= i % 4; ++change)
      octree.bytes[generator() % octree.bytes.size()] = static_cast<std::int8_t>(byte(generator));
    try
    {
      const std::vector<PlacedShape> leaves = occupiedLeaves(octree, 500);
      EXPECT_LE(leaves.size(), 500U);
      if (!leaves.empty())
        EXPECT_EQ(numbersOf(leaves), numbersOf(occupiedLeaves(octreeOf(leaves), kNoLimit)));
    }
    catch (const Error& error)
    {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(Octomap, ShapesThatAreNoLeavesOfAnOctreeAreRefused)
{
  const auto refused = [](const std::vector<PlacedShape>& shapes) { EXPECT_THROW(requireOctree(shapes), Error); };
  const auto cube = [](double size, double x, double y, double z) {
    return PlacedShape{Box{{size, size, size}}, poseAt(x, y, z)};
  };
  EXPECT_NO_THROW(requireOctree({cube(0.2, 0.1, 0.1, 0.1), cube(0.1, 0.25, 0.05, -0.05)}));
  refused({PlacedShape{Sphere{0.1}, poseAt(0.1, 0.1, 0.1)}});
  refused({PlacedShape{Box{{0.2, 0.2, 0.1}}, poseAt(0.1, 0.1, 0.1)}});
  refused({PlacedShape{Box{{0.2, 0.2, 0.2}}, poseAt(0.1, 0.1, 0.1, 0.5)}});
  refused({cube(0.2, 0.1, 0.1, 0.1), cube(0.3, 0.45, 0.45, 0.45)});         // sizes that are no powers of two
  refused({cube(0.2, 0.1, 0.1, 0.15), cube(0.2, 0.3, 0.1, 0.1)});           // between the cells of the grid
  refused({cube(0.2, 0.1, 0.1, 0.1), cube(0.1, 0.05, 0.05, 0.05)});         // one inside the other
  refused({cube(0.2, 0.1, 0.1, 0.1), cube(0.2, 0.1, 0.1, 0.1)});            // the same twice
  refused({cube(0.2, 0.1, 0.1, 0.1), cube(0.2, 0.2 * 32768.5, 0.1, 0.1)});  // outside of the octree
}

// Changes of a scene.
class OctomapChanges : public SceneChanges
{
 protected:
  static ObjectChange octomap(double x)
  {
    ObjectChange change = objectChange(Operation::Add, kOctomapId, {});
    const double size = 0.1;
    for (int i = 0; i < 3; ++i)
      change.shapes.push_back({Box{{size, size, size}}, poseAt(size * (0.5 + 2 * i), 0.5 * size, 0.5 * size)});
    change.pose = poseAt(x, 0.0, 0.0);
    return change;
  }

  bool hasOctomap() const
  {
    return std::any_of(
        scene_.objects.begin(), scene_.objects.end(),
        [](const WorldObject& candidate) { return candidate.id == kOctomapId; });
  }

  void allowCart()
  {
    SceneChange allow;
    allow.is_diff = true;
    allow.matrix = scene_.allowed_collisions;
    allow.matrix->setEntry(kOctomapId, "cart", true);
    allow.colors[kOctomapId] = {0.5F, 0.5F, 0.5F, 1.0F};
    apply(allow);
  }

  bool allowsCart() const
  {
    const std::string cart = "cart";
    return scene_.allowed_collisions.row(kOctomapId).allowed(scene_.allowed_collisions.row(cart));
  }
};

TEST_F(OctomapChanges, ReplacingAndClearingTheOctomapKeepsItsAllowedCollisions)
{
  allowCart();
  change(octomap(1.0));
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(3U, object(kOctomapId).shapes.size());
  change(octomap(2.0));
  EXPECT_EQ(2.0, object(kOctomapId).pose.translation().x());
  EXPECT_TRUE(allowsCart());
  change(objectChange(Operation::Remove, kOctomapId));
  EXPECT_FALSE(hasOctomap());
  EXPECT_TRUE(allowsCart());
  EXPECT_EQ(1U, scene_.colors.count(kOctomapId));
  change(objectChange(Operation::Remove, kOctomapId));  // there is none; as in MoveIt, this is no error
  change(octomap(3.0));
  EXPECT_TRUE(allowsCart());
}

/// For example a message on the topic ~planning_scene_world.
TEST_F(OctomapChanges, ARemovalThatKeepsEntriesKeepsItsColourToo)
{
  allowCart();
  change(octomap(1.0));
  ObjectChange remove = objectChange(Operation::Remove, kOctomapId);
  remove.keeps_allowed_collisions = true;
  change(remove);
  EXPECT_FALSE(hasOctomap());
  EXPECT_TRUE(allowsCart());
  EXPECT_EQ(1U, scene_.colors.count(kOctomapId));
}

/// As in MoveIt. A full scene replaces the octomap with the world.
TEST_F(OctomapChanges, RemovingAllObjectsLeavesTheOctomap)
{
  change(octomap(1.0));
  change(objectChange(Operation::Add, "box", {boxAt(0.1)}));
  change(objectChange(Operation::Remove, ""));
  ASSERT_EQ(1U, scene_.objects.size());
  EXPECT_EQ(kOctomapId, scene_.objects[0].id);
  apply(SceneChange());
  EXPECT_FALSE(hasOctomap());
}

TEST_F(OctomapChanges, TheOctomapCanOnlyBeAddedAndRemoved)
{
  change(octomap(1.0));
  refused("can only be added", objectChange(Operation::Move, kOctomapId));
  refused("can only be added", objectChange(Operation::Append, kOctomapId, {boxAt(0.1)}));
  refused("cannot be attached", attachedChange(Operation::Add, kOctomapId, "pole"));
  refused("not a leaf of an octree", objectChange(Operation::Add, kOctomapId, {triangleAt()}));
  EXPECT_THROW(scene_.attach(kOctomapId, "pole", {}, state_.data()), Error);
}

TEST_F(OctomapChanges, OctomapsOfTooManyLeavesAreRefused)
{
  limits_.voxels = 2;
  refused("limits/voxels allows 2", octomap(1.0));
  limits_.voxels = 3;
  change(octomap(1.0));
}

TEST_F(OctomapChanges, ADifferenceAddsMovesReplacesAndClearsTheOctomap)
{
  allowCart();
  const auto expect_difference = [this](const PlanningScene& to)
  {
    const SceneChange difference = diffOf(scene_, to);
    EXPECT_TRUE(difference.is_diff) << "no full scene is needed";
    for (const ObjectChange& part : difference.objects)
      EXPECT_NE(Operation::Move, part.operation) << "a message has no such operation";
    apply(difference);
    expectSameScene(to, scene_);
  };
  const PlanningScene without = scene_;
  change(octomap(1.0));
  const PlanningScene first = scene_;
  ObjectChange fewer = octomap(1.0);
  fewer.shapes.pop_back();
  change(fewer);
  const PlanningScene second = scene_;
  change(octomap(2.0));
  const PlanningScene moved = scene_;
  scene_ = without;
  for (const PlanningScene* to : {&first, &moved, &second, &without})
    expect_difference(*to);
}

// Fields that change no verdict.
TEST_F(SceneChanges, AnObjectKeepsItsTypeWhereverItGoes)
{
  ObjectChange box = objectChange(Operation::Add, "box", {boxAt(0.1)});
  box.type = {"cup 17", "{'type': 'CouchDB'}"};
  change(box);
  EXPECT_EQ(box.type, object("box").type);
  ObjectChange move = objectChange(Operation::Move, "box");
  move.pose = poseAt(1.0, 0.0, 0.0);
  change(move);
  EXPECT_EQ(box.type, object("box").type);
  change(attachedChange(Operation::Add, "box", "pole"));
  EXPECT_EQ(box.type, carried("box").object.type);
  change(attachedChange(Operation::Remove, "box", "pole"));
  EXPECT_EQ(box.type, object("box").type);
  PlanningScene renamed = scene_;
  renamed.objects[0].type.key = "cup 18";
  apply(diffOf(scene_, renamed));
  EXPECT_EQ("cup 18", object("box").type.key);
  change(objectChange(Operation::Add, "box", {boxAt(0.1)}));
  EXPECT_TRUE(object("box").type.isEmpty()) << "a new object replaces it";
  box.type.db = std::string(2000, 'x');
  refused("name_length", box);
}

TEST_F(SceneChanges, AnAttachedObjectKeepsItsWeightAndDetachPosture)
{
  AttachedChange tool = attachedChange(Operation::Add, "tool", "pole", {boxAt(0.1)});
  tool.weight = 1.5;
  tool.detach_posture.frame_id = "pole";
  tool.detach_posture.joint_names = {"finger"};
  tool.detach_posture.points.resize(1);
  tool.detach_posture.points[0].positions = {0.04};
  tool.detach_posture.points[0].time_from_start = 250;
  change(tool);
  change(attachedChange(Operation::Append, "tool", "pole", {boxAt(0.2)}));
  EXPECT_EQ(1.5, carried("tool").weight);
  EXPECT_TRUE(tool.detach_posture == carried("tool").detach_posture);
  const PlanningScene with = scene_;
  PlanningScene heavier = with;
  heavier.attached[0].weight = 2.0;
  apply(diffOf(scene_, heavier));
  EXPECT_EQ(2.0, carried("tool").weight);
  PlanningScene open = heavier;
  open.attached[0].detach_posture.points[0].effort = {3.0};
  apply(diffOf(scene_, open));
  EXPECT_TRUE(open.attached[0].detach_posture == carried("tool").detach_posture);
  tool.weight = -1.0;
  refused("the weight is -1", tool);
  tool.weight = 1.0;
  tool.detach_posture.points.resize(20000);
  refused("the detach_posture has", tool);
}
}  // namespace
}  // namespace gpu_planning_scene::core
