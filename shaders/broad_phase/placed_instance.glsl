// The root box of a robot instance, placed by its pose, and the margin by which a volume must grow before it is
// compared with this box. The margin covers the rounding of the pose, of the product and of the comparison: 1e-5 of all
// lengths in the computation. It does not cover the error of an object's box, which was rounded outwards. Lengths are
// in metres.
#include "problem/margins.glsl"
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;

struct PlacedInstance
{
  Instance instance;
  Box box;      // of the root, in the shape's frame
  Pose pose;
  vec3 center;  // of the box, relative to the scene's origin
  float world_margin;  // how far the instance may move against the world (worldMargin)
  // Slack, band of the contract and rounding.
  float margin;
};

PlacedInstance place(uint robot, uint state)
{
  const Instance instance = fetchInstance(robot);
  const Box box = fetchNode(instance.root).box;
  const Pose pose = fetchPose(robot_poses, poseIndex(state, robot));
  const vec3 center = apply(pose, box.center);
  const float world_margin = worldMargin(state, robot);
  const float error = 1e-5 * (abs(center.x) + abs(center.y) + abs(center.z) + length(box.center) + length(box.extent) +
                              instance.padding + world_margin);
  return PlacedInstance(instance, box, pose, center, world_margin, instance.slack + CONTRACT_BAND + error);
}
