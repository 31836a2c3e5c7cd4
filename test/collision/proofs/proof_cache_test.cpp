// Proofs from disk are those that were made. A proof that does not fit exactly is made again.

#include "collision/proofs/proof_cache.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/proofs/proof_sources.h"
#include "collision/proofs/robot_proofs.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

/// A lift with a flap; the tip turns with the flap, and the hand is fixed on the tip. Three pairs of links are checked.
/// `replaced`: texts for words that begin with $.
std::string liftUrdf(const std::map<std::string, std::string>& replaced = {})
{
  std::map<std::string, std::string> words = {{"base_xyz", "0 0 0"},
                                              {"base_size", "0.5 0.5 0.1"},
                                              {"radius", "0.1"},
                                              {"shape_xyz", "0.1 0 0"},
                                              {"origin", "0 0 0.3"},
                                              {"axis", "0 1 0"},
                                              {"type", "revolute"},
                                              {"lower", "-1"},
                                              {"upper", "2"},
                                              {"fixed_xyz", "0.05 0 0"},
                                              {"multiplier", "0.5"},
                                              {"offset", "0.1"},
                                              {"lift", "lift"},
                                              {"leader", "hinge"},
                                              {"tip_shape", R"(<sphere radius="0.08"/>)"}};
  for (const auto& [word, text] : replaced)
    words.at(word) = text;
  std::string urdf = R"(<robot name="lift">
    <link name="world"/>
    <joint name="mount" type="fixed"><parent link="world"/><child link="base"/><origin xyz="$base_xyz"/></joint>
    <link name="base"><collision><geometry><box size="$base_size"/></geometry></collision></link>
    <joint name="$lift" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="0 0 1"/>
      <limit lower="0.1" upper="0.6" effort="1" velocity="1"/></joint>
    <link name="carriage"/>
    <joint name="hinge" type="$type"><parent link="carriage"/><child link="flap"/><origin xyz="$origin"/>
      <axis xyz="$axis"/><limit lower="$lower" upper="$upper" effort="1" velocity="1"/></joint>
    <link name="flap"><collision><origin xyz="$shape_xyz"/>
      <geometry><sphere radius="$radius"/></geometry></collision></link>
    <joint name="plate" type="fixed"><parent link="flap"/><child link="bracket"/><origin xyz="$fixed_xyz"/></joint>
    <link name="bracket"/>
    <joint name="follower" type="revolute"><parent link="bracket"/><child link="tip"/><axis xyz="0 1 0"/>
      <origin xyz="0.3 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
      <mimic joint="$leader" multiplier="$multiplier" offset="$offset"/></joint>
    <link name="tip"><collision><geometry>$tip_shape</geometry></collision></link>
    <joint name="wrist" type="fixed"><parent link="tip"/><child link="hand"/><origin xyz="-0.2 0 0"/></joint>
    <link name="hand"><collision><geometry><box size="0.1 0.05 0.05"/></geometry></collision></link></robot>)";
  for (const auto& [word, text] : words)
    for (std::size_t at; (at = urdf.find("$" + word)) != std::string::npos;)
      urdf.replace(at, word.size() + 1, text);
  return urdf;
}

std::shared_ptr<const RobotModel> robotOf(const std::string& urdf)
{
  return RobotModel::fromXml(urdf, "", {});
}

/// The key of the table of two links with one shape each.
std::string keyOf(const RobotModel& robot, const char* first = "base", const char* second = "tip")
{
  const auto side = [&robot](int link)
  {
    const PlacedShape& placed = robot.links()[static_cast<std::size_t>(link)].shapes.at(0);
    return TableSide{shapeHash(placed.shape, tessellate(placed.shape).sagitta), placed.pose};
  };
  const int a = robot.linkIndex(first);
  const int b = robot.linkIndex(second);
  return tableKey(robot, jointsBetween(robot, a, b), side(a), side(b));
}

void expectSame(const BallCover& a, const BallCover& b)
{
  EXPECT_EQ(a.layer, b.layer);
  EXPECT_EQ(a.thickness, b.thickness);
  for (std::size_t level = 0; level < kCoverBalls.size(); ++level)
  {
    ASSERT_EQ(a.levels[level].size(), b.levels[level].size());
    for (std::size_t i = 0; i < a.levels[level].size(); ++i)
    {
      EXPECT_EQ(a.levels[level][i].center, b.levels[level][i].center);
      EXPECT_EQ(a.levels[level][i].outer, b.levels[level][i].outer);
      EXPECT_EQ(a.levels[level][i].witness, b.levels[level][i].witness);
      EXPECT_EQ(a.levels[level][i].inner, b.levels[level][i].inner);
    }
  }
}

void expectSame(const RobotProofs& a, const RobotProofs& b)
{
  ASSERT_EQ(a.covers.size(), b.covers.size());
  for (std::size_t i = 0; i < a.covers.size(); ++i)
    expectSame(*a.covers[i], *b.covers[i]);
  ASSERT_EQ(a.tables.size(), b.tables.size());
  for (std::size_t i = 0; i < a.tables.size(); ++i)
  {
    ASSERT_EQ(!a.tables[i], !b.tables[i]);
    if (!a.tables[i])
      continue;
    EXPECT_EQ(a.tables[i]->cells, b.tables[i]->cells);
    ASSERT_EQ(a.tables[i]->variables.size(), b.tables[i]->variables.size());
    for (std::size_t k = 0; k < a.tables[i]->variables.size(); ++k)
    {
      const TableVariable& first = a.tables[i]->variables[k];
      const TableVariable& second = b.tables[i]->variables[k];
      EXPECT_EQ(first.variable, second.variable);
      EXPECT_EQ(first.wraps, second.wraps);
      EXPECT_EQ(first.lower, second.lower);
      EXPECT_EQ(first.cell_width, second.cell_width);
      EXPECT_EQ(first.cells, second.cells);
    }
  }
}

class ProofCacheTest : public testing::Test
{
 protected:
  /// A robot with its problem.
  struct Loaded
  {
    explicit Loaded(const std::string& urdf) : scene(robotOf(urdf))
    {
      problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
      exact = forest.exactCheckerOf(problem);
    }

    PlanningScene scene;
    std::shared_ptr<const CollisionProblem> problem;
    ForestCache forest;
    std::unique_ptr<const ExactChecker> exact;
  };

  void SetUp() override { folder_ = newFolder(); }
  void TearDown() override { fs::remove_all(folder_); }
  static void TearDownTestSuite()
  {
    if (!filled_.empty())
      fs::remove_all(filled_);
  }

  static fs::path newFolder()
  {
    std::string name = (fs::temp_directory_path() / "gpu_planning_scene_proofs_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    return name;
  }

  /// Fills the test's folder with the proofs of the lift, which are made once.
  void fill() const
  {
    if (filled_.empty())
    {
      filled_ = newFolder();
      proofs(Loaded(liftUrdf()), true, filled_);
    }
    fs::copy(filled_, folder_);
  }

  /// The proofs that a new process makes or, without `makes`, finds. No value: none were published.
  static std::optional<RobotProofs> proofs(const Loaded& loaded, bool makes, const fs::path& folder)
  {
    std::optional<RobotProofs> published;
    const auto publish = [&published](RobotProofs made) { published = std::move(made); };
    const auto never = [] { return false; };
    RobotProver prover;
    const ProofCache cache(folder);
    if (makes)
      prover.prove(*loaded.scene.robot, *loaded.problem, loaded.forest.forest(), cache, publish, never);
    else
      prover.load(*loaded.scene.robot, *loaded.problem, loaded.forest.forest(), cache, publish, never);
    return published;
  }
  std::optional<RobotProofs> made(const Loaded& loaded) const { return proofs(loaded, true, folder_); }
  std::optional<RobotProofs> found(const Loaded& loaded) const { return proofs(loaded, false, folder_); }

  std::vector<fs::path> files() const { return {fs::directory_iterator(folder_), fs::directory_iterator{}}; }
  static std::string read(const fs::path& path)
  {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void write(const fs::path& path, const std::string& bytes)
  {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  static BallCover someCover()
  {
    BallCover cover;
    for (auto& level : cover.levels)
      level.push_back({{1.0, 2.0, 3.0}, 0.5, {1.0, 2.0, 3.25}, 0.25});
    cover.layer = 0.125;
    return cover;
  }
  static JointTable someTable()
  {
    return {{{0, false, -1.0, 0.5, 2}, {1, false, -1.0, 0.5, 4}},
            {Proof::None, Proof::Apart, Proof::Colliding, Proof::None, Proof::Apart, Proof::Apart, Proof::Colliding,
             Proof::Colliding}};
  }

  static inline fs::path filled_;
  fs::path folder_;
};

TEST_F(ProofCacheTest, ProofsFromDiskAreThoseThatWereMade)
{
  const Loaded lift(liftUrdf());
  EXPECT_FALSE(found(lift)) << "there are none yet";
  const std::optional<RobotProofs> without = proofs(lift, true, {});
  ASSERT_TRUE(without);
  EXPECT_TRUE(files().empty());
  std::size_t tables = 0;
  std::map<Proof, std::size_t> cells;
  for (const auto& table : without->tables)
    if (table)
    {
      ++tables;
      for (const Proof proof : table->cells)
        ++cells[proof];
    }
  EXPECT_EQ(tables, 4U);
  EXPECT_EQ(cells.size(), 3U) << "all kinds of cells";
  fill();
  EXPECT_EQ(files().size(), 8U) << "four covers and four tables";
  expectSame(*without, *made(lift));
  ASSERT_TRUE(found(lift));
  expectSame(*without, *found(lift));
}

TEST_F(ProofCacheTest, TheSameRobotElsewhereWithOtherNamesHasTheSameProofs)
{
  fill();
  EXPECT_TRUE(found(Loaded(liftUrdf({{"base_xyz", "1 2 3"}, {"lift", "spindle"}}))));
}

TEST_F(ProofCacheTest, NothingIsLoadedIfAProofIsMissing)
{
  const Loaded lift(liftUrdf());
  fill();
  const std::optional<RobotProofs> first = found(lift);
  ASSERT_TRUE(first);
  for (const fs::path& file : files())
  {
    const std::string bytes = read(file);
    fs::remove(file);
    EXPECT_FALSE(found(lift)) << file;
    write(file, bytes);
  }
  EXPECT_TRUE(found(lift));
  fs::remove(files().at(0));
  expectSame(*first, *made(lift));
  EXPECT_TRUE(found(lift));
}

TEST_F(ProofCacheTest, DamagedProofsAreMadeAgain)
{
  const Loaded lift(liftUrdf());
  fill();
  const std::optional<RobotProofs> first = found(lift);
  ASSERT_TRUE(first);
  std::vector<std::string> good;
  for (const fs::path& file : files())
    good.push_back(read(file));
  std::size_t at = 3;
  for (const fs::path& file : files())
  {
    std::string bytes = read(file);
    bytes.at(at) = static_cast<char>(bytes.at(at) ^ 1);
    write(file, bytes);
    at += 25;  // in the header, the key and the content
  }
  EXPECT_FALSE(found(lift));
  expectSame(*first, *made(lift));
  std::size_t i = 0;
  for (const fs::path& file : files())
    EXPECT_EQ(read(file), good.at(i++));
}

TEST_F(ProofCacheTest, AChangedShapeGetsItsOwnProofs)
{
  fill();
  const std::vector<std::map<std::string, std::string>> changes = {{{"base_size", "0.6 0.5 0.1"}},
                                                                   {{"tip_shape", R"(<sphere radius="0.1"/>)"}}};
  for (const auto& change : changes)
  {
    const Loaded changed(liftUrdf(change));
    EXPECT_FALSE(found(changed));
    expectSame(*proofs(changed, true, {}), *made(changed));
  }
}

TEST_F(ProofCacheTest, NoFlippedByteIsRead)
{
  const ProofCache cache(folder_);
  cache.store("cover", someCover());
  const fs::path file = files().at(0);
  const std::string good = read(file);
  for (std::size_t i = 0; i < good.size(); ++i)
    for (const int flip : {0x01, 0x80, 0xFF})
    {
      std::string bytes = good;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      write(file, bytes);
      ASSERT_FALSE(cache.cover("cover")) << "byte " << i;
    }
  write(file, good);
  expectSame(cache.cover("cover").value(), someCover());
}

/// The checksum of such files is right.
TEST_F(ProofCacheTest, ContentOfAnotherFormIsIgnored)
{
  const ProofCache cache(folder_);
  const auto expect_ignored = [&cache](const char* reason, const auto& change)
  {
    BallCover cover = someCover();
    change(cover);
    cache.store("key", cover);
    EXPECT_FALSE(cache.cover("key")) << reason;
  };
  expect_ignored(
      "an empty level", [](BallCover& cover) { cover.levels[1].clear(); });
  expect_ignored(
      "too many balls", [](BallCover& cover) { cover.levels[1].resize(9, cover.levels[1][0]); });
  expect_ignored(
      "a negative radius", [](BallCover& cover) { cover.levels[2][0].inner = -1.0; });
  expect_ignored(
      "an infinite layer", [](BallCover& cover) { cover.layer = HUGE_VAL; });
  expect_ignored("no number", [](BallCover& cover) { cover.levels[2][0].center.x() = std::nan(""); });
  cache.store("key", someCover());
  EXPECT_TRUE(cache.cover("key"));
  EXPECT_FALSE(cache.table("key", someTable().variables));

  JointTable table = someTable();
  cache.store("key", table);
  ASSERT_TRUE(cache.table("key", table.variables));
  EXPECT_EQ(cache.table("key", table.variables)->cells, table.cells);
  EXPECT_FALSE(cache.cover("key"));
  std::vector<TableVariable> fewer = table.variables;
  fewer[1].cells = 2;
  EXPECT_FALSE(cache.table("key", fewer));
  table.cells[5] = static_cast<Proof>(3);
  cache.store("key", table);
  EXPECT_FALSE(cache.table("key", table.variables));
}

TEST_F(ProofCacheTest, ProofsAreMadeIfTheFolderCannotBeWritten)
{
  const Loaded lift(liftUrdf());
  const fs::path file = folder_ / "file";
  write(file, "x");
  EXPECT_TRUE(proofs(lift, true, file));
  EXPECT_FALSE(proofs(lift, false, file));
}

TEST_F(ProofCacheTest, TheKeyOfATableChangesWithEachPartOfItsPair)
{
  const std::string key = keyOf(*robotOf(liftUrdf()));
  std::map<std::string, std::string> seen = {{key, "no change"}};
  const std::vector<std::map<std::string, std::string>> changes = {
      {{"base_size", "0.5 0.5 0.2"}},
      {{"tip_shape", R"(<sphere radius="0.0800001"/>)"}},
      {{"tip_shape", R"(<cylinder radius="0.08" length="0.16"/>)"}},
      {{"tip_shape", R"(<box size="0.16 0.16 0.16"/>)"}},
      {{"origin", "0 0 0.3000001"}},
      {{"axis", "1 0 0"}},
      {{"type", "prismatic"}},
      {{"type", "continuous"}},
      {{"lower", "-1.0000001"}},
      {{"upper", "2.0000001"}},
      {{"fixed_xyz", "0.051 0 0"}},
      {{"multiplier", "0.6"}},
      {{"offset", "0.11"}},
      {{"leader", "lift"}}};
  for (const auto& change : changes)
  {
    const std::string name = change.begin()->first + " " + change.begin()->second;
    const auto [other, is_new] = seen.emplace(keyOf(*robotOf(liftUrdf(change))), name);
    EXPECT_TRUE(is_new) << name << " has the key of " << other->second;
  }
  EXPECT_NE(keyOf(*robotOf(liftUrdf()), "base", "flap"),
            keyOf(*robotOf(liftUrdf({{"shape_xyz", "0.1 0.001 0"}})), "base", "flap"));
  EXPECT_NE(keyOf(*robotOf(liftUrdf()), "tip", "base"), key);
  EXPECT_EQ(keyOf(*robotOf(liftUrdf({{"radius", "0.2"}}))), key) << "of a link between the two";
}

TEST_F(ProofCacheTest, KeysHaveTheShapesAndTheHashOfTheSourceCode)
{
  EXPECT_NE(coverKey(shapeHash(Sphere{0.1}, 0.0)), coverKey(shapeHash(Sphere{0.2}, 0.0)));
  EXPECT_NE(coverKey(shapeHash(Sphere{0.1}, 0.0)).find(kProofSources), std::string::npos);
  EXPECT_NE(keyOf(*robotOf(liftUrdf())).find(kProofSources), std::string::npos);
}

/// The same joints in the same order, once along the path and once against it.
TEST_F(ProofCacheTest, TheKeyOfATableHasTheDirectionOfTheJoints)
{
  const auto robot = [](const char* parent, const char* child)
  {
    return robotOf(std::string(R"(<robot name="two">
      <link name=")") +
                   parent + R"("><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="j" type="continuous"><parent link=")" +
                   parent + R"("/><child link=")" + child + R"("/>
        <origin xyz="0.1 0.2 0.3"/><axis xyz="0 0 1"/></joint>
      <link name=")" +
                   child + R"("><collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>)");
  };
  EXPECT_NE(keyOf(*robot("a", "b"), "a", "b"), keyOf(*robot("b", "a"), "a", "b"));
}

TEST_F(ProofCacheTest, TheHashOfAShapeChangesWithEachOfItsNumbers)
{
  Mesh mesh;
  mesh.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const auto hash = [](const Mesh& changed)
  {
    const ShapeHash found = shapeHash(std::make_shared<const Mesh>(changed), 0.0);
    return std::string(found.data(), found.size());
  };
  std::map<std::string, int> seen = {{hash(mesh), -1}};
  for (int i = 0; i < 12; ++i)
  {
    Mesh changed = mesh;
    double& number = changed.vertices[static_cast<std::size_t>(i / 3)][i % 3];
    number = std::nextafter(number, 2.0);
    EXPECT_TRUE(seen.emplace(hash(changed), i).second) << "coordinate " << i;
  }
  for (int i = 0; i < 6; ++i)
  {
    Mesh changed = mesh;
    std::uint32_t& corner = changed.triangles[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)];
    corner = (corner + 1) % 4;
    EXPECT_TRUE(seen.emplace(hash(changed), 12 + i).second) << "corner " << i;
  }
  Mesh more = mesh;
  more.triangles.push_back({0, 2, 3});
  EXPECT_TRUE(seen.emplace(hash(more), 18).second);
  Mesh moved = mesh;  // the same bits in another order: a vertex became two triangles
  std::array<std::uint32_t, 6> corners;
  static_assert(sizeof(corners) == sizeof(mesh.vertices[0]));
  std::memcpy(corners.data(), mesh.vertices.back().data(), sizeof(corners));
  moved.vertices.pop_back();
  moved.triangles.insert(moved.triangles.begin(),
                         {{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}});
  EXPECT_TRUE(seen.emplace(hash(moved), 20).second);
  Mesh named = mesh;
  named.name = "other name";
  EXPECT_FALSE(seen.emplace(hash(named), 19).second) << "the name is no number";
  EXPECT_NE(shapeHash(Sphere{0.1}, 1e-4), shapeHash(Sphere{0.1}, 2e-4));
  EXPECT_NE(shapeHash(Cylinder{0.1, 0.2}, 1e-4), shapeHash(Cone{0.1, 0.2}, 1e-4));
  EXPECT_NE(shapeHash(Cylinder{0.1, 0.2}, 1e-4), shapeHash(Cylinder{0.1, 0.3}, 1e-4));
}
}  // namespace
}  // namespace gpu_planning_scene::core
