#include "moveit/planner/converted_shapes.h"

#include "gpu_planning_scene/scene_change.h"
#include "moveit/planner/refusal.h"
#include "moveit/shapes/collision_shape.h"
#include "moveit/shapes/octree_leaves.h"

namespace gpu_planning_scene::pipeline
{
namespace
{
void addLeaves(const octomap::OcTree& octree, const Eigen::Isometry3d& pose, const std::string& body,
               std::vector<core::PlacedShape>& added)
{
  const std::size_t limit = added.size() + core::SceneLimits().shapes;
  detector::visitOccupiedLeaves(
      octree, [](const Eigen::AlignedBox3d&) { return true; },
      [&](const Eigen::Vector3d& center, unsigned depth)
      {
        if (added.size() == limit)
          throw Refusal(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE,
                        "'" + body + "': its octree has more than " + std::to_string(core::SceneLimits().shapes) +
                            " occupied leaves; use a coarser octree");
        const double side = octree.getNodeSize(static_cast<int>(depth));
        added.push_back({core::Box{Eigen::Vector3d::Constant(side)}, pose * Eigen::Translation3d(center)});
        return false;
      });
}
}  // namespace

void addShapes(const shapes::ShapeConstPtr& shape, const Eigen::Isometry3d& pose, double scale, Carried carried,
               const std::string& body, std::vector<core::PlacedShape>& added)
{
  const detector::CollisionShapePtr converted = detector::collisionShapeOf(shape, scale, body);
  switch (converted->kind())
  {
    case detector::ShapeKind::Solid:
      added.push_back({converted->tree().shape, pose});
      return;
    case detector::ShapeKind::HalfSpace:
      if (carried == Carried::Yes)
        throw Refusal(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE,
                      "'" + body + "' has a plane; planes are planned around only in the world");
      added.push_back({converted->halfSpace(), pose});
      return;
    case detector::ShapeKind::Octree:
      addLeaves(converted->octree(), pose, body, added);
      return;
    case detector::ShapeKind::Empty:
      return;
    case detector::ShapeKind::Faulty:
      throw Refusal(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE,
                    "'" + body + "': a shape cannot be checked: " + converted->fault());
  }
}
}  // namespace gpu_planning_scene::pipeline
