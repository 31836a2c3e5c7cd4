#include "scene/change_testing.h"

#include <algorithm>
#include <stdexcept>

#include "scene/solid_rules.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene::core
{
namespace
{
SceneChange only(const ObjectChange& object)
{
  SceneChange change;
  change.is_diff = true;
  change.objects = {object};
  return change;
}

SceneChange only(const AttachedChange& attached)
{
  SceneChange change;
  change.is_diff = true;
  change.state.attached = {attached};
  return change;
}

void expectSamePose(const Eigen::Isometry3d& expected, const Eigen::Isometry3d& found, double tolerance)
{
  EXPECT_LE((expected.matrix() - found.matrix()).cwiseAbs().maxCoeff(), tolerance) << expected.matrix() << "\n"
                                                                                   << found.matrix();
}

struct ExpectSameShape
{
  double tolerance;

  void operator()(const Box& a, const Box& b) const { EXPECT_EQ(a.size, b.size); }
  void operator()(const Sphere& a, const Sphere& b) const { EXPECT_EQ(a.radius, b.radius); }
  void operator()(const Cylinder& a, const Cylinder& b) const
  {
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.length, b.length);
  }
  void operator()(const Cone& a, const Cone& b) const
  {
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.length, b.length);
  }
  void operator()(const HalfSpace& a, const HalfSpace& b) const
  {
    EXPECT_LE((a.normal - b.normal).norm(), tolerance);
    EXPECT_NEAR(a.offset, b.offset, tolerance);
  }
  void operator()(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b) const
  {
    EXPECT_EQ(a->vertices, b->vertices);
    EXPECT_EQ(a->triangles, b->triangles);
  }
  template <class A, class B>
  void operator()(const A&, const B&) const
  {
    ADD_FAILURE() << "shapes of different kinds";
  }
};

void expectSameShapes(const std::vector<PlacedShape>& expected, const std::vector<PlacedShape>& found, double tolerance)
{
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    expectSamePose(expected[i].pose, found[i].pose, tolerance);
    std::visit(ExpectSameShape{tolerance}, expected[i].shape, found[i].shape);
  }
}

using FramePoses = std::map<std::string, Eigen::Isometry3d>;
void expectSameFrames(const FramePoses& expected, const FramePoses& found, double tolerance)
{
  ASSERT_EQ(expected.size(), found.size());
  for (const auto& [name, pose] : expected)
  {
    ASSERT_EQ(1u, found.count(name)) << name;
    expectSamePose(pose, found.at(name), tolerance);
  }
}

void expectSameObject(const WorldObject& expected, const WorldObject& found, double tolerance)
{
  SCOPED_TRACE(expected.id);
  expectSamePose(expected.pose, found.pose, tolerance);
  expectSameShapes(expected.shapes, found.shapes, tolerance);
  expectSameFrames(expected.subframes, found.subframes, tolerance);
  EXPECT_EQ(expected.padding, found.padding);
  EXPECT_EQ(expected.type, found.type);
}

void expectOneLine(const std::string& message, const std::string& fragment)
{
  EXPECT_NE(std::string::npos, message.find(fragment)) << "'" << message << "' lacks '" << fragment << "'";
  EXPECT_EQ(std::string::npos, message.find('\n')) << message;
}
}  // namespace

Eigen::Isometry3d poseAt(double x, double y, double z, double angle_about_z)
{
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(angle_about_z, Eigen::Vector3d::UnitZ());
}

PlacedShape boxAt(double size, const Eigen::Isometry3d& pose)
{
  return {Box{Eigen::Vector3d::Constant(size)}, pose};
}

PlacedShape triangleAt(const Eigen::Isometry3d& pose)
{
  const Mesh triangle{"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  return {std::make_shared<const Mesh>(triangle), pose};
}

ObjectChange objectChange(Operation operation, const std::string& id, std::vector<PlacedShape> shapes)
{
  ObjectChange change;
  change.operation = operation;
  change.id = id;
  change.shapes = std::move(shapes);
  return change;
}

AttachedChange attachedChange(Operation operation, const std::string& id, const std::string& link,
                              std::vector<PlacedShape> shapes)
{
  AttachedChange change;
  change.object = objectChange(operation, id, std::move(shapes));
  change.link = link;
  return change;
}

void expectSameScene(const PlanningScene& expected, const PlanningScene& found, double tolerance)
{
  EXPECT_EQ(expected.name, found.name);
  EXPECT_EQ(expected.robot->name(), found.robot->name());
  EXPECT_EQ(expected.robot->linkScale(), found.robot->linkScale());
  EXPECT_EQ(solidRulesOf(expected), solidRulesOf(found));
  EXPECT_EQ(expected.link_padding, found.link_padding);
  EXPECT_TRUE(expected.allowed_collisions == found.allowed_collisions);
  EXPECT_EQ(expected.matrix_source, found.matrix_source);
  EXPECT_EQ(expected.current_state, found.current_state);
  EXPECT_EQ(expected.colors, found.colors);
  EXPECT_EQ(expected.revision, found.revision);
  expectSameFrames(expected.fixed_frames, found.fixed_frames, tolerance);
  ASSERT_EQ(expected.objects.size(), found.objects.size());
  for (const WorldObject& object : expected.objects)
  {
    const WorldObject* const other = found.findObject(object.id);
    ASSERT_NE(nullptr, other) << object.id;
    expectSameObject(object, *other, tolerance);
  }
  ASSERT_EQ(expected.attached.size(), found.attached.size());
  for (const AttachedObject& attached : expected.attached)
  {
    const AttachedObject* const other = found.findAttached(attached.object.id);
    ASSERT_NE(nullptr, other) << attached.object.id;
    expectSameObject(attached.object, other->object, tolerance);
    EXPECT_EQ(attached.link, other->link);
    EXPECT_EQ(attached.touch_links, other->touch_links);
    EXPECT_EQ(attached.weight, other->weight);
    EXPECT_TRUE(attached.detach_posture == other->detach_posture);
    EXPECT_EQ(attached.padding, other->padding);
    expectSameShapes(attached.shapes(), other->shapes(), tolerance);
  }
}

void SceneChanges::apply(const SceneChange& change)
{
  ChangedScene result = applyChange(scene_, state_, change, defaults_, limits_, frames_);
  scene_ = std::move(result.scene);
  state_ = std::move(result.state);
  warnings_ = std::move(result.warnings);
  EXPECT_EQ(state_, scene_.current_state);
  EXPECT_NO_THROW(validateScene(scene_));
}

void SceneChanges::change(const ObjectChange& object)
{
  apply(only(object));
}

void SceneChanges::change(const AttachedChange& attached)
{
  apply(only(attached));
}

void SceneChanges::refused(const std::string& fragment, const SceneChange& change)
{
  const PlanningScene before = scene_;
  expectOneLine(errorOf([&] { apply(change); }), fragment);
  expectSameScene(before, scene_);
}

void SceneChanges::refused(const std::string& fragment, const ObjectChange& object)
{
  refused(fragment, only(object));
}

void SceneChanges::refused(const std::string& fragment, const AttachedChange& attached)
{
  refused(fragment, only(attached));
}

const WorldObject& SceneChanges::object(const std::string& id) const
{
  const WorldObject* const found = scene_.findObject(id);
  return found != nullptr ? *found : throw std::runtime_error("the world has no object " + id);
}

const AttachedObject& SceneChanges::carried(const std::string& id) const
{
  const AttachedObject* const found = scene_.findAttached(id);
  return found != nullptr ? *found : throw std::runtime_error("no link carries " + id);
}

bool SceneChanges::warned(const std::string& fragment) const
{
  return std::any_of(
      warnings_.begin(), warnings_.end(),
      [&](const std::string& warning) { return warning.find(fragment) != std::string::npos; });
}
}  // namespace gpu_planning_scene::core
