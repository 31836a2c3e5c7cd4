// The content of scene files: both layouts, frames, poses, shapes, the robot's state and the allowed-collision matrix.

#include <cmath>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
class SceneFile : public testing::Test
{
 public:
  PlanningScene load(const std::string& yaml, std::shared_ptr<const RobotModel> robot = sliderRobot())
  {
    warnings.clear();
    return loadSceneFile(folder.write("scene.yaml", yaml), std::move(robot), packages, &warnings);
  }

  /// The pose of an object's first shape in the planning frame.
  static Eigen::Isometry3d shapePose(const PlanningScene& scene, std::size_t object = 0)
  {
    return scene.objects.at(object).pose * scene.objects.at(object).shapes.at(0).pose;
  }

  bool warned(const std::string& fragment) const
  {
    for (const std::string& warning : warnings)
      if (warning.find(fragment) != std::string::npos)
        return true;
    return false;
  }

  TemporaryFolder folder;
  PackageResolver packages;
  std::vector<std::string> warnings;
};

Eigen::Isometry3d pose(double x, double y, double z, double angle_about_z)
{
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(angle_about_z, Eigen::Vector3d::UnitZ());
}

const char* const kMoveIt = R"(name: hall
robot_model_name: slider
robot_state:
  joint_state:
    header: {seq: 0, stamp: {secs: 0, nsecs: 0}, frame_id: ''}
    name: [slide, turn]
    position: [0.25, -1.5]
    velocity: []
    effort: []
  multi_dof_joint_state: {joint_names: [], transforms: []}
  attached_collision_objects: []
  is_diff: False
fixed_frame_transforms:
  - header: {frame_id: rail}
    child_frame_id: rail
    transform:
      translation: {x: 0.0, y: 0.0, z: 0.0}
      rotation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
allowed_collision_matrix:
  entry_names: [cart, pole, drum]
  entry_values:
    - enabled: [False, True, True]
    - enabled: [True, False, False]
    - enabled: [True, False, False]
  default_entry_names: [lamp]
  default_entry_values: [True]
link_padding:
  - {link_name: cart, padding: 0.0}
link_scale:
  - {link_name: cart, scale: 1.0}
object_colors: []
world:
  collision_objects:
    - header: {frame_id: rail}
      pose:
        position: {x: 1.0, y: 2.0, z: 3.0}
        orientation: {x: 0.0, y: 0.0, z: 0.7071067811865476, w: 0.7071067811865476}
      id: drum
      type: {key: '', db: ''}
      primitives:
        - {type: 3, dimensions: [0.4, 0.1]}
        - {type: 1, dimensions: [0.1, 0.2, 0.3]}
        - {type: 2, dimensions: [0.5]}
        - {type: 4, dimensions: [0.6, 0.7]}
      primitive_poses:
        - position: {x: 0.5, y: 0.0, z: 0.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
        - position: {x: 0.0, y: 0.0, z: 0.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
        - position: {x: 0.0, y: 0.0, z: 0.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
        - position: {x: 0.0, y: 0.0, z: 0.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
      meshes:
        - triangles:
            - vertex_indices: [0, 1, 2]
          vertices:
            - {x: 0.0, y: 0.0, z: 0.0}
            - {x: 1.0, y: 0.0, z: 0.0}
            - {x: 0.0, y: 1.0, z: 0.0}
      mesh_poses:
        - position: {x: 0.0, y: 0.0, z: 9.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
      planes: []
      plane_poses: []
      subframe_names: []
      subframe_poses: []
      operation: 0
  octomap:
    header: {frame_id: ''}
    origin: {position: {x: 0.0, y: 0.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 0.0}}
    octomap: {binary: False, id: '', resolution: 0.0, data: []}
is_diff: False
---
)";

const char* const kCompact = R"(world:
  collision_objects:
    - id: drum
      pose: {position: [1, 2, 3], orientation: [0, 0, 1, 1]}
      primitives:
        - {type: cylinder, dimensions: [0.4, 0.1]}
        - {type: box, dimensions: [0.1, 0.2, 0.3]}
        - {type: sphere, dimensions: [0.5]}
        - {type: cone, dimensions: [0.6, 0.7]}
      primitive_poses: [{position: [0.5, 0, 0]}, {}, {}, {}]
      meshes:
        - {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]}
      mesh_poses: [{position: [0, 0, 9]}]
allowed_collision_matrix:
  entry_names: [cart, pole, drum]
  entry_values: [[false, true, true], [true, false, false], [true, false, false]]
  default_entry_names: [lamp]
  default_entry_values: [true]
robot_state:
  joint_state: {name: [slide, turn], position: [0.25, -1.5]}
)";

TEST_F(SceneFile, BothLayoutsMeanTheSame)
{
  for (const char* yaml : {kMoveIt, kCompact})
  {
    SCOPED_TRACE(yaml);
    const PlanningScene scene = load(yaml);
    EXPECT_TRUE(warnings.empty()) << warnings.at(0);
    EXPECT_EQ((std::vector<double>{0.25, -1.5}), scene.current_state);
    ASSERT_EQ(1u, scene.objects.size());
    EXPECT_EQ("drum", scene.objects[0].id);
    EXPECT_EQ("drum", scene.bodyName(static_cast<int>(scene.robot->links().size())));
    ASSERT_EQ(5u, scene.objects[0].shapes.size());
    const auto& shapes = scene.objects[0].shapes;
    EXPECT_EQ(0.1, std::get<Cylinder>(shapes[0].shape).radius);
    EXPECT_EQ(0.4, std::get<Cylinder>(shapes[0].shape).length);
    EXPECT_EQ(Eigen::Vector3d(0.1, 0.2, 0.3), std::get<Box>(shapes[1].shape).size);
    EXPECT_EQ(0.5, std::get<Sphere>(shapes[2].shape).radius);
    EXPECT_EQ(0.7, std::get<Cone>(shapes[3].shape).radius);
    EXPECT_EQ(0.6, std::get<Cone>(shapes[3].shape).length);
    const Mesh& mesh = *std::get<std::shared_ptr<const Mesh>>(shapes[4].shape);
    EXPECT_EQ(3u, mesh.vertices.size());
    EXPECT_EQ(1u, mesh.triangles.size());
    EXPECT_EQ(9.0, shapes[4].pose.translation().z());
    // The object is rotated by 90 degrees, so the cylinder's offset of 0.5 m along x becomes an offset along y.
    EXPECT_TRUE(shapePose(scene).isApprox(pose(1.0, 2.5, 3.0, M_PI_2), 1e-15));

    EXPECT_EQ(MatrixSource::SceneFile, scene.matrix_source);
    EXPECT_TRUE(scene.allowed_collisions.allowed("cart", "drum"));
    EXPECT_TRUE(scene.allowed_collisions.allowed("pole", "cart"));
    EXPECT_FALSE(scene.allowed_collisions.allowed("drum", "pole"));
    EXPECT_TRUE(scene.allowed_collisions.allowed("lamp", "nut"));
  }
}

TEST_F(SceneFile, ItsMatrixReplacesTheRobotsOwnWhereItHasOne)
{
  EXPECT_TRUE(load("world: {}\nname: a").allowed_collisions.allowed("cart", "pole"));
  const PlanningScene kept = load("world: {}\nallowed_collision_matrix: {entry_names: [], entry_values: []}");
  EXPECT_TRUE(kept.allowed_collisions.allowed("cart", "pole"));
  EXPECT_EQ(MatrixSource::Srdf, kept.matrix_source);
  EXPECT_TRUE(warned("matrix is empty"));
  const PlanningScene replaced =
      load("allowed_collision_matrix: {entry_names: [cart, nut], entry_values: [[false, true], [true, false]]}");
  EXPECT_FALSE(replaced.allowed_collisions.allowed("cart", "pole"));
  EXPECT_TRUE(replaced.allowed_collisions.allowed("cart", "nut"));
}

TEST_F(SceneFile, AllowedCollisionsAreAddedToTheMatrix)
{
  const std::string can = "world: {collision_objects: [{id: can, primitives: [{type: sphere, dimensions: [1]}]}]}\n";
  const PlanningScene scene = load(can + "allowed_collisions: [[can, nut], [rail, can]]");
  EXPECT_TRUE(warnings.empty()) << warnings.at(0);
  EXPECT_TRUE(scene.allowed_collisions.allowed("cart", "pole"));  // by the SRDF
  EXPECT_TRUE(scene.allowed_collisions.allowed("nut", "can"));
  EXPECT_TRUE(scene.allowed_collisions.allowed("can", "rail"));
  EXPECT_FALSE(scene.allowed_collisions.allowed("can", "cart"));
  EXPECT_EQ(MatrixSource::SceneFile, scene.matrix_source);  // so that copies of the scene get the pairs too
  const PlanningScene both =
      load(can + "allowed_collisions: [[can, nut]]\n" +
           "allowed_collision_matrix: {entry_names: [can, cart], entry_values: [[false, true], [true, false]]}");
  EXPECT_TRUE(both.allowed_collisions.allowed("can", "nut"));
  EXPECT_TRUE(both.allowed_collisions.allowed("can", "cart"));
  EXPECT_FALSE(both.allowed_collisions.allowed("cart", "pole"));
  EXPECT_EQ(MatrixSource::Srdf, load(can + "allowed_collisions: []").matrix_source);
}

TEST_F(SceneFile, AllowedCollisionsWithAnUnknownNameAreWarnings)
{
  const PlanningScene scene = load("world: {}\nallowed_collisions:\n  - [cart, pole]\n  - [can, cart]");
  ASSERT_EQ(1u, warnings.size());
  EXPECT_TRUE(warned("scene.yaml:4: allowed_collisions: 'can' is neither a link nor an object"));
  EXPECT_TRUE(scene.allowed_collisions.allowed("can", "cart"));
}

TEST_F(SceneFile, AStarAllowsTheCollisionsOfABodyWithAllOthers)
{
  for (const std::string pair : {"[floor, \"*\"]", "[\"*\", floor]"})
  {
    const PlanningScene scene =
        load("world: {collision_objects: [{id: floor, planes: [[0, 0, 1, 0]]}]}\nallowed_collisions: [" + pair + "]\n");
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_EQ(true, scene.allowed_collisions.defaultOf("floor"));
    EXPECT_TRUE(scene.allowed_collisions.allowed("floor", "cart"));
    EXPECT_TRUE(scene.allowed_collisions.allowed("floor", "an object of later"));
    EXPECT_FALSE(scene.allowed_collisions.allowed("cart", "an object of later"));
    EXPECT_EQ(MatrixSource::SceneFile, scene.matrix_source);
  }
}

TEST_F(SceneFile, PairsThatAreForbiddenInSpiteOfAStarAreNamed)
{
  const PlanningScene scene = load(R"(world: {collision_objects: [{id: floor, planes: [[0, 0, 1, 0]]}]}
allowed_collision_matrix:
  entry_names: [floor, cart]
  entry_values: [[false, false], [false, false]]
  default_entry_names: [pole]
  default_entry_values: [false]
allowed_collisions: [[floor, "*"]])");
  EXPECT_FALSE(scene.allowed_collisions.allowed("floor", "cart"));
  EXPECT_TRUE(scene.allowed_collisions.allowed("floor", "nut"));
  ASSERT_EQ(1u, warnings.size());
  EXPECT_TRUE(
      warned("scene.yaml:7: allowed_collisions: [floor, \"*\"] does not allow the pairs that other entries "
             "forbid; these stay checked: floor with cart, pole"))
      << warnings[0];
}

TEST_F(SceneFile, OnlyAWholeNameCanBeAStar)
{
  const std::string world = "world: {}\nallowed_collisions: ";
  EXPECT_NE(std::string::npos, errorOf([&] { load(world + "[[cart, \"fl*\"]]"); }).find("'fl*' is no body"));
  EXPECT_NE(std::string::npos, errorOf([&] { load(world + "[[\"*\", \"*\"]]"); }).find("a name and \"*\""));
}

TEST_F(SceneFile, AMatrixOfDefaultsAloneIsAWarning)
{
  const PlanningScene scene =
      load("world: {}\nallowed_collision_matrix:\n  default_entry_names: [can]\n  default_entry_values: [true]\n");
  ASSERT_EQ(1u, warnings.size());
  EXPECT_TRUE(warned("scene.yaml:3: allowed_collision_matrix: it has only default entries, so the pairs that the SRDF"))
      << warnings[0];
  EXPECT_FALSE(scene.allowed_collisions.allowed("cart", "pole"));
}

TEST_F(SceneFile, AnUnreadableFileAndAnEmptyFileHaveDifferentMessages)
{
  const auto error = [this](const std::string& path)
  { return errorOf([&] { loadSceneFile(path, sliderRobot(), packages, &warnings); }); };
  EXPECT_EQ(folder.path("none.yaml") + ": cannot read the file: No such file or directory",
            error(folder.path("none.yaml")));
  EXPECT_EQ(folder.path("empty.yaml") + ": the file is empty", error(folder.write("empty.yaml", "")));
  EXPECT_EQ(folder.path("") + ": this is a folder, not a file", error(folder.path("")));
}

TEST_F(SceneFile, ObjectsMayBeGivenInLinksAndFixedFrames)
{
  const std::string shape = "primitives: [{type: sphere, dimensions: [1]}]";
  const PlanningScene scene = load(R"(
fixed_frame_transforms:
  - child_frame_id: camera
    transform: {translation: [0, 0, 5], rotation: [0, 0, 1, 1]}
robot_state: {joint_state: {name: [slide, turn], position: [0.5, 1.5707963267948966]}}
world:
  collision_objects:
    - {id: a, header: {frame_id: camera}, pose: {position: [1, 0, 0]}, )" +
                                   shape + R"(}
    - {id: b, header: {frame_id: pole}, pose: {position: [1, 0, 0]}, )" +
                                   shape + R"(}
    - {id: c, header: {frame_id: /rail}, )" +
                                   shape + R"(}
    - {id: d, header: {frame_id: ''}, )" +
                                   shape + R"(}
)");
  EXPECT_TRUE(shapePose(scene, 0).isApprox(pose(0, 1, 5, M_PI_2), 1e-15)) << shapePose(scene, 0).matrix();
  EXPECT_TRUE(shapePose(scene, 1).isApprox(pose(0.5, 1, 0, M_PI_2), 1e-15)) << shapePose(scene, 1).matrix();
  EXPECT_TRUE(shapePose(scene, 2).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(shapePose(scene, 3).isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(SceneFile, PlanningFrameIsTheVirtualJointsParent)
{
  const std::string world =
      "world: {collision_objects: [{id: a, header: {frame_id: hall}, pose: {position: [1, 0, 0]}, "
      "primitives: [{type: sphere, dimensions: [1]}]}]}";
  EXPECT_EQ(1.0, shapePose(load(world, sliderRobotOnFloor("planar"))).translation().x());
  EXPECT_NE("", errorOf([&] { load(world); }));
}

TEST_F(SceneFile, QuaternionsAreNormalised)
{
  const PlanningScene scene = load(
      "world: {collision_objects: [{id: a, pose: {orientation: [0, 0, 1e200, 1e200]}, "
      "primitives: [{type: sphere, dimensions: [1]}]}]}");
  EXPECT_TRUE(shapePose(scene).isApprox(pose(0, 0, 0, M_PI_2), 1e-15));
}

TEST_F(SceneFile, APoseOfAllZerosWasNeverSet)
{
  const PlanningScene scene = load(
      "world: {collision_objects: [{id: a, pose: {position: {x: 0.0, y: 0.0, z: 0.0}, "
      "orientation: {x: 0.0, y: 0.0, z: 0.0, w: 0.0}}, "
      "primitives: [{type: sphere, dimensions: [1, 0, 0]}]}]}");
  EXPECT_TRUE(shapePose(scene).isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(SceneFile, AnObjectWithoutAPoseIsWhereItsLoneShapeIsAsInMessages)
{
  const PlanningScene scene = load(
      "world: {collision_objects: ["
      "{id: one, primitives: [{type: sphere, dimensions: [1]}], primitive_poses: [{position: [1, 2, 3]}]}, "
      "{id: two, primitives: [{type: sphere, dimensions: [1]}, {type: sphere, dimensions: [1]}], "
      "primitive_poses: [{position: [1, 2, 3]}, {position: [4, 5, 6]}]}]}");
  EXPECT_TRUE(scene.objects.at(0).pose.isApprox(pose(1, 2, 3, 0)));
  EXPECT_TRUE(scene.objects.at(0).shapes.at(0).pose.isApprox(pose(0, 0, 0, 0)));
  EXPECT_TRUE(scene.objects.at(1).pose.isApprox(pose(0, 0, 0, 0)));
  EXPECT_TRUE(scene.objects.at(1).shapes.at(1).pose.isApprox(pose(4, 5, 6, 0)));
}

TEST_F(SceneFile, MissingEntriesHaveTheirDefaults)
{
  const auto robot = sliderRobot();
  SceneDefaults defaults;
  defaults.link_padding.assign(robot->links().size(), 0.05);
  defaults.link_scale.assign(robot->links().size(), 2.0);
  defaults.object_padding = 0.01;
  defaults.attached_padding = 0.02;
  const auto cart = static_cast<std::size_t>(robot->linkIndex("cart"));
  const auto pole = static_cast<std::size_t>(robot->linkIndex("pole"));
  const auto loaded = [&](const std::string& name, const std::string& text)
  { return loadSceneFile(folder.write(name, text), robot, packages, nullptr, {}, defaults); };

  const std::string objects =
      "world: {collision_objects: [{id: a, primitives: [{type: sphere, dimensions: [1]}]}]}\n"
      "robot_state: {attached_collision_objects: [{link_name: pole, object: {id: b, "
      "primitives: [{type: sphere, dimensions: [1]}]}}]}\n";
  PlanningScene scene = loaded("a.yaml", objects);
  EXPECT_EQ(0.05, scene.link_padding.at(cart));
  EXPECT_EQ(2.0, scene.robot->linkScale().at(pole));
  EXPECT_EQ(0.01, scene.objects.at(0).padding);
  EXPECT_EQ(0.02, scene.attached.at(0).padding);
  scene = loaded("b.yaml", objects +
                               "link_padding: [{link_name: cart, padding: 0.0}]\n"
                               "link_scale: [{link_name: pole, scale: 1.0}]\n");
  EXPECT_EQ(0.0, scene.link_padding.at(cart)) << "a zero that is given is one";
  EXPECT_EQ(0.05, scene.link_padding.at(pole));
  EXPECT_EQ(2.0, scene.robot->linkScale().at(cart));
  EXPECT_EQ(1.0, scene.robot->linkScale().at(pole));
  scene = loaded("c.scene", "text\n* a\n1\nsphere\n1\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n");
  EXPECT_EQ(0.05, scene.link_padding.at(cart));
  EXPECT_EQ(2.0, scene.robot->linkScale().at(cart));
  EXPECT_EQ(0.01, scene.objects.at(0).padding);
}

TEST_F(SceneFile, UnusedJointValuesGiveWarnings)
{
  const PlanningScene scene = load(
      "robot_state: {joint_state: {name: [slide, flag, bolt, gripper, wheel], "
      "position: [1, 2, 3, 4, 5]}}");
  EXPECT_EQ((std::vector<double>{1.0, 0.0}), scene.current_state);
  EXPECT_TRUE(warned("does not have them: gripper, wheel"));
  EXPECT_TRUE(warned("fixed: bolt"));
  EXPECT_TRUE(warned("follow other joints: flag"));
  EXPECT_TRUE(warned("get their default: turn"));
}

TEST_F(SceneFile, AMissingVirtualJointGivesNoWarning)
{
  const auto robot = sliderRobotOnFloor("planar");
  const PlanningScene scene = load("robot_state: {joint_state: {name: [slide, turn], position: [1, 2]}}", robot);
  EXPECT_EQ(0.0, scene.current_state.at(static_cast<std::size_t>(robot->variableIndex("floor/x"))));
  EXPECT_FALSE(warned("default"));
  load("robot_state: {joint_state: {name: [slide], position: [1]}}", robot);
  EXPECT_TRUE(warned("get their default: turn"));
  EXPECT_FALSE(warned("floor"));
}

TEST_F(SceneFile, AStateOfTheSrdfCanBeNamed)
{
  EXPECT_EQ((std::vector<double>{-1.0, 0.8}), load("robot_state: {named_state: left}").current_state);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  EXPECT_EQ((std::vector<double>{1.0, 0.8}), load("robot_state: {named_state: drive/right}").current_state);
  EXPECT_EQ((std::vector<double>{1.0, 0.8}),
            load("robot_state: {named_state: right, joint_state: {name: [], position: []}}").current_state);
}

TEST_F(SceneFile, ANamedStateSetsTheVariablesOfItsGroupAlone)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"),
              "<group_state name=\"turned\" group=\"mast\"><joint name=\"turn\" value=\"0.5\"/></group_state>");
  const auto robot = RobotModel::fromXml(sliderUrdf(), srdf, {});
  EXPECT_EQ((std::vector<double>{0.0, 0.5}), load("robot_state: {named_state: turned}", robot).current_state);
  EXPECT_TRUE(warned(":1: robot_state: joints without a value get their default: slide"));
}

TEST_F(SceneFile, SeveralNamedStatesSetTheVariablesOfTheirGroups)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"),
              "<group_state name=\"turned\" group=\"mast\"><joint name=\"turn\" value=\"0.5\"/></group_state>"
              "<group name=\"cart\"><joint name=\"slide\"/></group>"
              "<group_state name=\"near\" group=\"cart\"><joint name=\"slide\" value=\"0.2\"/></group_state>");
  const auto robot = RobotModel::fromXml(sliderUrdf(), srdf, {});
  EXPECT_EQ((std::vector<double>{0.2, 0.5}),
            load("robot_state: {named_state: [mast/turned, near]}", robot).current_state);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST_F(SceneFile, ANamedStateIsThePlaceOfObjectsOnLinks)
{
  const PlanningScene scene = load(
      "robot_state: {named_state: right}\n"
      "world: {collision_objects: [{id: a, header: {frame_id: cart}, primitives: [{type: sphere, dimensions: [1]}]}]}");
  EXPECT_EQ(1.0, shapePose(scene).translation().x());
}

TEST_F(SceneFile, JointValuesOutsideTheLimitsGiveAWarningWithTheLine)
{
  load("world: {}\nrobot_state: {joint_state: {name: [slide, turn], position: [0, 90]}}");
  EXPECT_TRUE(warned(":2: robot_state: joint 'turn' is 90, outside its limits -3 to 3 rad; values are in radians"));
}

TEST_F(SceneFile, WithoutJointValuesThereIsNoState)
{
  EXPECT_TRUE(load("world: {}\nname: a").current_state.empty());
  EXPECT_TRUE(load("robot_state: {joint_state: {name: [], position: []}}").current_state.empty());
  EXPECT_TRUE(load("robot_state: {joint_state: {name: [gripper], position: [1]}}").current_state.empty());
}

TEST_F(SceneFile, MultiDofJointsTakeTransforms)
{
  const std::string yaml =
      "robot_state: {joint_state: {name: [slide, turn], position: [1, 2]}, multi_dof_joint_state: "
      "{header: {frame_id: hall}, joint_names: [floor, boat], transforms: "
      "[{translation: [3, 4, Z], rotation: [0, 0, 1, 1]}, {}]}}";
  const auto at_height = [&](const char* z) { return std::string(yaml).replace(yaml.find('Z'), 1, z); };
  const auto planar = sliderRobotOnFloor("planar");
  const PlanningScene on_floor = load(at_height("0"), planar);
  EXPECT_TRUE(warned("does not have them: boat"));
  EXPECT_EQ(3.0, on_floor.current_state.at(planar->variableIndex("floor/x")));
  EXPECT_EQ(4.0, on_floor.current_state.at(planar->variableIndex("floor/y")));
  EXPECT_NEAR(M_PI_2, on_floor.current_state.at(planar->variableIndex("floor/theta")), 1e-15);

  EXPECT_NE(std::string::npos, errorOf([&] { load(at_height("5"), planar); }).find("leaves the plane"));

  const auto floating = sliderRobotOnFloor("floating");
  const PlanningScene in_air = load(at_height("5"), floating);
  std::vector<Eigen::Isometry3d> poses(floating->links().size());
  floating->linkPoses(in_air.current_state.data(), poses.data());
  EXPECT_TRUE(poses[0].isApprox(pose(3, 4, 5, M_PI_2), 1e-15));
}

TEST_F(SceneFile, TransformsAreMotionsFromTheOriginOfTheJoint)
{
  for (const char* type : {"planar", "floating"})
  {
    SCOPED_TRACE(type);
    const auto robot = robotOf(
        boxLink("base") + boxLink("arm") + boxLink("body") +
        jointXml("lift", "prismatic", "base", "arm",
                 "<origin xyz='0 0 1'/><axis xyz='0 0 1'/>" + std::string(kLimits)) +
        jointXml("free", type, "arm", "body", "<origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/><axis xyz='0 0 1'/>"));
    const auto yaml = [](const std::string& frame)
    {
      return "robot_state: {joint_state: {name: [lift], position: [0.5]}, multi_dof_joint_state: {header: {frame_id: "
             "'" +
             frame + "'}, joint_names: [free], transforms: [{translation: [3, 0, 0], rotation: [0, 0, 0, 1]}]}}";
    };
    for (const char* frame : {"", "base"})
    {
      const PlanningScene scene = load(yaml(frame), robot);
      std::vector<Eigen::Isometry3d> poses(robot->links().size());
      robot->linkPoses(scene.current_state.data(), poses.data());
      EXPECT_TRUE(poses[2].isApprox(pose(1, 3, 1.5, M_PI_2), 1e-12)) << frame;
    }
    EXPECT_NE(std::string::npos, errorOf([&] { load(yaml("arm"), robot); })
                                     .find("multi_dof_joint_state is given in frame 'arm'; it must be the planning "
                                           "frame 'base' or empty"));
  }
}

TEST_F(SceneFile, LeavesTheVirtualJointToTheNodeUnlessAnObjectIsPlacedByALink)
{
  const auto robot = sliderRobotOnFloor("planar");
  const std::string state = "robot_state: {joint_state: {name: [slide, turn], position: [1, 2]}}\n";
  const auto object_in = [](const std::string& frame)
  {
    return "world: {collision_objects: [{id: box, header: {frame_id: " + frame +
           "}, primitives: [{type: box, dimensions: [1, 1, 1]}]}]}\n";
  };
  EXPECT_TRUE(load(state, robot).base_is_default);
  EXPECT_TRUE(load(state + object_in("hall"), robot).base_is_default);
  EXPECT_FALSE(load(state).base_is_default) << "the robot has no virtual joint";
  EXPECT_FALSE(load("robot_state: {joint_state: {name: [slide, floor/x], position: [1, 2]}}", robot).base_is_default);
  EXPECT_FALSE(warned("is taken to stand at the origin"));
  EXPECT_FALSE(load(state + object_in("cart"), robot).base_is_default);
  EXPECT_TRUE(
      warned("the robot is taken to stand at the origin of frame 'hall', because the file places objects "
             "relative to links"));
}

TEST_F(SceneFile, PaddingIsPerLink)
{
  const PlanningScene scene = load(R"(
link_padding:
  - {link_name: pole, padding: 0.02}
  - {link_name: cart, padding: 0.0}
  - {link_name: crane, padding: 0.5}
)");
  ASSERT_EQ(scene.robot->links().size(), scene.link_padding.size());
  for (std::size_t i = 0; i < scene.link_padding.size(); ++i)
    EXPECT_EQ(scene.robot->links()[i].name == "pole" ? 0.02 : 0.0, scene.link_padding[i]);
  EXPECT_TRUE(warned("no link 'crane'"));
  EXPECT_TRUE(load("link_padding: [{link_name: pole, padding: 0.0}]").link_padding.empty());
}

TEST_F(SceneFile, ScaleIsPerLinkAndForWhatTheLinkCarries)
{
  const PlanningScene scene = load(R"(
link_scale: [{link_name: pole, scale: 2.0}, {link_name: cart, scale: 1.0}, {link_name: crane, scale: 3.0}]
robot_state:
  attached_collision_objects:
    - {link_name: pole, object: {id: a, primitives: [{type: sphere, dimensions: [1]}]}}
)");
  const auto& links = scene.robot->links();
  EXPECT_EQ(0.8, std::get<Box>(links[scene.robot->linkIndex("pole")].shapes[0].shape).size.z());
  EXPECT_EQ(0.2, std::get<Box>(links[scene.robot->linkIndex("cart")].shapes[0].shape).size.z());
  EXPECT_EQ(2.0, std::get<Sphere>(scene.attached.at(0).shapes().at(0).shape).radius);
  EXPECT_TRUE(warned("no link 'crane'"));
}

TEST_F(SceneFile, NamesColorsSubframesAndFixedFramesAreKept)
{
  const PlanningScene scene = load(R"(
name: workshop
scene_revision: 7
fixed_frame_transforms:
  - {child_frame_id: camera, transform: {translation: [0, 0, 5]}}
  - {header: {frame_id: map}, child_frame_id: rail, transform: {translation: [0, 0, 7]}}
  - {child_frame_id: rail, transform: {}}
object_colors: [{id: a, color: {r: 1.0, g: 0.5, b: 0.0, a: 0.25}}]
world:
  collision_objects:
    - id: a
      primitives: [{type: sphere, dimensions: [1]}]
      subframe_names: [tip, tail]
      subframe_poses: [{position: [0, 0, 1]}, {position: [0, 0, -1]}]
)");
  EXPECT_TRUE(warnings.empty()) << warnings.at(0);
  EXPECT_EQ("workshop", scene.name);
  EXPECT_TRUE(scene.colors.at("a") == (Color{1.0F, 0.5F, 0.0F, 0.25F}));
  EXPECT_EQ(-1.0, scene.objects.at(0).subframes.at("tail").translation().z());
  EXPECT_EQ(5.0, scene.frame("camera", nullptr)->translation().z());
  EXPECT_EQ(7.0, scene.frame("map", nullptr)->translation().z()) << "as MoveIt writes it";
  EXPECT_EQ(2u, scene.fixed_frames.size()) << "the planning frame is none of its own";
}

TEST_F(SceneFile, PlanesAreTheHalfSpacesBehindThem)
{
  // 2 z - 1 <= 0 in MoveIt's layout; x + 3 <= 0 as a list of numbers, rotated so that its normal is y, and moved.
  const PlanningScene scene = load(R"(
world:
  collision_objects:
    - id: floor
      primitives: [{type: sphere, dimensions: [1]}]
      planes: [{coef: [0.0, 0.0, 2.0, -1.0]}, [1, 0, 0, 3]]
      plane_poses:
        - {}
        - {position: [0, 5, 0], orientation: [0, 0, 1, 1]}
)");
  EXPECT_TRUE(warnings.empty());
  const auto& shapes = scene.objects.at(0).shapes;
  ASSERT_EQ(3u, shapes.size());
  const HalfSpace& first = std::get<HalfSpace>(shapes[1].shape);
  EXPECT_EQ(Eigen::Vector3d(0, 0, 1), first.normal);
  EXPECT_EQ(0.5, first.offset);
  const HalfSpace& second = std::get<HalfSpace>(shapes[2].shape);
  EXPECT_EQ(Eigen::Vector3d(1, 0, 0), second.normal);
  EXPECT_EQ(-3.0, second.offset);
  EXPECT_TRUE(shapes[2].pose.isApprox(pose(0, 5, 0, M_PI_2), 1e-15));
}

TEST_F(SceneFile, ALonePlaneIsAnObject)
{
  const HalfSpace plane = std::get<HalfSpace>(
      load("world: {collision_objects: [{id: a, planes: [[3e-200, 0, 4e-200, 5e-200]]}]}").objects[0].shapes[0].shape);
  EXPECT_TRUE(plane.normal.isApprox(Eigen::Vector3d(0.6, 0, 0.8), 1e-15));
  EXPECT_NEAR(-1.0, plane.offset, 1e-15);
}

TEST_F(SceneFile, LinksMayCarryObjects)
{
  const std::string shape = "primitives: [{type: sphere, dimensions: [1]}]";
  const PlanningScene scene = load(R"(
robot_state:
  joint_state: {name: [slide, turn], position: [0.5, 1.5707963267948966]}
  attached_collision_objects:
    - link_name: pole
      object: {id: a, header: {frame_id: pole}, pose: {position: [1, 0, 0]}, operation: 0, )" +
                                   shape + R"(}
      touch_links: [cart, nut]
      detach_posture: {joint_names: [], points: []}
      weight: 0.0
    - link_name: pole
      object: {id: b, pose: {position: [1, 0, 0]}, operation: ADD, )" +
                                   shape + R"(}
    - link_name: pole
      object: {id: c, header: {frame_id: rail}, pose: {position: [1, 0, 0]}, )" +
                                   shape + R"(}
)");
  EXPECT_TRUE(warnings.empty()) << warnings.at(0);
  ASSERT_EQ(3u, scene.attached.size());
  const int pole = scene.robot->linkIndex("pole");
  for (const AttachedObject& carried : scene.attached)
    EXPECT_EQ(pole, carried.link);
  EXPECT_EQ((std::vector<int>{scene.robot->linkIndex("cart"), scene.robot->linkIndex("nut")}),
            scene.attached[0].touch_links);
  EXPECT_TRUE(scene.attached[0].object.pose.isApprox(pose(1, 0, 0, 0), 1e-15));
  EXPECT_TRUE(scene.attached[1].object.pose.isApprox(pose(1, 0, 0, 0), 1e-15));
  // The pole is at x = 0.5 and rotated by 90 degrees, so the object is 0.5 m in front of it, at -y.
  EXPECT_TRUE(scene.attached[2].object.pose.isApprox(pose(0, -0.5, 0, -M_PI_2), 1e-15))
      << scene.attached[2].object.pose.matrix();
  EXPECT_EQ("c", scene.bodyName(static_cast<int>(scene.robot->links().size()) + 2));
}

TEST_F(SceneFile, EqualInlineMeshesAreOneMesh)
{
  const std::string mesh = "{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]}";
  const PlanningScene scene = load("world: {collision_objects: [{id: a, meshes: [" + mesh + "]}, {id: b, meshes: [" +
                                   mesh + "], mesh_poses: [{position: [1, 0, 0]}]}]}");
  EXPECT_EQ(std::get<std::shared_ptr<const Mesh>>(scene.objects[0].shapes[0].shape),
            std::get<std::shared_ptr<const Mesh>>(scene.objects[1].shapes[0].shape));
}

TEST_F(SceneFile, MeshesMayBeFiles)
{
  folder.write("meshes/triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  packages = packageResolver({{"parts", folder.path(".")}});
  const PlanningScene scene = load(
      "world: {collision_objects: [{id: a, meshes: [{resource: meshes/triangle.obj}]}, "
      "{id: b, meshes: [{resource: package://parts/meshes/triangle.obj, "
      "scale: [2, 2, 2]}]}]}");
  const auto& relative = std::get<std::shared_ptr<const Mesh>>(scene.objects[0].shapes[0].shape);
  const auto& scaled = std::get<std::shared_ptr<const Mesh>>(scene.objects[1].shapes[0].shape);
  ASSERT_EQ(1u, relative->triangles.size());
  EXPECT_EQ(2.0, scaled->vertices[scaled->triangles[0][1]].x());
}

TEST_F(SceneFile, NamesInIso88591AreUtf8)
{
  const std::string utf8 =
      "world: {collision_objects: [{id: Tr\xC3\xA9teau, primitives: [{type: sphere, dimensions: [1]}]}]}";
  std::string iso = utf8;
  iso.replace(iso.find("\xC3\xA9"), 2, "\xE9");
  EXPECT_EQ("Tr\xC3\xA9teau", load(utf8).objects.at(0).id);
  EXPECT_EQ("Tr\xC3\xA9teau", load(iso).objects.at(0).id);
  const std::string text = "sc\xE8ne\n* Tr\xE9teau\n1\nsphere\n0.1\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n";
  const PlanningScene scene = loadSceneFile(folder.write("a.scene", text), sliderRobot(), packages);
  EXPECT_EQ("sc\xC3\xA8ne", scene.name);
  EXPECT_EQ("Tr\xC3\xA9teau", scene.objects.at(0).id);
}

TEST_F(SceneFile, AliasesStandForTheirValue)
{
  const PlanningScene scene = load(
      "world:\n  collision_objects:\n"
      "    - {id: a, primitives: &ball [{type: sphere, dimensions: [2]}]}\n"
      "    - {id: b, primitives: *ball}\n");
  EXPECT_EQ(2.0, std::get<Sphere>(scene.objects[1].shapes[0].shape).radius);
}

TEST_F(SceneFile, TheNameOfAnotherRobotIsAWarning)
{
  load("robot_model_name: other\n");
  EXPECT_TRUE(warned("for robot 'other', the robot is 'slider'"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
