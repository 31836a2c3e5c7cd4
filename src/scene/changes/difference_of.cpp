#include <algorithm>
#include <unordered_map>
#include <variant>

#include "gpu_planning_scene/octomap.h"
#include "gpu_planning_scene/scene_change.h"
#include "scene/solid_rules.h"

// The change that leads from one scene to another.
namespace gpu_planning_scene::core
{
namespace
{
struct SameShape
{
  bool operator()(const Box& a, const Box& b) const { return a.size == b.size; }
  bool operator()(const Sphere& a, const Sphere& b) const { return a.radius == b.radius; }
  bool operator()(const Cylinder& a, const Cylinder& b) const { return a.radius == b.radius && a.length == b.length; }
  bool operator()(const Cone& a, const Cone& b) const { return a.radius == b.radius && a.length == b.length; }
  bool operator()(const HalfSpace& a, const HalfSpace& b) const { return a.normal == b.normal && a.offset == b.offset; }
  bool operator()(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b) const
  {
    return a == b || (a->triangles == b->triangles && a->vertices == b->vertices && a->solid == b->solid);
  }
  template <class A, class B>
  bool operator()(const A&, const B&) const
  {
    return false;
  }
};

bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return a.matrix() == b.matrix();
}

bool sameShapes(const WorldObject& a, const WorldObject& b)
{
  return std::equal(
      a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(),
      [](const PlacedShape& x, const PlacedShape& y) { return std::visit(SameShape(), x.shape, y.shape); });
}

bool sameShapePoses(const WorldObject& a, const WorldObject& b)
{
  return std::equal(
      a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(),
      [](const PlacedShape& x, const PlacedShape& y) { return same(x.pose, y.pose); });
}

using Frames = std::map<std::string, Eigen::Isometry3d>;

bool sameFrames(const Frames& a, const Frames& b)
{
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const auto& x, const auto& y) { return x.first == y.first && same(x.second, y.second); });
}

bool sameObject(const WorldObject& a, const WorldObject& b)
{
  return same(a.pose, b.pose) && sameShapes(a, b) && sameShapePoses(a, b) && sameFrames(a.subframes, b.subframes) &&
         a.type == b.type;
}

bool sameCarried(const AttachedObject& a, const AttachedObject& b)
{
  return a.link == b.link && a.touch_links == b.touch_links && a.weight == b.weight &&
         a.detach_posture == b.detach_posture && sameObject(a.object, b.object);
}

/// An object of a scene, in the world or attached.
struct Known
{
  const WorldObject* object = nullptr;
  const AttachedObject* attached = nullptr;
};

std::unordered_map<std::string, Known> objectsOf(const PlanningScene& scene)
{
  std::unordered_map<std::string, Known> known;
  known.reserve(scene.objects.size() + scene.attached.size());
  for (const WorldObject& object : scene.objects)
    known[object.id].object = &object;
  for (const AttachedObject& attached : scene.attached)
    known[attached.object.id].attached = &attached;
  return known;
}

ObjectChange addition(const WorldObject& object)
{
  ObjectChange change;
  change.id = object.id;
  change.pose = object.pose;
  change.shapes = object.shapes;
  change.subframes = object.subframes;
  change.type = object.type;
  return change;
}

AttachedChange attachment(const AttachedObject& attached, const RobotModel& robot)
{
  const auto name = [&robot](int link) { return robot.links()[static_cast<std::size_t>(link)].name; };
  AttachedChange change;
  change.object = addition(attached.object);
  change.link = name(attached.link);
  change.object.frame.name = change.link;
  for (const int link : attached.touch_links)
    change.touch_links.push_back(name(link));
  change.detach_posture = attached.detach_posture;
  change.weight = attached.weight;
  return change;
}

ObjectChange removal(const std::string& id)
{
  ObjectChange change;
  change.operation = Operation::Remove;
  change.id = id;
  return change;
}

ObjectChange move(const WorldObject& from, const WorldObject& to)
{
  ObjectChange change;
  change.operation = Operation::Move;
  change.id = to.id;
  change.pose = to.pose;
  if (!sameShapePoses(from, to))
    for (const PlacedShape& placed : to.shapes)
      change.shape_poses.push_back(placed.pose);
  return change;
}

/// The links whose value has changed. An empty vector stands for the usual value of every link.
std::map<std::string, double> changedLinks(const RobotModel& robot, const std::vector<double>& from,
                                           const std::vector<double>& to, double usual)
{
  std::map<std::string, double> changed;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
  {
    const double before = from.empty() ? usual : from[i];
    const double after = to.empty() ? usual : to[i];
    if (before != after)
      changed[robot.links()[i].name] = after;
  }
  return changed;
}

/// The value of every link, because a full scene gives defaults to links that it does not name.
std::map<std::string, double> allLinks(const RobotModel& robot, const std::vector<double>& values, double usual)
{
  std::map<std::string, double> all;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    all[robot.links()[i].name] = values.empty() ? usual : values[i];
  return all;
}

/// Returns true if a difference cannot express the change: the name or the fixed frames are removed; an object stays
/// and its colour is removed; or an object is removed and its colour or its matrix entry stays. A removed octomap keeps
/// both.
bool needsFullScene(const PlanningScene& from, const PlanningScene& to)
{
  if ((to.name.empty() && !from.name.empty()) || (to.fixed_frames.empty() && !from.fixed_frames.empty()))
    return true;
  const auto before = objectsOf(from);
  const auto after = objectsOf(to);
  const auto goes = [&](const std::string& id)
  { return id != kOctomapId && before.count(id) != 0 && after.count(id) == 0; };
  const auto keepsEntries = [&](const std::string& id) { return goes(id) && to.allowed_collisions.row(id).known(); };
  return std::any_of(from.colors.begin(), from.colors.end(),
                     [&](const auto& color) { return to.colors.count(color.first) == 0 && !goes(color.first); }) ||
         std::any_of(to.colors.begin(), to.colors.end(), [&](const auto& color) { return goes(color.first); }) ||
         std::any_of(from.objects.begin(), from.objects.end(),
                     [&](const WorldObject& object) { return keepsEntries(object.id); }) ||
         std::any_of(from.attached.begin(), from.attached.end(),
                     [&](const AttachedObject& attached) { return keepsEntries(attached.object.id); });
}

/// Objects that are no longer attached are detached first. Their place in the world does not matter, because they are
/// then added anew or removed.
void compareCarried(const PlanningScene& from, const PlanningScene& to, SceneChange& change)
{
  const auto before = objectsOf(from);
  const auto after = objectsOf(to);
  for (const AttachedObject& attached : from.attached)
  {
    const auto known = after.find(attached.object.id);
    if (known != after.end() && known->second.attached != nullptr)
      continue;
    AttachedChange put_back;
    put_back.object = removal(attached.object.id);
    change.state.attached.push_back(put_back);
    if (known == after.end())
      change.objects.push_back(removal(attached.object.id));
  }
  for (const AttachedObject& attached : to.attached)
  {
    const auto known = before.find(attached.object.id);
    if (known == before.end() || known->second.attached == nullptr || !sameCarried(*known->second.attached, attached))
      change.state.attached.push_back(attachment(attached, *to.robot));
  }
}

void compareObjects(const PlanningScene& from, const PlanningScene& to, SceneChange& change)
{
  const auto before = objectsOf(from);
  const auto after = objectsOf(to);
  for (const WorldObject& object : from.objects)
    if (after.count(object.id) == 0)
      change.objects.push_back(removal(object.id));
  for (const WorldObject& object : to.objects)
  {
    const auto known = before.find(object.id);
    const WorldObject* const old = known == before.end() ? nullptr : known->second.object;
    if (old != nullptr && sameObject(*old, object))
      continue;
    const bool can_move = old != nullptr && object.id != kOctomapId && old->type == object.type &&
                          sameShapes(*old, object) && sameFrames(old->subframes, object.subframes);
    change.objects.push_back(can_move ? move(*old, object) : addition(object));
  }
}
/// The rules of links that differ, and the unusual rules of added objects: without a rule, they would have the usual
/// one. An object whose rule differs is added anew.
std::map<std::string, SolidRule> changedSolids(const PlanningScene& from, const PlanningScene& to,
                                               const SceneChange& change)
{
  std::map<std::string, SolidRule> changed;
  const auto add = [&changed](const ObjectChange& object)
  {
    const auto rule = solidRuleOf(object.shapes);
    if (object.operation == Operation::Add && rule && *rule != SolidRule::Auto)
      changed[object.id] = *rule;
  };
  for (const ObjectChange& object : change.objects)
    add(object);
  for (const AttachedChange& attached : change.state.attached)
    add(attached.object);
  for (std::size_t i = 0; i < to.robot->links().size(); ++i)
  {
    const auto rule = solidRuleOf(to.robot->links()[i].shapes);
    if (rule && rule != solidRuleOf(from.robot->links()[i].shapes))
      changed[to.robot->links()[i].name] = *rule;
  }
  return changed;
}
}  // namespace

SceneChange fullSceneOf(const PlanningScene& scene)
{
  const RobotModel& robot = *scene.robot;
  SceneChange change;
  change.name = scene.name;
  change.robot_model_name = robot.name();
  change.fixed_frames = scene.fixed_frames;
  for (std::size_t i = 0; i < scene.current_state.size(); ++i)
    change.state.variables[robot.variables()[i].name] = scene.current_state[i];
  change.state.is_diff = false;
  for (const AttachedObject& attached : scene.attached)
    change.state.attached.push_back(attachment(attached, robot));
  if (scene.matrix_source == MatrixSource::SceneFile)
    change.matrix = scene.allowed_collisions;
  change.link_padding = allLinks(robot, scene.link_padding, 0.0);
  change.link_scale = allLinks(robot, robot.linkScale(), 1.0);
  change.colors = scene.colors;
  for (const WorldObject& object : scene.objects)
    change.objects.push_back(addition(object));
  change.solids = solidRulesOf(scene);
  return change;
}

SceneChange diffOf(const PlanningScene& from, const PlanningScene& to)
{
  if (needsFullScene(from, to))
    return fullSceneOf(to);
  const RobotModel& robot = *to.robot;
  SceneChange change;
  change.is_diff = true;
  if (to.name != from.name)
    change.name = to.name;
  if (!sameFrames(from.fixed_frames, to.fixed_frames))
    change.fixed_frames = to.fixed_frames;
  for (std::size_t i = 0; i < to.current_state.size(); ++i)
    if (from.current_state.empty() || from.current_state[i] != to.current_state[i])
      change.state.variables[robot.variables()[i].name] = to.current_state[i];
  if (!(from.allowed_collisions == to.allowed_collisions))
    change.matrix = to.allowed_collisions;
  change.link_padding = changedLinks(robot, from.link_padding, to.link_padding, 0.0);
  change.link_scale = changedLinks(robot, from.robot->linkScale(), robot.linkScale(), 1.0);
  for (const auto& [id, color] : to.colors)
    if (const auto old = from.colors.find(id); old == from.colors.end() || !(old->second == color))
      change.colors[id] = color;
  compareCarried(from, to, change);
  compareObjects(from, to, change);
  change.solids = changedSolids(from, to, change);
  // Detaching an object needs the state of the robot. A full scene does not.
  const bool puts_back =
      std::any_of(change.state.attached.begin(), change.state.attached.end(),
                  [](const AttachedChange& attached) { return attached.object.operation == Operation::Remove; });
  return puts_back && to.current_state.empty() ? fullSceneOf(to) : change;
}
}  // namespace gpu_planning_scene::core
