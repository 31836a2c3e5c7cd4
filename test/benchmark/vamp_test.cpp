// The benchmark runs VAMP's check as it is published: the conversion of scenes, the order of joints and the blocks of
// states change no answer. Skipped where ../shared has no VAMP.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "benchmark/state_kinds.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/real_robots.h"
#include "peers/vamp/vamp_check.h"
#include "peers/vamp/vamp_model.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kStates = 2000;

class Vamp : public testing::Test
{
 protected:
  void SetUp() override
  {
    if (!whyNoVamp().empty())
      GTEST_SKIP() << whyNoVamp();
    for (const std::string& missing : {missingFor("ur5_cage"), ur5Spheres().available() ? "" : ur5Spheres().urdf})
      if (!missing.empty())
        GTEST_SKIP() << "there is no " << missing;
  }
};

std::vector<std::uint8_t> vampAnswers(const PlanningScene& scene, const std::vector<double>& states,
                                      VampCylinders cylinders = VampCylinders::Capsules)
{
  std::vector<std::uint8_t> valid(states.size() / scene.robot->variables().size());
  VampCheck(scene, cylinders).check(states.data(), valid.size(), valid.data());
  return valid;
}

std::vector<std::uint8_t> exactAnswers(const PlanningScene& scene, const std::vector<double>& states)
{
  CpuChecker checker(std::make_shared<const PlanningScene>(scene));
  return checker.check(states.data(), states.size() / scene.robot->variables().size()).valid;
}

/// The answers of the exact checker for VAMP's spheres and pairs of links.
std::vector<std::uint8_t> exactSphereAnswers(const PlanningScene& scene, const std::vector<double>& states)
{
  return exactAnswers(withSpheres(scene, loadVampModel(*scene.robot)), states);
}

PlanningScene withObject(const PlanningScene& scene, const Shape& shape, const Eigen::Isometry3d& pose)
{
  PlanningScene changed = scene;
  WorldObject object;
  object.id = "object";
  object.pose = pose;
  object.shapes.push_back({shape, Eigen::Isometry3d::Identity()});
  changed.objects = {object};
  return changed;
}

/// The scene with a ball at each end of each cylinder.
PlanningScene withCapsules(PlanningScene scene)
{
  for (WorldObject& object : scene.objects)
    for (std::size_t i = object.shapes.size(); i-- > 0;)
      if (const auto* found = std::get_if<Cylinder>(&object.shapes[i].shape))
      {
        const Cylinder cylinder = *found;
        const Eigen::Isometry3d pose = object.shapes[i].pose;
        for (const double end : {-0.5, 0.5})
          object.shapes.push_back(
              {Sphere{cylinder.radius}, pose * Eigen::Translation3d(0.0, 0.0, end * cylinder.length)});
      }
  return scene;
}

PlanningScene withBoxes(PlanningScene scene)
{
  for (WorldObject& object : scene.objects)
    for (PlacedShape& placed : object.shapes)
      if (const auto* found = std::get_if<Cylinder>(&placed.shape))
      {
        const Cylinder cylinder = *found;
        placed.shape = Box{{2.0 * cylinder.radius, 2.0 * cylinder.radius, cylinder.length}};
      }
  return scene;
}

/// Turns all objects about a slanted axis through the robot's shoulder.
PlanningScene turned(PlanningScene scene)
{
  const Eigen::Vector3d shoulder(0.0, 0.0, 1.0);
  const Eigen::AngleAxisd turn(0.4, Eigen::Vector3d(1.0, 2.0, 0.5).normalized());
  for (WorldObject& object : scene.objects)
    object.pose = Eigen::Translation3d(shoulder) * turn * Eigen::Translation3d(-shoulder) * object.pose;
  return scene;
}

/// States in the full ranges of the joints.
std::vector<double> anywhere(const PlanningScene& scene, std::size_t count)
{
  TestScene everywhere;
  for (const Variable& variable : scene.robot->variables())
  {
    everywhere.lower.push_back(variable.lower);
    everywhere.upper.push_back(variable.upper);
  }
  return everywhere.randomStates(count, 5);
}

void expectSomeOfBoth(const std::vector<std::uint8_t>& answers)
{
  const auto free = std::count(answers.begin(), answers.end(), 1);
  EXPECT_GT(free, static_cast<std::ptrdiff_t>(answers.size() / 20));
  EXPECT_LT(free, static_cast<std::ptrdiff_t>(answers.size() - answers.size() / 20));
}
}  // namespace

TEST_F(Vamp, AgreesWithTheExactCheckerWhereItsSpheresAreGoodEnough)
{
  const PlanningScene& scene = *testScene("ur5_cage").scene;
  const RobotModel& robot = *scene.robot;
  const int wrist = robot.linkIndex("wrist_2_link");
  const PlanningScene far = withObject(scene, Sphere{0.5}, Eigen::Isometry3d(Eigen::Translation3d(3.0, 0.0, 1.0)));
  const std::vector<double> states = anywhere(scene, 300);
  const std::vector<std::uint8_t> exact = exactAnswers(far, states);
  const std::vector<std::uint8_t> vamp = vampAnswers(far, states);
  CpuChecker checker(std::make_shared<const PlanningScene>(scene));
  const std::size_t width = robot.variables().size();
  std::size_t compared = 0;
  for (std::size_t i = 0; i < exact.size() && compared < 20; ++i)
    if (exact[i] != 0 && vamp[i] != 0)  // both find no collision between links
    {
      ++compared;
      const std::vector<double> state(&states[i * width], &states[(i + 1) * width]);
      std::vector<Eigen::Isometry3d> poses(robot.links().size());
      robot.linkPoses(state.data(), poses.data());
      const Eigen::Isometry3d at(Eigen::Translation3d(poses[static_cast<std::size_t>(wrist)].translation()));
      const PlanningScene near = withObject(scene, Sphere{0.12}, at);
      checker.setScene(std::make_shared<const PlanningScene>(near));
      EXPECT_EQ(checker.check(state.data(), 1).valid, std::vector<std::uint8_t>{0}) << i;
      EXPECT_EQ(vampAnswers(near, state), std::vector<std::uint8_t>{0}) << i;
    }
  EXPECT_EQ(compared, 20U);
}

TEST_F(Vamp, HasTheAnswersOfTheExactCheckerForItsSpheresAndPairs)
{
  for (const char* name : {"ur5_cage", "ur5_table_pick", "ur5_bookshelf_tall"})
    for (const bool slanted : {false, true})
    {
      const PlanningScene scene = slanted ? turned(*testScene(name).scene) : *testScene(name).scene;
      const std::vector<double> states = testScene(name).randomStates(kStates, 3);
      const std::vector<std::uint8_t> vamp = vampAnswers(scene, states);
      EXPECT_EQ(vamp, exactSphereAnswers(withCapsules(scene), states)) << name << slanted;
      expectSomeOfBoth(vamp);
    }
}

TEST_F(Vamp, HasCapsulesForCylinders)
{
  const PlanningScene& cage = *testScene("ur5_cage").scene;
  for (const double slant : {0.0, 0.8})
  {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(slant, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()));
    pose.pretranslate(Eigen::Vector3d(0.4, 0.1, 1.2));
    const PlanningScene scene = withObject(cage, Cylinder{0.1, 0.4}, pose);
    const std::vector<double> states = anywhere(scene, kStates);
    const std::vector<std::uint8_t> vamp = vampAnswers(scene, states);
    EXPECT_EQ(vamp, exactSphereAnswers(withCapsules(scene), states)) << slant;
    EXPECT_NE(vamp, exactSphereAnswers(scene, states)) << slant;
  }
}

TEST_F(Vamp, HasBoxesForCylindersInTheSetBox)
{
  EXPECT_EQ(vampCylindersOf(testScene("ur5_box").scene->name), VampCylinders::Boxes);
  EXPECT_EQ(vampCylindersOf(testScene("ur5_cage").scene->name), VampCylinders::Capsules);
  const PlanningScene scene = *testScene("ur5_box").scene;
  const std::vector<double> states = testScene("ur5_box").randomStates(kStates, 3);
  EXPECT_EQ(vampAnswers(scene, states, VampCylinders::Boxes), exactSphereAnswers(withBoxes(scene), states));
}

TEST_F(Vamp, AnswersInBlocksAsStateByState)
{
  const TestScene& test = testScene("ur5_table_pick");
  const std::vector<double> states = makeStates(test, "motion", kStates, 1);
  const std::vector<std::uint8_t> vamp = vampAnswers(*test.scene, states);
  expectSomeOfBoth(vamp);
  const VampCheck check(*test.scene, VampCylinders::Capsules);
  for (std::size_t i = 0; i < vamp.size(); ++i)
  {
    std::uint8_t alone = 2;
    check.check(&states[i * test.lower.size()], 1, &alone);
    EXPECT_EQ(vamp[i], alone) << i;
  }
}

TEST_F(Vamp, SaysWhichScenesItDoesNotCheck)
{
  const PlanningScene& scene = *testScene("ur5_cage").scene;
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  EXPECT_EQ(whyVampRefuses(scene), "");
  EXPECT_EQ(whyVampRefuses(withObject(scene, Sphere{0.1}, pose)), "");
  EXPECT_EQ(whyVampRefuses(withObject(scene, Cone{0.1, 0.2}, pose)),
            "VAMP knows spheres, capsules and boxes, but object object has a cone");
  const Shape mesh = tessellate(Box{{0.1, 0.1, 0.1}}).mesh;
  EXPECT_EQ(whyVampRefuses(withObject(scene, mesh, pose)),
            "VAMP knows spheres, capsules and boxes, but object object has a mesh");
  EXPECT_EQ(whyVampRefuses(*withPadding(testScene("ur5_cage"), 0.01).scene), "VAMP has no padding, but a link has one");
  EXPECT_EQ(whyVampRefuses(*testScene("arm_boxes").scene),
            "VAMP's check is generated for one robot, the ur5 with the Robotiq gripper");
  PlanningScene carrying = withObject(scene, Sphere{0.02}, Eigen::Isometry3d(Eigen::Translation3d(2.0, 0.0, 1.0)));
  carrying.attach("object", "ee_link", {}, scene.robot->defaultState().data());
  EXPECT_EQ(whyVampRefuses(carrying),
            "VAMP's check of this benchmark has no attached objects, but the robot carries object");
  EXPECT_THROW(VampCheck(carrying, VampCylinders::Capsules), Error);
}

// docs/sphere_models.md says so.
TEST_F(Vamp, CollidesInEveryStateWithThePairsOfTheSrdf)
{
  const PlanningScene& scene = *testScene("ur5_cage").scene;
  PlanningScene spheres = withSpheres(scene, loadVampModel(*scene.robot));
  spheres.objects.clear();
  const std::vector<double> states = anywhere(scene, 200);
  expectSomeOfBoth(exactAnswers(spheres, states));
  spheres.allowed_collisions = AllowedCollisionMatrix::fromRobot(*scene.robot);
  EXPECT_EQ(exactAnswers(spheres, states), std::vector<std::uint8_t>(200, 0));
}

TEST(VampPairs, AreReadFromTheCommentsOfTheCheck)
{
  const std::string path = (std::filesystem::path(testing::TempDir()) / "vamp_pairs_test.hh").string();
  std::ofstream(path) << "// x vs. y\n  inline static bool fkcc(\n  // environment vs. robot collisions\n  // b vs. a\n"
                         "  // a vs. c\n  inline static bool fkcc_attach(\n  // a vs. d\n";
  EXPECT_EQ(readVampPairs(path), (LinkPairs{{"a", "b"}, {"a", "c"}}));
  std::ofstream(path) << "// x vs. y\n";
  EXPECT_THROW(readVampPairs(path), Error);
  std::filesystem::remove(path);
  EXPECT_THROW(readVampPairs(path), Error);
}
}  // namespace gpu_planning_scene::core::benchmark
