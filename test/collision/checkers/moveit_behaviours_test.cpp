// The behaviours that MoveIt's tests require of its collision detectors, tested here on robots of Debian and of the
// shared problems.

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/scene_change.h"
#include "gpu_planning_scene/state_inspector.h"
#include "model/real_robots.h"
#include "support/checkers.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

/// A robot with a pose in which its links collide. Its default pose is free.
struct Subject
{
  const char* scene;  // as in testScene()
  const char* tip;    // its last link
  std::vector<std::pair<const char*, double>> folded;
};

void PrintTo(const Subject& subject, std::ostream* out)
{
  *out << subject.scene;
}

class MoveitBehaviours : public testing::TestWithParam<std::tuple<const char*, Subject>>
{
 protected:
  void SetUp() override
  {
    const std::string missing = missingFor(subject().scene);
    if (!missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    scene_ = std::make_unique<PlanningScene>(*testScene(subject().scene).scene);
    scene_->objects.clear();
    scene_->attached.clear();
    scene_->link_padding.clear();
    state_ = scene_->robot->defaultState();
  }

  const Subject& subject() const { return std::get<1>(GetParam()); }
  StateChecker& checker() const { return checkerOf(std::get<0>(GetParam()), *scene_); }
  int tip() const { return scene_->robot->linkIndex(subject().tip); }

  /// The names of the pair that collides, ordered by body; empty if the state is free.
  std::string collision(const std::vector<double>& state) const
  {
    const BatchResult result = checker().check(state.data(), 1);
    return result.valid[0] != 0
               ? ""
               : scene_->bodyName(result.colliding[0][0]) + ", " + scene_->bodyName(result.colliding[0][1]);
  }
  bool free() const { return collision(state_).empty(); }

  const StateInspector& inspector() const
  {
    static std::unique_ptr<StateInspector> last;  // the next inspector reuses its trees
    auto next = std::make_unique<StateInspector>(std::make_shared<const PlanningScene>(*scene_), last.get());
    last = std::move(next);
    return *last;
  }

  std::vector<Contact> contacts(std::size_t max_contacts, std::size_t per_pair = 0) const
  {
    return inspector().contacts(state_.data(), "", max_contacts, per_pair);
  }

  Isometry3d tipPose(const std::vector<double>& state) const
  {
    std::vector<Isometry3d> poses(scene_->robot->links().size());
    scene_->robot->linkPoses(state.data(), poses.data());
    return poses[static_cast<std::size_t>(tip())];
  }

  /// The centre of the bounding box of the last link's first shape.
  Vector3d atTip() const
  {
    const PlacedShape& placed = scene_->robot->links()[static_cast<std::size_t>(tip())].shapes.at(0);
    Eigen::AlignedBox3d bounds;
    const Tessellation surface = tessellate(placed.shape);
    for (const Vector3d& vertex : surface.mesh->vertices)
      bounds.extend(vertex);
    return tipPose(state_) * placed.pose * bounds.center();
  }

  void add(const std::string& id, const Shape& shape, const Vector3d& place)
  {
    scene_->objects.push_back({id, Isometry3d(Translation3d(place)), {{shape}}});
  }

  std::unique_ptr<PlanningScene> scene_;
  std::vector<double> state_;
};

TEST_P(MoveitBehaviours, TheDefaultPoseIsFree)
{
  EXPECT_EQ(collision(state_), "");
  EXPECT_TRUE(contacts(10).empty());
}

TEST_P(MoveitBehaviours, LinksThatFoldIntoEachOtherCollide)
{
  for (const auto& [name, value] : subject().folded)
  {
    ASSERT_GE(scene_->robot->variableIndex(name), 0) << name;
    state_[static_cast<std::size_t>(scene_->robot->variableIndex(name))] = value;
  }
  EXPECT_NE(collision(state_), "");
  const auto found = contacts(10);
  ASSERT_FALSE(found.empty());
  const int links = static_cast<int>(scene_->robot->links().size());
  EXPECT_LT(found[0].bodies[1], links);
}

TEST_P(MoveitBehaviours, AWorldBoxIsHitWhereItIsAddedOrMovedToAndNoMoreWhereItIsRemoved)
{
  add("box", Box{{0.1, 0.1, 0.1}}, atTip());
  EXPECT_NE(collision(state_).find("box"), std::string::npos);
  scene_->objects[0].pose = Isometry3d(Translation3d(10, 10, 10));
  EXPECT_TRUE(free());
  scene_->objects[0].pose = Isometry3d(Translation3d(atTip()));
  EXPECT_FALSE(free());
  scene_->objects.clear();
  EXPECT_TRUE(free());
}

TEST_P(MoveitBehaviours, PaddingMakesANearBoxCollideByItsDistance)
{
  add("box", Box{{0.1, 0.1, 0.1}}, atTip() + Vector3d(0, 0, 5));
  const double distance = inspector().clearance(state_.data(), "").world;
  ASSERT_GT(distance, 1.0);
  EXPECT_TRUE(free());
  scene_->link_padding.assign(scene_->robot->links().size(), distance - 1e-3);
  EXPECT_TRUE(free());
  scene_->link_padding.assign(scene_->robot->links().size(), distance + 1e-3);
  EXPECT_FALSE(free());
  ASSERT_EQ(contacts(1).size(), 1u);
  EXPECT_NEAR(contacts(1)[0].depth, 1e-3, 1e-5);
}

TEST_P(MoveitBehaviours, ContactsAreAtMostAsManyAsRequestedAndLieInTheBox)
{
  const Vector3d place = atTip();
  add("box", Box{{0.1, 0.1, 0.1}}, place);
  for (const std::size_t max_contacts : {1u, 2u, 5u})
  {
    const auto found = contacts(max_contacts);
    EXPECT_LE(found.size(), max_contacts);
    EXPECT_GE(found.size(), 1u);
  }
  for (const Contact& contact : contacts(100))
    if (scene_->bodyName(contact.bodies[1]) == "box")
      EXPECT_LE((contact.point - place).cwiseAbs().maxCoeff(), 0.05 + 1e-3);
  for (const Contact& contact : contacts(100, 1))
    EXPECT_EQ(scene_->bodyName(contact.bodies[1]), "box");
}

TEST_P(MoveitBehaviours, ACarriedObjectMovesWithItsLinkAndHitsTheWorld)
{
  WorldObject stick;
  stick.id = "stick";
  stick.shapes = {{Box{{0.02, 0.02, 0.02}}}};
  stick.pose = tipPose(state_).inverse() * Translation3d(atTip() + Vector3d(0, 0, 3));
  scene_->attached.push_back({stick, tip(), {}});
  EXPECT_TRUE(free());
  add("box", Box{{0.1, 0.1, 0.1}}, atTip() + Vector3d(0, 0, 3));
  EXPECT_EQ(collision(state_), "box, stick");
  scene_->objects[0].pose = Isometry3d(Translation3d(atTip() + Vector3d(0, 0, 6)));
  EXPECT_TRUE(free());
  // In another state the stick is elsewhere.
  scene_->objects[0].pose = Isometry3d(Translation3d(atTip() + Vector3d(0, 0, 3)));
  state_[1] += 0.3;
  EXPECT_EQ(collision(state_).find("stick"), std::string::npos);
}

TEST_P(MoveitBehaviours, AnObjectOfTheWorldCanBeAttachedAndPutBack)
{
  add("box", Box{{0.1, 0.1, 0.1}}, atTip());
  EXPECT_FALSE(free());
  std::vector<std::string> touch;
  for (const Link& link : scene_->robot->links())
    touch.push_back(link.name);
  scene_->attach("box", subject().tip, touch, state_.data());
  EXPECT_TRUE(scene_->objects.empty());
  EXPECT_TRUE(free());
  scene_->detach("box", state_.data());
  EXPECT_NE(collision(state_).find("box"), std::string::npos);
}

TEST_P(MoveitBehaviours, AChangeOfACopyLeavesTheSceneItself)
{
  add("box", Box{{0.1, 0.1, 0.1}}, atTip());
  PlanningScene changed = *scene_;
  changed.allowed_collisions.setDefault("box", true);
  changed.revision += 1;
  EXPECT_FALSE(free());
  StateChecker& same = checker();
  same.setScene(std::make_shared<const PlanningScene>(changed));
  const BatchResult result = same.check(state_.data(), 1);
  EXPECT_EQ(result.valid[0], 1);
  EXPECT_EQ(result.revision, changed.revision);
  EXPECT_FALSE(free());
}

TEST_P(MoveitBehaviours, ADifferenceChangesWhatItNamesAndNoMore)
{
  add("box", Box{{0.1, 0.1, 0.1}}, atTip());
  add("ball", Sphere{0.1}, Vector3d(10, 10, 10));
  SceneChange change;
  change.is_diff = true;
  ObjectChange removal;
  removal.id = "box";
  removal.operation = Operation::Remove;
  change.objects.push_back(removal);
  const ChangedScene changed = applyChange(*scene_, state_, change, {}, {}, {});
  EXPECT_FALSE(free());
  *scene_ = changed.scene;
  EXPECT_TRUE(free());
  ASSERT_EQ(scene_->objects.size(), 1u);
  EXPECT_EQ(scene_->objects[0].id, "ball");
}

TEST_P(MoveitBehaviours, AMeshIsHitWhereItIsMovedTo)
{
  add("torus", torusMesh(0.2, 0.05), atTip() + Vector3d(0, 0, 5));
  EXPECT_TRUE(free());
  for (int half_metres = 10; half_metres > 0; --half_metres)
  {
    const double height = 0.5 * half_metres;
    scene_->objects[0].pose = Isometry3d(Translation3d(atTip() + Vector3d(0, 0, height)));
    CpuChecker fresh(std::make_shared<const PlanningScene>(*scene_));
    EXPECT_EQ(free(), fresh.check(state_.data(), 1).valid[0] != 0) << height << " m above the tip";
  }
  scene_->objects[0].pose = Isometry3d(Translation3d(atTip() + Vector3d(0.2, 0, 0)));
  EXPECT_NE(collision(state_).find("torus"), std::string::npos);
  scene_->objects[0].pose = Isometry3d(Translation3d(atTip() + Vector3d(0, 0, 5)));
  EXPECT_TRUE(free());
}

TEST_P(MoveitBehaviours, AShapeOfAnotherSizeIsAnotherShape)
{
  add("ball", Sphere{0.5}, atTip() + Vector3d(0, 0, 5));
  EXPECT_TRUE(free());
  scene_->objects[0].shapes = {{Sphere{5.1}}};
  EXPECT_FALSE(free());
  scene_->objects[0].shapes = {{Sphere{0.4}}};
  EXPECT_TRUE(free());
}

TEST_P(MoveitBehaviours, TenThousandBoxesAreTaken)
{
  for (int i = 0; i < 10000; ++i)
  {
    const int row = i / 100;
    add("box " + std::to_string(i), Box{{0.01, 0.01, 0.01}}, Vector3d(10.0 + 0.1 * (i % 100), 0.1 * row, 0.0));
  }
  EXPECT_TRUE(free());
  scene_->objects[7777].pose = Isometry3d(Translation3d(atTip()));
  scene_->objects[7777].shapes = {{Box{{0.1, 0.1, 0.1}}}};
  EXPECT_NE(collision(state_).find("box 7777"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Robots, MoveitBehaviours,
    testing::Combine(
        testing::Values("cpu", "work_queue"),
        testing::Values(Subject{"kr5", "palm", {{"elbow_roll", 1.36}, {"wrist_pitch", 2.05}, {"wrist_roll", -0.61}}},
                        Subject{"ur5_table_pick", "wrist_3_link", {{"elbow_joint", 3.1}}})),
    [](const auto& parameters)
    { return std::string(std::get<0>(parameters.param)) + "_" + std::get<1>(parameters.param).scene; });
}  // namespace
}  // namespace gpu_planning_scene::core
