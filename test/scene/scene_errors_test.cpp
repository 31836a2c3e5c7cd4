// Wrong scene files, and files with unsupported content, are refused with the file, the line and the reason.

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
struct WrongScene
{
  const char* name;
  std::string yaml;
  int line;
  const char* reason;  ///< a part of the message
};

std::ostream& operator<<(std::ostream& out, const WrongScene& wrong)
{
  return out << wrong.name;
}

/// A scene with one object. The first of `lines` is line 4 of the file.
std::string object(const std::string& lines)
{
  return "world:\n  collision_objects:\n    - id: a\n" + lines;
}

std::string sphereAnd(const std::string& lines)
{
  return object("      primitives: [{type: sphere, dimensions: [1]}]\n" + lines);
}

std::string primitive(const std::string& content)
{
  return object("      primitives: [{" + content + "}]\n");
}

std::string matrix(const std::string& lines)
{
  return "allowed_collision_matrix:\n" + lines;
}

std::string mesh(const std::string& content)
{
  return object("      meshes: [{" + content + "}]\n");
}

std::string sphere()
{
  return "primitives: [{type: sphere, dimensions: [1]}]";
}

std::string ball(const std::string& id)
{
  return "{id: " + id + ", " + sphere() + "}";
}

/// An attached object. The first of `lines` is line 3 of the file; `object` comes last.
std::string attached(const std::string& lines, const std::string& object = ball("a"))
{
  return "robot_state:\n  attached_collision_objects:\n    -\n" + lines + "      object: " + object + "\n";
}

const std::vector<WrongScene>& wrongScenes()
{
  static const std::vector<WrongScene> scenes = {
      {"NotYaml", "world:\n  - a: [1, 2\nb: 3\n", 3, "not YAML"},
      {"AKeyTwice", "name: a\nname: b\n", 2, "'name' is given twice"},
      {"TwoDocuments", "name: a\n---\nname: b\n", 3, "second document"},
      {"AList", "- a\n- b\n", 1, "key: value"},
      {"NotAScene", "group_name: arm\nplanner_id: RRT\n", 1, "not a planning scene"},
      {"AnAliasToItself", "name: &x [*x]\n", 1, "alias"},
      {"StarWithoutQuotationMarks", "world: {}\nallowed_collisions: [[floor, *]]\n", 2, "\"*\" needs quotation marks"},
      {"StarBeforeAName", "allowed_collisions:\n- [*, floor]\n", 2, "\"*\" needs quotation marks"},
      {"DocumentsWithoutEnd", ",s_f{{{{{{{is_diff: {{{{{{{{", 1, "not YAML"},
      {"AliasesThatMultiply",
       "a: &a [x, x, x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
       "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]\nd: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]\n"
       "e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]\nworld: [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]\n",
       5, "aliases stand for more than"},
      {"ADifference", "name: a\nis_diff: true\n", 2, "full scene is needed"},
      {"WorldIsText", "world: 5\n", 1, "key: value"},
      {"ObjectsAreAMap", "world:\n  collision_objects: {a: b}\n", 2, "expected a list"},

      {"NoId", "world:\n  collision_objects:\n    - primitives: []\n", 3, "'id' is missing"},
      {"EmptyId", "world:\n  collision_objects:\n    - id: ''\n", 3, "has no id"},
      {"NoShapes", object("      primitives: []\n"), 3, "no shapes; give it primitives, meshes or planes"},
      {"ShapesUnderAnUnknownKey", object("      parts: []\n"), 3, "; unknown key 'parts'"},
      {"IdTwice", sphereAnd("    - {id: a, primitives: [{type: sphere, dimensions: [1]}]}\n"), 5, "given twice"},
      {"IdOfALink", "world: {collision_objects: [{id: cart, primitives: [{type: sphere, dimensions: [1]}]}]}", 1,
       "name of a link"},
      {"OperationRemove", sphereAnd("      operation: 1\n"), 5, "operation 1"},
      {"PlaneWithoutNormal", sphereAnd("      planes: [{coef: [0, 0, 0, 1]}]\n"), 5, "has no direction"},
      {"PlaneOfThreeNumbers", sphereAnd("      planes: [[0, 0, 1]]\n"), 5, "list of 4 numbers"},
      {"PlaneWithoutCoef", sphereAnd("      planes: [{}]\n"), 5, "'coef' is missing"},
      {"PlanePosesTooMany", sphereAnd("      planes: [[0, 0, 1, 0]]\n      plane_poses: [{}, {}]\n"), 6,
       "2 plane_poses for 1 shapes"},

      {"UnknownType", primitive("type: torus, dimensions: [1]"), 4, "unknown primitive type 'torus'"},
      {"TypeNumberFive", primitive("type: 5, dimensions: [1]"), 4, "unknown primitive type '5'"},
      {"NoType", primitive("dimensions: [1]"), 4, "'type' is missing"},
      {"NoDimensions", primitive("type: box"), 4, "'dimensions' is missing"},
      {"TooFewDimensions", primitive("type: cylinder, dimensions: [1]"), 4, "[height, radius]"},
      {"TooManyDimensions", primitive("type: sphere, dimensions: [1, 2]"), 4, "[radius]"},
      {"NegativeDimension", primitive("type: box, dimensions: [1, -1, 1]"), 4, "positive"},
      {"ZeroDimension", primitive("type: sphere, dimensions: [0]"), 4, "positive"},
      {"NanDimension", primitive("type: sphere, dimensions: [.nan]"), 4, "'.nan' is not a finite number"},
      {"InfiniteDimension", primitive("type: sphere, dimensions: [inf]"), 4, "'inf' is not a finite number"},
      {"HugeDimension", primitive("type: sphere, dimensions: [1e999]"), 4, "'1e999' is not a finite number"},
      {"TextDimension", primitive("type: sphere, dimensions: [1m]"), 4, "'1m' is not a finite number"},
      {"PosesMissing",
       object("      primitives: [{type: sphere, dimensions: [1]}, {type: sphere, dimensions: [1]}]\n"
              "      primitive_poses: [{}]\n"),
       5, "1 primitive_poses for 2 shapes"},
      {"PosesTooMany", sphereAnd("      primitive_poses: [{}, {}]\n"), 5, "2 primitive_poses for 1 shapes"},
      {"MeshPosesWithoutMesh", sphereAnd("      mesh_poses: [{}]\n"), 5, "1 mesh_poses for 0 shapes"},

      {"ZeroQuaternion", sphereAnd("      pose: {orientation: [0, 0, 0, 0]}\n"), 5, "quaternion is zero"},
      {"ShortQuaternion", sphereAnd("      pose: {orientation: [0, 0, 0]}\n"), 5, "list of 4 numbers"},
      {"QuaternionWithoutW", sphereAnd("      pose: {orientation: {x: 0, y: 0, z: 1}}\n"), 5, "'w' is missing"},
      {"NanPosition", sphereAnd("      pose: {position: [0, nan, 0]}\n"), 5, "'nan' is not a finite number"},
      {"PositionWithoutY", sphereAnd("      pose: {position: {x: 0, z: 0}}\n"), 5, "'y' is missing"},
      {"PoseWithOtherKey", sphereAnd("      pose: {xyz: [0, 0, 0]}\n"), 5,
       "unknown key 'xyz' in a pose; it has 'position' and 'orientation'"},
      {"UnknownFrame", sphereAnd("      header: {frame_id: moon}\n"), 5, "unknown frame 'moon'"},
      {"LinkFrameWithoutState", sphereAnd("      header: {frame_id: cart}\n"), 5, "robot_state"},

      {"MeshWithoutTriangles", mesh("vertices: [[0, 0, 0]], triangles: []"), 4, "triangle"},
      {"MeshWithoutVertices", mesh("triangles: [[0, 1, 2]]"), 4, "'vertices' is missing"},
      {"MeshIndexOutOfRange", mesh("vertices: [[0, 0, 0]], triangles: [[0, 0, 1]]"), 4, "index 1 is out of range"},
      {"MeshIndexNegative", mesh("vertices: [[0, 0, 0]], triangles: [[0, 0, -1]]"), 4, "index -1 is out of range"},
      {"MeshIndexNotWhole", mesh("vertices: [[0, 0, 0]], triangles: [[0, 0, 0.5]]"), 4, "not an integer"},
      {"MeshTriangleOfFour", mesh("vertices: [[0, 0, 0]], triangles: [[0, 0, 0, 0]]"), 4, "three vertex indices"},
      {"MeshVertexOfTwo", mesh("vertices: [[0, 0]], triangles: [[0, 0, 0]]"), 4, "list of 3 numbers"},
      {"MeshFileMissing", mesh("resource: no/such.stl"), 4, "such.stl"},
      {"MeshPackageUnknown", mesh("resource: 'package://nowhere/a.stl'"), 4, "nowhere"},
      {"MeshWithTwoScales", mesh("resource: a.stl, scale: [1, 1, 1], dimensions: [1, 1, 1]"), 4,
       "both 'scale' and 'dimensions'"},
      {"MeshFileAndVertices", mesh("resource: a.stl, vertices: []"), 4, "both 'resource' and 'vertices'"},

      {"MatrixRowsMissing", matrix("  entry_names: [a, b]\n  entry_values: [[true, true]]\n"), 2,
       "1 entry_values for 2"},
      {"MatrixRowTooShort", matrix("  entry_names: [a, b]\n  entry_values:\n    - [true, true]\n    - [true]\n"), 5,
       "a row of 1 entries"},
      {"MatrixNotSymmetric",
       matrix("  entry_names: [a, b]\n  entry_values:\n    - [true, true]\n    - [false, true]\n"), 5,
       "not symmetric for 'a' and 'b'"},
      {"MatrixNameTwice", matrix("  entry_names: [a, a]\n  entry_values: [[true, true], [true, true]]\n"), 2, "twice"},
      {"MatrixEntryIsText", matrix("  entry_names: [a]\n  entry_values: [[maybe]]\n"), 3, "neither true nor false"},
      {"MatrixDefaultsMissing", matrix("  default_entry_names: [a]\n  default_entry_values: []\n"), 2,
       "0 default_entry_values for 1"},

      {"PositionsMissing", "robot_state:\n  joint_state:\n    name: [slide, turn]\n    position: [1]\n", 3,
       "1 positions for 2 joint names"},
      {"JointTwice", "robot_state:\n  joint_state:\n    name: [slide, slide]\n    position: [1, 2]\n", 3,
       "given twice"},
      {"NanJoint", "robot_state:\n  joint_state:\n    name: [slide]\n    position: [.NaN]\n", 4, "not a finite number"},
      {"UnknownNamedState", "robot_state:\n  named_state: home\n", 2,
       "named_state: the SRDF has no state 'home'; its states: drive/left, drive/right"},
      {"NamedStateAndJoints", "robot_state:\n  joint_state: {name: [slide], position: [1]}\n  named_state: left\n", 3,
       "named_state is given, but the robot state has joint values too; give one of the two"},
      {"NamedStateAndUnusedJoints", "robot_state:\n  joint_state: {name: [flag], position: [1]}\n  named_state: left\n",
       3, "has joint values too; give one of the two"},
      {"NamedStateIsAListOfLists", "robot_state:\n  named_state: [[left]]\n", 2, "expected a single value"},
      {"NamedStatesOfTheSameJoint", "robot_state:\n  named_state: [left, right]\n", 2,
       "named_state: 'right' sets 'slide', which another state of the list has set"},
      {"RevoluteAsMultiDof", "robot_state:\n  multi_dof_joint_state:\n    joint_names: [turn]\n    transforms: [{}]\n",
       3, "neither planar nor floating"},

      {"AttachedWithoutLink", attached("      touch_links: []\n"), 4, "'link_name' is missing"},
      {"AttachedWithoutObject", attached("      link_name: cart\n", ""), 4, "'object' is missing"},
      {"AttachedToUnknownLink", attached("      link_name: crane\n"), 4,
       "the robot has no link 'crane'; its links: rail, cart, nut, pole, pennant"},
      {"AttachedToAMistypedLink", attached("      link_name: pennat\n"), 4,
       "the robot has no link 'pennat'; did you mean 'pennant'?"},
      {"UnknownTouchLink", attached("      link_name: cart\n      touch_links: [pole, crane]\n"), 5, "no link 'crane'"},
      {"AttachedIdOfALink", attached("      link_name: cart\n", ball("pole")), 4, "name of a link"},
      {"AttachedIdOfAnObject",
       "world: {collision_objects: [" + ball("a") + "]}\n" + attached("      link_name: cart\n"), 5, "given twice"},
      {"AttachedRemoved", attached("      link_name: cart\n", "{id: a, operation: 1}"), 5, "operation 1"},
      {"AttachedPlane", attached("      link_name: cart\n", "{id: a, planes: [[0, 0, 1, 0]]}"), 5,
       "cannot be attached"},
      {"AttachedInUnknownFrame",
       attached("      link_name: cart\n", "{id: a, header: {frame_id: moon}, " + sphere() + "}"), 5,
       "unknown frame 'moon'"},
      {"AttachedInAnotherFrameWithoutState",
       attached("      link_name: cart\n", "{id: a, header: {frame_id: rail}, " + sphere() + "}"), 5, "robot_state"},

      {"NegativePadding", "name: a\nlink_padding:\n  - {link_name: cart, padding: -0.01}\n", 3, "negative"},
      {"NanPadding", "name: a\nlink_padding:\n  - {link_name: cart, padding: .nan}\n", 3, "not a finite number"},
      {"PaddingTwice",
       "name: a\nlink_padding:\n  - {link_name: cart, padding: 0.1}\n  - {link_name: cart, padding: 0.1}\n", 4,
       "given twice"},
      {"PaddingWithoutLink", "name: a\nlink_padding:\n  - {padding: 0.1}\n", 3, "'link_name' is missing"},
      {"Scale", "name: a\nlink_scale:\n  - {link_name: cart, scale: 0.0}\n", 3, "must be above 0"},
      {"ScaleTwice", "name: a\nlink_scale:\n  - {link_name: cart, scale: 2}\n  - {link_name: cart, scale: 2}\n", 4,
       "given twice"},
      {"ColorTooBright", "object_colors:\n  - {id: a, color: {r: 1.1, g: 0, b: 0, a: 1}}\n", 2, "from 0 to 1"},
      {"SubframeWithoutPose",
       "world:\n  collision_objects:\n    - {id: a, subframe_names: [tip], primitives: [{type: sphere, dimensions: "
       "[1]}]}\n",
       3, "0 subframe_poses for 1"},
      {"OctomapWithoutClass", "world:\n  octomap:\n    octomap:\n      data: [1, 2]\n", 4, "'binary' is missing"},
      {"OctomapOfWrongBytes", "world:\n  octomap:\n    octomap: {binary: 1, id: OcTree, resolution: 0.1, data: [1]}\n",
       3, "the data end inside of the octree"},
      {"OctomapOfLargeNumbers",
       "world:\n  octomap:\n    octomap: {binary: 1, id: OcTree, resolution: 0.1, data: [200, 1]}\n", 3,
       "it must be from -128 to 127"},
      {"OctomapFile", "octomap: no_such.bt\n", 1, "cannot read the file"},
      {"ObjectWithTheNameOfTheOctomap", "world:\n  collision_objects:\n    - id: <octomap>\n", 3,
       "is kept for the octomap"},
      {"NegativeWeight",
       "robot_state:\n  attached_collision_objects:\n    - {link_name: pole, weight: -1, object: {id: a, primitives: "
       "[{type: box, dimensions: [1, 1, 1]}]}}\n",
       3, "the weight is negative"},

      {"FrameInAnotherFrame",
       "fixed_frame_transforms:\n  - header: {frame_id: moon}\n    child_frame_id: camera\n    transform: {}\n", 2,
       "between frames 'moon' and 'camera'"},
      {"FrameTwice",
       "fixed_frame_transforms:\n  - {child_frame_id: c, transform: {translation: [0, 0, 0]}}\n"
       "  - {child_frame_id: c, transform: {translation: [0, 0, 0]}}\n",
       3, "given twice"},
      {"FrameOfALink", "fixed_frame_transforms:\n  - {child_frame_id: cart, transform: {translation: [0, 0, 0]}}\n", 2,
       "name of a link"},
      {"PlanningFrameMoved",
       "fixed_frame_transforms:\n  - {child_frame_id: rail, transform: {translation: [0, 0, 1]}}\n", 2,
       "must be the identity"},
      {"FrameWithoutTransform", "fixed_frame_transforms:\n  - {child_frame_id: c}\n", 2, "'transform' is missing"},
  };
  return scenes;
}

class SceneErrors : public testing::TestWithParam<WrongScene>
{
};

TEST_P(SceneErrors, AreSaidWithFileAndLine)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("scene.yaml", GetParam().yaml);
  const std::string message = errorOf([&] { loadSceneFile(path, sliderRobot(), {}); });
  EXPECT_EQ(0u, message.find(path + ":" + std::to_string(GetParam().line) + ": ")) << message;
  EXPECT_NE(std::string::npos, message.find(GetParam().reason)) << message;
  EXPECT_EQ(std::string::npos, message.find('\n')) << message;
}

INSTANTIATE_TEST_SUITE_P(All, SceneErrors, testing::ValuesIn(wrongScenes()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(SceneErrors, AFileThatIsMissingOrEmptyIsNamed)
{
  const TemporaryFolder folder;
  for (const std::string& path : {folder.path("missing.yaml"), folder.write("empty.yaml", ""),
                                  folder.write("comment.yaml", "# nothing\n"), folder.path(".")})
  {
    const std::string message = errorOf([&] { loadSceneFile(path, sliderRobot(), {}); });
    EXPECT_EQ(0u, message.find(path + ": ")) << message;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
