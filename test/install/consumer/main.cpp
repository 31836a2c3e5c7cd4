// A robot of one joint swings a bar through the mesh of a file. The CPU and the GPU must agree on the angles that hit
// it.
#include <cstdio>

#include <gpu_planning_scene/batch_checker.h>
#include <gpu_planning_scene/cpu_checker.h>
#ifdef WITH_MESSAGES
#include <gpu_planning_scene/CheckStates.h>
#include <gpu_planning_scene/PlanningScene.h>
#endif

using namespace gpu_planning_scene::core;

int main(int, char** argv)
try
{
  const auto robot = RobotModel::fromXml(R"(<robot name="bar"><link name="base"/><link name="bar"><collision>
      <origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
      <joint name="swing" type="continuous"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/></joint></robot>)",
                                         "", RobotModelOptions());
  auto scene = std::make_shared<PlanningScene>(robot);
  WorldObject box;
  box.id = "box";
  box.pose.translation() = Eigen::Vector3d(0.0, 0.6, 0.0);
  box.shapes.push_back({MeshCache().load(argv[1], Eigen::Vector3d::Ones()), Eigen::Isometry3d::Identity()});
  scene->objects.push_back(box);

  const double angles[] = {0.0, 1.57, 3.14, -1.57, 1.5};
  const std::vector<std::uint8_t> expected = {1, 0, 1, 1, 0};
  const auto on_cpu = CpuChecker(scene).check(angles, 5).valid;
  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker checker(scene, options);
  const auto on_gpu = checker.check(angles, 5).valid;
  std::printf("%s\n", checker.deviceName().c_str());
#ifdef WITH_MESSAGES
  // Some classes of the messages and of the library have the same name in different namespaces.
  gpu_planning_scene::CheckStatesRequest request;
  request.joint_names.push_back("swing");
  gpu_planning_scene::PlanningScene message;
  message.robot_model_name = scene->robot->name();
#endif
  return on_cpu == expected && on_gpu == expected ? 0 : 1;
}
catch (const std::exception& error)
{
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
