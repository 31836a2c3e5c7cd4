#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/state_inspector.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
/// Objects, and a body that is attached to a hand without shapes. The body follows the objects. Variables: the pose of
/// the hand.
class HeldShape
{
 public:
  static constexpr int kObject = 2;  ///< body of the first object: it follows two links without shapes

  HeldShape(const Shape& held, const std::vector<PlacedShape>& objects, double padding = 0.0)
    : HeldShape(std::vector<PlacedShape>{{held}}, objects, padding)
  {
  }
  /// The held body has several shapes. Each object has one.
  HeldShape(const std::vector<PlacedShape>& held, const std::vector<PlacedShape>& objects, double padding = 0.0)
    : HeldShape(held)
  {
    for (std::size_t i = 0; i < objects.size(); ++i)
      scene_.objects.push_back({"object " + std::to_string(i), objects[i].pose, {{objects[i].shape}}});
    for (WorldObject& object : scene_.objects)
      object.padding = padding;
    body_ += static_cast<int>(objects.size());
  }

  /// One object, which has several shapes.
  static HeldShape inOneObject(const Shape& held, const std::vector<PlacedShape>& shapes, double padding)
  {
    HeldShape made(std::vector<PlacedShape>{{held}});
    made.scene_.objects.push_back({"object", Eigen::Isometry3d::Identity(), shapes});
    made.scene_.objects.back().padding = padding;
    ++made.body_;
    return made;
  }

  static std::vector<double> state(const Eigen::Isometry3d& pose)
  {
    const Eigen::Vector3d place = pose.translation();
    const Eigen::Quaterniond turn(pose.linear());
    return {place.x(), place.y(), place.z(), turn.x(), turn.y(), turn.z(), turn.w()};
  }
  static std::vector<double> state(const Eigen::Vector3d& place)
  {
    return state(Eigen::Isometry3d(Eigen::Translation3d(place)));
  }

  std::vector<Contact> contacts(const Eigen::Vector3d& place, std::size_t max_contacts = 1000,
                                std::size_t max_per_pair = 0) const
  {
    return inspector().contacts(state(place).data(), "", max_contacts, max_per_pair);
  }
  StateInspector inspector() const { return StateInspector(std::make_shared<const PlanningScene>(scene_)); }
  const PlanningScene& scene() const { return scene_; }
  int body() const { return body_; }

 private:
  explicit HeldShape(const std::vector<PlacedShape>& held)
    : scene_(robotOf("<link name=\"base\"/><link name=\"hand\"/>" + jointXml("move", "floating", "base", "hand")))
  {
    scene_.attached.push_back({{"held", Eigen::Isometry3d::Identity(), held}, 1, {}});
  }

  PlanningScene scene_;
  int body_ = kObject;
};
}  // namespace gpu_planning_scene::core
