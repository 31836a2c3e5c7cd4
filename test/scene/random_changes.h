#pragma once

#include <random>

#include "scene/change_testing.h"
#include "scene/solid_rules.h"

namespace gpu_planning_scene::core
{
/// Random changes of the scene of the slider robot. Many of them are refused.
class RandomChanges : public SceneChanges
{
 protected:
  std::size_t upTo(std::size_t max) { return random_() % (max + 1); }
  bool chance() { return random_() % 2 == 0; }
  double number() { return static_cast<double>(random_() % 2001) / 1000.0 - 1.0; }
  Eigen::Isometry3d pose() { return poseAt(number(), number(), number(), number()); }
  std::string id() { return std::string(1, static_cast<char>('a' + upTo(4))); }
  std::string linkName() { return scene_.robot->links()[upTo(scene_.robot->links().size() - 1)].name; }

  std::vector<PlacedShape> shapes()
  {
    std::vector<PlacedShape> result;
    for (std::size_t i = 0; i <= upTo(2); ++i)
      switch (upTo(3))
      {
        case 0:
          result.push_back(boxAt(1.5 + number(), pose()));
          break;
        case 1:
          result.push_back({Sphere{1.5 + number()}, pose()});
          break;
        case 2:
          result.push_back({Cylinder{1.5 + number(), 2.0}, pose()});
          break;
        default:
          result.push_back(triangleAt(pose()));
      }
    return result;
  }

  void fill(ObjectChange& object)
  {
    if (object.operation == Operation::Add || object.operation == Operation::Append)
      object.shapes = shapes();
    if (chance())
      object.pose = pose();
    if (chance())
      object.type = {id(), id()};
    if (chance() && object.operation != Operation::Remove)
      object.subframes[id()] = pose();
  }

  /// The names of links and objects that may have a rule for their solid.
  std::vector<std::string> namesWithMeshes() const
  {
    std::vector<std::string> names;
    const auto add = [&names](const std::string& name, const std::vector<PlacedShape>& shapes)
    {
      if (solidRuleOf(shapes))
        names.push_back(name);
    };
    for (const Link& link : scene_.robot->links())
      add(link.name, link.shapes);
    for (const WorldObject& object : scene_.objects)
      add(object.id, object.shapes);
    for (const AttachedObject& attached : scene_.attached)
      add(attached.object.id, attached.object.shapes);
    return names;
  }

  SceneChange randomChange()
  {
    SceneChange change;
    change.is_diff = upTo(9) != 0;
    change.name = chance() ? id() : "";
    if (chance())
      change.fixed_frames["frame " + id()] = pose();
    if (chance())
      change.state.variables["slide"] = number();
    if (chance())
    {
      change.matrix = AllowedCollisionMatrix();
      change.matrix->setEntry(id(), linkName(), chance());
      change.matrix->setDefault(id(), chance());
    }
    if (chance())
      change.link_padding[linkName()] = 1.0 + number();
    if (chance())
      change.link_scale[linkName()] = 2.0 + number();
    if (chance())
      change.colors[id()] = {0.25F * static_cast<float>(upTo(4)), 0.0F, 0.0F, 1.0F};
    for (std::size_t i = upTo(2); i > 0; --i)
    {
      AttachedChange attached = attachedChange(static_cast<Operation>(upTo(2)), id(), linkName());
      fill(attached.object);
      if (chance())
        attached.touch_links = {linkName()};
      change.state.attached.push_back(attached);
    }
    for (std::size_t i = upTo(2); i > 0; --i)
    {
      ObjectChange object = objectChange(static_cast<Operation>(upTo(3)), id());
      fill(object);
      change.objects.push_back(object);
    }
    if (const std::vector<std::string> names = namesWithMeshes(); has_solids_ && !names.empty() && chance())
      change.solids[names[upTo(names.size() - 1)]] = static_cast<SolidRule>(upTo(2));
    return change;
  }

  void seed(unsigned value) { random_.seed(value); }

  bool has_solids_ = false;  ///< whether the changes have rules for solids

 private:
  std::mt19937 random_;
};
}  // namespace gpu_planning_scene::core
