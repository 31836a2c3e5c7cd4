// Keys of scene files that are misspelt, in the wrong place, or unknown. No such key may change the world in silence.

#include <algorithm>
#include <cctype>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A scene with each key of the format, one key in a line.
const char* const kAllKeys = R"(name: hall
robot_model_name: slider
scene_revision: 3
is_diff: false
robot_state:
  is_diff: false
  joint_state:
    header:
      seq: 0
      stamp:
        secs: 1
        nsecs: 2
      frame_id: ""
    name: [slide, turn]
    position: [0.25, -1.5]
    velocity: []
    effort: []
  multi_dof_joint_state:
    header:
      frame_id: hall
    joint_names: [floor]
    transforms:
      -
        translation:
          x: 1
          y: 2
          z: 0
        rotation:
          x: 0
          y: 0
          z: 0
          w: 1
    twist: []
    wrench: []
  attached_collision_objects:
    -
      link_name: cart
      touch_links: [pole]
      weight: 0.5
      object:
        header:
          frame_id: cart
        id: tool
        pose:
          position: [0, 0, 1]
          orientation: [0, 0, 0, 1]
        primitives:
          -
            type: box
            dimensions: [0.1, 0.1, 0.1]
      detach_posture:
        header:
          frame_id: hall
        joint_names: [turn]
        points:
          -
            positions: [0]
            velocities: [0]
            accelerations: [0]
            effort: [0]
            time_from_start:
              secs: 1
              nsecs: 0
fixed_frame_transforms:
  -
    header:
      frame_id: hall
    child_frame_id: table
    transform:
      translation: [1, 2, 3]
      rotation: [0, 0, 0, 1]
allowed_collision_matrix:
  entry_names: [cart, pole]
  entry_values:
    -
      enabled: [false, true]
    -
      enabled: [true, false]
  default_entry_names: [shelf]
  default_entry_values: [false]
allowed_collisions: [[shelf, cart]]
link_padding:
  -
    link_name: cart
    padding: 0.01
link_scale:
  -
    link_name: cart
    scale: 1.1
link_solid:
  -
    link_name: cart
    solid: surface
object_colors:
  -
    id: shelf
    color:
      r: 1
      g: 0
      b: 0
      a: 1
world:
  collision_objects:
    -
      header:
        frame_id: table
      id: shelf
      operation: 0
      type:
        key: shelf
        db: "1"
      pose:
        position: [0, 0, 5]
      primitives:
        -
          type: sphere
          dimensions: [0.1]
      primitive_poses:
        -
          position: [0, 0, 0.5]
      meshes:
        -
          vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
          triangles:
            -
              vertex_indices: [0, 1, 2]
      mesh_poses:
        -
          position: [0, 0, 2]
      planes:
        -
          coef: [0, 0, 1, 10]
      plane_poses:
        -
          position: [0, 0, 0]
      solid: filled
      subframe_names: [top]
      subframe_poses:
        -
          position: [0, 0, 1]
  octomap:
    header:
      frame_id: table
    origin:
      position: [1, 0, 0]
    octomap:
      header:
        frame_id: table
      binary: true
      id: OcTree
      resolution: 0.1
      data: [0, -64, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3, 0, 2, -128]
)";

/// A scene with a mesh file.
const char* const kMeshFile = R"(name: hall
world:
  collision_objects:
    -
      id: part
      meshes:
        -
          resource: part.obj
          scale: [1, 1, 1]
)";

class SceneKeys : public testing::Test
{
 protected:
  SceneKeys() { folder_.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"); }

  PlanningScene load(const std::string& yaml)
  {
    warnings_.clear();
    static const auto robot = sliderRobotOfMeshes("planar");
    return loadSceneText(yaml, "scene.yaml", folder_.path(""), robot, {}, &warnings_);
  }

  std::string errorOfScene(const std::string& yaml)
  {
    return errorOf([&] { load(yaml); });
  }

  /// Replaces the key of a line by three wrong ones, one after the other. Returns their number.
  std::size_t tryMisspelt(const std::vector<std::string>& lines, std::size_t line, std::mt19937& random);

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines)
{
  std::string text;
  for (const std::string& line : lines)
    text += line + "\n";
  return text;
}

std::string camelCase(const std::string& key)
{
  std::string result;
  bool upper = false;
  for (const char c : key)
  {
    if (c != '_')
      result += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return result;
}

/// Other spellings of a key, and the key with one typing error, which `random` chooses.
std::vector<std::string> misspelt(const std::string& key, std::mt19937& random)
{
  std::vector<std::string> result;
  result.push_back(camelCase(key));
  result.push_back(key);
  std::replace(result.back().begin(), result.back().end(), '_', '-');
  result.push_back(key);
  result.back()[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(key[0])));
  result.push_back(key.back() == 's' ? key.substr(0, key.size() - 1) : key + "s");
  if (key.size() > 3)
  {
    const std::size_t place = random() % (key.size() - 1);
    result.push_back(key);
    result.back().erase(place, 1);
    result.push_back(key);
    std::swap(result.back()[place], result.back()[place + 1]);
    result.push_back(key);
    result.back()[place] = 'q';
    result.push_back(key);
    result.back().insert(place, 1, 'q');
  }
  result.erase(std::remove(result.begin(), result.end(), key), result.end());
  return result;
}

std::size_t SceneKeys::tryMisspelt(const std::vector<std::string>& lines, std::size_t line, std::mt19937& random)
{
  const std::size_t begin = lines[line].find_first_not_of(' ');
  const std::size_t colon = lines[line].find(':');
  if (colon == std::string::npos)
    return 0;
  const std::string key = lines[line].substr(begin, colon - begin);
  std::vector<std::string> wrong_keys = misspelt(key, random);
  std::shuffle(wrong_keys.begin(), wrong_keys.end(), random);
  wrong_keys.resize(std::min<std::size_t>(wrong_keys.size(), 3));
  for (const std::string& wrong : wrong_keys)
  {
    if (wrong == "sec")
      continue;  // the key of ROS 2 for secs
    std::vector<std::string> changed = lines;
    changed[line].replace(begin, key.size(), wrong);
    const std::string message = errorOfScene(joined(changed));
    EXPECT_EQ(0u, message.find("scene.yaml:" + std::to_string(line + 1) + ": unknown key '" + wrong + "'"))
        << wrong << " for " << key << ", seed " << kSeed << ": " << message;
  }
  return wrong_keys.size();
}

TEST_F(SceneKeys, OfMoveItAreAllKnown)
{
  const PlanningScene scene = load(kAllKeys);
  EXPECT_TRUE(warnings_.empty()) << warnings_.at(0);
  EXPECT_EQ(2u, scene.objects.size());
  EXPECT_EQ(1u, scene.attached.size());
  EXPECT_EQ(1u, load(kMeshFile).objects.size());
  EXPECT_TRUE(warnings_.empty()) << warnings_.at(0);
}

TEST_F(SceneKeys, ThatAreMisspeltAreErrorsInEachMap)
{
  std::mt19937 random(kSeed);
  std::size_t tried = 0;
  for (const char* const scene : {kAllKeys, kMeshFile})
  {
    const std::vector<std::string> lines = linesOf(scene);
    for (std::size_t i = 0; i < lines.size(); ++i)
      tried += tryMisspelt(lines, i, random);
  }
  EXPECT_GT(tried, 300u);
}

TEST_F(SceneKeys, ThatAreMisspeltNameTheKnownKey)
{
  const std::string ball = "primitives: [{type: sphere, dimensions: [1]}]";
  const std::vector<std::array<std::string, 3>> cases = {
      {"wrld: {collision_objects: []}", "wrld", "world"},
      {"Worlds: {}", "Worlds", "world"},
      {"world: {collision_object: []}", "collision_object", "collision_objects"},
      {"world: {objects: []}", "objects", "collision_objects"},
      {"robot_state: {attached_collision_object: []}", "attached_collision_object", "attached_collision_objects"},
      {"link_paddings: []\nworld: {}", "link_paddings", "link_padding"},
      {"world: {collision_objects: [{id: a, poses: {}, " + ball + "}]}", "poses", "pose"},
      {"world: {collision_objects: [{id: a, mesh: [], " + ball + "}]}", "mesh", "meshes"},
      {"world: {collision_objects: [{id: a, header: {frame: hall}, " + ball + "}]}", "frame", "frame_id"},
      {"robot_state: {joint_state: {names: [], positions: []}}", "names", "name"},
      {"allowed_collision_matrix: {default-entry-names: []}", "default-entry-names", "default_entry_names"},
  };
  for (const auto& [yaml, wrong, meant] : cases)
    EXPECT_EQ("scene.yaml:1: unknown key '" + wrong + "'; did you mean '" + meant + "'?", errorOfScene(yaml));
}

TEST_F(SceneKeys, InTheWrongPlaceAreErrors)
{
  const auto object = [](const std::string& key)
  { return "world: {collision_objects: [{id: a, " + key + ", primitives: [{type: sphere, dimensions: [1]}]}]}"; };
  const std::vector<std::array<std::string, 2>> cases = {
      {"name: a\ncollision_objects: []", "'collision_objects' in the scene; 'collision_objects' is a key of 'world'"},
      {"name: a\nattachedCollisionObjects: []", "'attached_collision_objects' is a key of 'robot_state'"},
      {object("position: [0, 0, 1]"), "'position' in an object; 'position' is a key of a pose"},
      {object("frame_id: table"), "'frame_id' is a key of a header"},
      {object("touch_links: [cart]"), "'touch_links' is a key of an attached object"},
      {object("scale: [2, 2, 2]"), "'scale' is a key of a mesh"},
      {object("padding: 0.1"), "'padding' is a key of 'link_padding'"},
      {"robot_state: {attached_collision_objects: [{link_name: cart, header: {frame_id: cart}}]}",
       "'header' is a key of an object"},
  };
  for (const auto& [yaml, reason] : cases)
    EXPECT_NE(std::string::npos, errorOfScene(yaml).find(reason)) << errorOfScene(yaml);
}

TEST_F(SceneKeys, OfOtherFormatsForPosesAndSizesAreErrors)
{
  for (const std::string key : {"xyz", "rpy", "location", "quaternion", "frame", "radius", "file"})
    EXPECT_EQ(0u, errorOfScene("world: {collision_objects: [{id: a, " + key +
                               ": 1, primitives: [{type: sphere, dimensions: [1]}]}]}")
                      .find("scene.yaml:1: unknown key '" + key + "' in an object; it has 'header', 'pose'"));
}

TEST_F(SceneKeys, AboutSizesDistancesAndUncheckedPairsAreErrors)
{
  for (const std::string key : {"robot_padding", "default_robot_padding", "default_attached_padding", "safety_margin",
                                "minClearance", "inflation", "min_distance", "ignored_pairs", "enlarge_links", "acm",
                                "disable_collisions", "disabled", "units"})
    EXPECT_EQ(0u, errorOfScene("name: hall\n" + key + ": {cart: 0.1}").find("scene.yaml:2: unknown key '" + key + "'"))
        << key;
  EXPECT_EQ(0u, errorOfScene("world: {collision_objects: [{id: a, meshes: [{resource: a.stl, scaling: [2, 2, 2]}]}]}")
                    .find("scene.yaml:1: unknown key 'scaling' in a mesh"));
}

TEST_F(SceneKeys, ThatHoldObjectsOrShapesAreErrors)
{
  EXPECT_EQ(0u, errorOfScene("name: a\nobstacles: [{id: a, primitives: [{type: sphere, dimensions: [1]}]}]")
                    .find("scene.yaml:2: unknown key 'obstacles' in the scene: its 'primitives' would be lost; the "
                          "scene has 'name', 'robot_state'"));
  EXPECT_EQ(0u, errorOfScene("world: {tables: {left: {meshes: []}}}").find("scene.yaml:1: unknown key 'tables'"));
  EXPECT_EQ("scene.yaml:2: merge keys (<<) are not supported; write out the keys of the map",
            errorOfScene("world: &w {collision_objects: []}\n<<: *w"));
}

TEST_F(SceneKeys, ThatChangeNothingAreWarningsWithTheLineOfTheKey)
{
  const PlanningScene scene = load(
      "comment:\n  the left cell\n"
      "shapes: &ball [{type: sphere, dimensions: [1]}]\n"
      "world: {collision_objects: [{id: a, colour: red, primitives: *ball}]}\n" +
      std::string(500, 'w') + ": 1");
  EXPECT_EQ((std::vector<std::string>{"scene.yaml:1: unknown key 'comment' is not used",
                                      "scene.yaml:3: unknown key 'shapes' is not used",
                                      "scene.yaml:5: unknown key '" + std::string(500, 'w') + "' is not used",
                                      "scene.yaml:4: unknown key 'colour' is not used"}),
            warnings_);
  EXPECT_EQ(1u, scene.objects.size());
}

TEST_F(SceneKeys, OfAFileThatIsNoSceneAreNotSuggested)
{
  EXPECT_EQ("scene.yaml:1: not a planning scene: it has no 'world', 'robot_state' or 'allowed_collision_matrix'",
            errorOfScene("group_name: arm\nstart_state: {joint_state: {}}"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
