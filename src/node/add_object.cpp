// add_object: puts a mesh file into the scene of a running node.

#include <iostream>

#include <ros/ros.h>

#include "command_line/command_line.h"
#include "command_line/robot_arguments.h"
#include "command_line/scene_arguments.h"
#include "gpu_planning_scene/error.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<Option> options()
{
  return {
      {"--object", "ID=FILE[,POSE]",
       "an STL, DAE, OBJ or PLY file: a path or package://NAME/PATH;\nPOSE is x,y,z or x,y,z,qx,qy,qz,qw; an object "
       "of that name is\nreplaced; can be repeated",
       true},
      packageOption(),
      {"--frame", "NAME",
       "the frame of POSE: a link, an object, OBJECT/SUBFRAME,\nor any frame of tf (default: the planning frame)"},
      {"--node", "NAME", "the node (default /planning_scene)"},
      {"--wait", "SECONDS", "time to wait for the node (default 5)"}};
}

shape_msgs::Mesh messageOf(const Mesh& mesh)
{
  shape_msgs::Mesh message;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
  {
    message.vertices.emplace_back();
    message.vertices.back().x = vertex.x();
    message.vertices.back().y = vertex.y();
    message.vertices.back().z = vertex.z();
  }
  for (const auto& triangle : mesh.triangles)
  {
    message.triangles.emplace_back();
    message.triangles.back().vertex_indices = {{triangle[0], triangle[1], triangle[2]}};
  }
  return message;
}

CollisionObject messageOf(const WorldObject& object, const std::string& frame)
{
  const Eigen::Quaterniond rotation(object.pose.linear());
  CollisionObject message;
  message.operation = CollisionObject::ADD;
  message.id = object.id;
  message.header.frame_id = frame;
  message.pose.position.x = object.pose.translation().x();
  message.pose.position.y = object.pose.translation().y();
  message.pose.position.z = object.pose.translation().z();
  message.pose.orientation.x = rotation.x();
  message.pose.orientation.y = rotation.y();
  message.pose.orientation.z = rotation.z();
  message.pose.orientation.w = rotation.w();
  for (const PlacedShape& shape : object.shapes)
    message.meshes.push_back(messageOf(*std::get<std::shared_ptr<const Mesh>>(shape.shape)));
  return message;
}

void run(const CommandLine& arguments)
{
  if (!arguments.has("--object"))
    throw UsageError("--object is missing; see --help");
  ApplyPlanningScene service;
  service.request.scene.is_diff = true;
  service.request.scene.robot_state.is_diff = true;
  const PackageResolver packages = packagesFrom(arguments);
  for (const std::string& text : arguments.values("--object"))
    service.request.scene.world.collision_objects.push_back(
        messageOf(objectFrom(text, packages), arguments.value("--frame", "")));
  if (!ros::master::check())
    throw Error("no ROS master answers at " + ros::master::getURI() + "; start one (roscore), or set ROS_MASTER_URI");
  const ros::NodeHandle node;
  const std::string name = arguments.value("--node", "/planning_scene") + "/apply_planning_scene";
  if (!ros::service::waitForService(name, ros::Duration(arguments.number("--wait", 5.0, 0.0, 1e6))))
    throw Error("there is no service " + name + "; start the node, or name it (--node)");
  if (!ros::service::call(name, service))
    throw Error("the call of " + name + " failed; see the log of the node");
  if (!service.response.success)
    throw Error(service.response.message);
  if (!service.response.message.empty())
    std::cerr << "warning: " << service.response.message << "\n";
  std::cerr << "the scene has revision " << service.response.scene_revision << "\n";
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  ros::init(argc, argv, "add_object", ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  ros::V_string words;
  ros::removeROSArgs(argc, argv, words);
  std::vector<const char*> arguments;
  for (const std::string& word : words)
    arguments.push_back(word.c_str());
  const Tool tool{"add_object",
                  "--object ID=FILE[,x,y,z[,qx,qy,qz,qw]]... [--package NAME=DIR]... [--frame NAME]\n                  "
                  "[--node NAME]",
                  "Puts mesh files as objects into the scene of a running node.\n"
                  "Exit code: 0 success, 2 bad usage, 1 any other error.",
                  options(), run};
  return runTool(tool, static_cast<int>(arguments.size()), arguments.data());
}
