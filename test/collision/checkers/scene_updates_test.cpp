// A checker keeps trees, components and tessellations from scene to scene. After each of many edits its answers must
// equal the answers of a new checker for the current scene.

#include <functional>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/trees/object_tree.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "support/generated_arm.h"
#include "support/obstacles.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
class SceneEdits
{
 public:
  /// `robots`: the robots that edits put into the scene, beginning with the first one. They differ only in meshes.
  explicit SceneEdits(std::vector<std::shared_ptr<const RobotModel>> robots)
    : robots_(std::move(robots)), scene_(robots_.front()), state_(scene_.robot->defaultState())
  {
    for (int i = 0; i < 9; ++i)
      add();
  }

  std::shared_ptr<const PlanningScene> next()
  {
    using Edit = void (SceneEdits::*)();
    constexpr Edit kEdits[] = {&SceneEdits::add,      &SceneEdits::add,      &SceneEdits::remove,
                               &SceneEdits::move,     &SceneEdits::move,     &SceneEdits::resize,
                               &SceneEdits::attach,   &SceneEdits::detach,   &SceneEdits::regrip,
                               &SceneEdits::regrip,   &SceneEdits::pad,      &SceneEdits::addLarge,
                               &SceneEdits::padLinks, &SceneEdits::allow,    &SceneEdits::allowByDefault,
                               &SceneEdits::addFloor, &SceneEdits::takeRobot};
    (this->*kEdits[random_() % std::size(kEdits)])();
    ++scene_.revision;
    return std::make_shared<const PlanningScene>(scene_);
  }

  /// The current scene with an additional object whose mesh is invalid.
  std::shared_ptr<const PlanningScene> refused() const
  {
    auto scene = std::make_shared<PlanningScene>(scene_);
    const auto bad = std::make_shared<Mesh>(*tessellate(Box{{0.1, 0.1, 0.1}}).mesh);
    bad->triangles[0][0] = 99;
    const WorldObject object = {"bad", Eigen::Isometry3d::Identity(), {{bad}}, 0.0};
    scene->objects.insert(scene->objects.begin() + (scene->objects.empty() ? 0 : 1), object);
    scene->link_padding.clear();
    return scene;
  }

  std::vector<double> states(std::size_t count)
  {
    std::vector<double> states(count * state_.size());
    for (std::size_t i = 0; i < count; ++i)
      scene_.robot->randomState(random_, &states[i * state_.size()]);
    return states;
  }

 private:
  WorldObject* any() { return scene_.objects.empty() ? nullptr : &scene_.objects[random_() % scene_.objects.size()]; }
  std::string newName() { return "object_" + std::to_string(count_++); }

  void add()
  {
    WorldObject object = generateObstacles({1, {0.0, 0.0, 0.5}, 0.2, 0.9, 0.3}, random_()).front();
    object.id = newName();
    scene_.objects.push_back(object);
  }
  /// Adds a mesh of many triangles, so that trees of removed objects fill the memory.
  void addLarge()
  {
    WorldObject object;
    object.id = newName();
    object.pose.translation() = Eigen::Vector3d(0.7, 0.1, 0.4);
    const double radius = std::uniform_real_distribution<double>(0.25, 0.35)(random_);
    object.shapes.push_back({tessellate(Sphere{radius}).mesh});
    scene_.objects.push_back(object);
    if (scene_.objects.size() > 8)
      scene_.objects.erase(scene_.objects.begin());
  }
  static bool isFloor(const WorldObject& object) { return std::holds_alternative<HalfSpace>(object.shapes[0].shape); }
  void remove()
  {
    if (!scene_.objects.empty())
      scene_.objects.erase(scene_.objects.begin() + static_cast<std::ptrdiff_t>(random_() % scene_.objects.size()));
  }
  void move()
  {
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    if (WorldObject* object = any())
    {
      object->pose.translation() += Eigen::Vector3d(uniform(random_), uniform(random_), uniform(random_));
      object->pose.rotate(Eigen::AngleAxisd(uniform(random_), Eigen::Vector3d::UnitY()));
    }
  }
  void resize()
  {
    const double size = std::uniform_real_distribution<double>(0.05, 0.3)(random_);
    if (WorldObject* object = any())
      object->shapes = {{Box{{size, 0.1, 2.0 * size}}}, {Cylinder{size / 2.0, 0.2}}};
  }
  void attach()
  {
    if (WorldObject* object = any(); object != nullptr && scene_.attached.size() < 2 && !isFloor(*object))
    {
      const auto& links = scene_.robot->links();
      scene_.attach(object->id, links[random_() % links.size()].name, {}, state_.data());
    }
  }
  void detach()
  {
    if (!scene_.attached.empty())
      scene_.detach(std::string(scene_.attached.front().object.id), state_.data());
  }
  /// Moves an attached object in the hand, changes its shape, or attaches it to another link.
  void regrip()
  {
    if (scene_.attached.empty())
      return;
    AttachedObject& attached = scene_.attached[random_() % scene_.attached.size()];
    const double length = std::uniform_real_distribution<double>(0.02, 0.4)(random_);
    switch (random_() % 3)
    {
      case 0:
        attached.object.pose.translation() *= 5.0 * length;
        break;
      case 1:
        attached.object.shapes = {{Cylinder{0.03, length}}};
        break;
      default:
        attached.link = static_cast<int>(random_() % scene_.robot->links().size());
    }
  }
  void pad()
  {
    if (WorldObject* object = any())
      object->padding = object->padding > 0.0 ? 0.0 : 0.02;
  }

  void padLinks()
  {
    scene_.link_padding.assign(scene_.robot->links().size(), 0.0);
    for (double& padding : scene_.link_padding)
      padding = random_() % 2 == 0 ? 0.0 : 0.03;
  }
  std::string anyName()
  {
    const std::size_t links = scene_.robot->links().size();
    const std::size_t body = random_() % (links + scene_.objects.size());
    return body < links ? scene_.robot->links()[body].name : scene_.objects[body - links].id;
  }
  void allow()
  {
    const std::string first = anyName();
    const bool allowed = random_() % 4 == 0;
    scene_.allowed_collisions.setEntry(first, anyName(), allowed);
  }
  void allowByDefault()
  {
    if (const WorldObject* object = any())
      scene_.allowed_collisions.setDefault(object->id, random_() % 4 == 0);
  }
  /// Adds a slightly tilted half-space that the arm hits in some states.
  void addFloor()
  {
    WorldObject object;
    object.id = newName();
    object.pose.translation().z() = -std::uniform_real_distribution<double>(0.3, 0.9)(random_);
    object.pose.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
    object.shapes.push_back({HalfSpace{Eigen::Vector3d::UnitZ(), 0.0}});
    scene_.objects.push_back(object);
  }
  void takeRobot() { scene_.robot = robots_[random_() % robots_.size()]; }

  std::vector<std::shared_ptr<const RobotModel>> robots_;
  std::mt19937_64 random_{kSeed};
  PlanningScene scene_;
  std::vector<double> state_;
  int count_ = 0;
};

/// Compares `checker` with new checkers after each edit. The verdicts are those of a checker that leaves no pairs out.
void expectAnswersOfAFreshChecker(StateChecker& checker, int edits)
{
  std::cout << "seed " << kSeed << std::endl;
  SceneEdits scene({GeneratedArm(2000).load(), GeneratedArm(1000).load()});
  Reductions none;
  none.reach = none.rigid_pairs = none.shared_trees = none.direct_primitives = false;
  CheckerOptions without;
  without.reductions = none;
  std::size_t valid = 0;
  std::size_t all = 0;
  for (int edit = 0; edit < edits; ++edit)
  {
    const auto now = scene.next();
    checker.setScene(now);
    if (edit % 5 == 4)
      EXPECT_THROW(checker.setScene(scene.refused()), Error);
    const std::size_t count = 48;
    const std::vector<double> states = scene.states(count);
    const BatchResult answers = checker.check(states.data(), count);
    CpuChecker whole(now, without);
    const BatchResult expected = whole.check(states.data(), count);
    ASSERT_EQ(answers.valid, expected.valid) << "after edit " << edit;
    EXPECT_EQ(answers.revision, now->revision);
    for (const Group& group : now->robot->groups())
      ASSERT_EQ(checker.check(states.data(), count, group.name).valid,
                whole.check(states.data(), count, group.name).valid)
          << "after edit " << edit << ", group " << group.name;
    CpuChecker fresh(now);
    const SceneReport report = checker.report();
    const SceneReport fresh_report = fresh.report();
    EXPECT_EQ(report.triangles, fresh_report.triangles);
    EXPECT_EQ(report.trees, fresh_report.trees);
    ASSERT_EQ(report.unreachable_self_pairs, fresh_report.unreachable_self_pairs) << "after edit " << edit;
    ASSERT_EQ(report.unreachable_world_pairs, fresh_report.unreachable_world_pairs) << "after edit " << edit;
    ASSERT_EQ(report.unreachable_objects, fresh_report.unreachable_objects) << "after edit " << edit;
    for (const std::uint8_t is_valid : answers.valid)
      valid += is_valid;
    all += count;
  }
  std::cout << valid << " of " << all << " states are free" << std::endl;
  EXPECT_GT(valid, all / 20);
  EXPECT_LT(valid, all - all / 20);
}

std::shared_ptr<const PlanningScene> anyScene()
{
  return std::make_shared<const PlanningScene>(GeneratedArm(200).load());
}

TEST(SceneUpdates, OnTheGpuAreAnsweredAsByAFreshChecker)
{
  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker checker(anyScene(), options);
  expectAnswersOfAFreshChecker(checker, repetitions(15, 40));
}

TEST(SceneUpdates, OnTheCpuAreAnsweredAsByAFreshChecker)
{
  CpuChecker checker(anyScene());
  expectAnswersOfAFreshChecker(checker, repetitions(15, 40));
}

TEST(SceneUpdates, WithoutSharedTreesAreAnsweredAsByAFreshChecker)
{
  BatchCheckerOptions options;
  options.device_only = true;
  options.reductions.shared_trees = false;
  BatchChecker checker(anyScene(), options);
  auto scene = std::make_shared<PlanningScene>(GeneratedArm(200).load());
  const auto mesh = tessellate(Sphere{0.1}).mesh;
  for (int i = 0; i < 3; ++i)
  {
    WorldObject object;
    object.id = "sphere_" + std::to_string(i);
    object.pose.translation() = Eigen::Vector3d(0.5, 0.3 * (i - 1), 0.5);
    object.shapes.push_back({mesh});
    scene->objects.push_back(object);
    const auto now = std::make_shared<const PlanningScene>(*scene);
    checker.setScene(now);
    CpuChecker fresh(now);
    std::mt19937_64 random(kSeed);
    std::vector<double> states(200 * scene->robot->variables().size());
    for (std::size_t k = 0; k < 200; ++k)
      scene->robot->randomState(random, &states[k * scene->robot->variables().size()]);
    EXPECT_EQ(checker.check(states.data(), 200).valid, fresh.check(states.data(), 200).valid);
    EXPECT_EQ(checker.report().trees, fresh.report().trees + static_cast<std::size_t>(i));
  }
}

TEST(SceneUpdates, AMeshThatIsNotValidIsRefusedAmongThoseThatWereSeen)
{
  auto scene = std::make_shared<PlanningScene>(GeneratedArm(200).load());
  const auto good = std::make_shared<Mesh>(*tessellate(Box{{0.1, 0.1, 0.1}}).mesh);
  scene->objects.push_back({"good", Eigen::Isometry3d::Identity(), {{good}}, 0.0});
  CpuChecker checker(std::make_shared<const PlanningScene>(*scene));
  checker.setScene(std::make_shared<const PlanningScene>(*scene));
  for (int i = 0; i < 20; ++i)  // new meshes are likely to reuse the addresses of old ones
  {
    const auto bad = std::make_shared<Mesh>(*good);
    bad->triangles[0][0] = 99;
    auto with_bad = std::make_shared<PlanningScene>(*scene);
    with_bad->objects.push_back({"bad", Eigen::Isometry3d::Identity(), {{bad}}, 0.0});
    EXPECT_THROW(checker.setScene(with_bad), Error);
    auto with_other = std::make_shared<PlanningScene>(*scene);
    with_other->objects.push_back({"other", Eigen::Isometry3d::Identity(), {{std::make_shared<Mesh>(*good)}}, 0.0});
    EXPECT_NO_THROW(checker.setScene(with_other));
  }
}

/// Expects that every box is in exactly one leaf and inside all nodes above it.
void expectHoldsAll(const ObjectTree& tree, const std::vector<Eigen::AlignedBox3d>& boxes)
{
  std::vector<int> seen(boxes.size(), 0);
  const std::function<Eigen::AlignedBox3d(std::uint32_t)> visit = [&](std::uint32_t index)
  {
    const Node& node = tree.nodes()[index];
    Eigen::AlignedBox3d below;
    if (node.count == 0)
      below = visit(node.first).merged(visit(node.first + 1));
    else
    {
      const std::uint32_t object = tree.order()[node.first];
      ++seen[object];
      below = boxes[object];
    }
    const Eigen::Vector3d center(node.center[0], node.center[1], node.center[2]);
    const Eigen::Vector3d half(node.half[0], node.half[1], node.half[2]);
    EXPECT_TRUE(Eigen::AlignedBox3d(center - half, center + half).contains(below));
    return below;
  };
  visit(0);
  EXPECT_EQ(seen, std::vector<int>(boxes.size(), 1));
}

TEST(ObjectTreeTest, HoldsBoxesThatMoveAndStaysAsGoodAsANewOne)
{
  std::cout << "seed " << kSeed << std::endl;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto point = [&] { return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)); };
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 300; ++i)
  {
    const Eigen::Vector3d low = 3.0 * point();
    boxes.emplace_back(low, low + 0.1 * point().cwiseAbs());
  }
  const auto area = [](const ObjectTree& tree)
  {
    double sum = 0.0;
    for (const Node& n : tree.nodes())
      sum += double{n.half[0]} * n.half[1] + double{n.half[1]} * n.half[2] + double{n.half[2]} * n.half[0];
    return sum;
  };
  ObjectTree tree(boxes, ObjectTree());
  expectHoldsAll(tree, boxes);
  for (int step = 0; step < 200; ++step)
  {
    boxes[random() % boxes.size()].translate(point());
    if (step % 40 == 39)
      boxes.pop_back();
    tree = ObjectTree(boxes, tree);
    expectHoldsAll(tree, boxes);
    ASSERT_LE(area(tree), 1.5 * area(ObjectTree(boxes, ObjectTree())));
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
