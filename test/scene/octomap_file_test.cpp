// Octomaps in scene files: .bt and .ot files of liboctomap, and MoveIt's message.

#include <sstream>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "scene/change_testing.h"
#include "scene/random_octree.h"

namespace gpu_planning_scene::core
{
namespace
{
class OctomapFile : public testing::Test
{
 public:
  OctomapFile()
  {
    std::mt19937_64 generator(11);
    fillAtRandom(tree_, 8.0, 30, generator);
    leaves_ = occupiedLeaves(serialized(tree_, true), 100000);
  }

  PlanningScene load(const std::string& yaml)
  {
    warnings_.clear();
    return loadSceneFile(folder_.write("scene.yaml", yaml), sliderRobot(), packages_, &warnings_);
  }

  void expectLeaves(const PlanningScene& scene, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
  {
    EXPECT_TRUE(warnings_.empty()) << warnings_.front();
    ASSERT_EQ(1U, scene.objects.size());
    EXPECT_EQ(kOctomapId, scene.objects[0].id);
    EXPECT_TRUE(scene.objects[0].pose.isApprox(pose, 1e-12));
    ASSERT_EQ(leaves_.size(), scene.objects[0].shapes.size());
    for (std::size_t i = 0; i < leaves_.size(); ++i)
    {
      EXPECT_EQ(leaves_[i].pose.matrix(), scene.objects[0].shapes[i].pose.matrix());
      EXPECT_EQ(std::get<Box>(leaves_[i].shape).size, std::get<Box>(scene.objects[0].shapes[i].shape).size);
    }
  }

 protected:
  TemporaryFolder folder_;
  PackageResolver packages_ = [this](const std::string& package)
  { return package == "maps" ? folder_.path("") : std::string(); };
  octomap::OcTree tree_{0.05};
  std::vector<PlacedShape> leaves_;
  std::vector<std::string> warnings_;
};

TEST_F(OctomapFile, OfBothKindsIsReadWithTheCubesOfLiboctomap)
{
  tree_.writeBinary(folder_.path("map.bt"));
  tree_.write(folder_.path("map.ot"));
  expectLeaves(load("octomap: map.bt\n"));
  expectLeaves(load("octomap: map.ot\n"));
  expectLeaves(load("octomap: package://maps/map.ot\n"));
}

TEST_F(OctomapFile, IsPlacedByItsFrameAndOrigin)
{
  tree_.writeBinary(folder_.path("map.bt"));
  expectLeaves(load(R"(
fixed_frame_transforms:
  - {child_frame_id: camera, transform: {translation: [0, 0, 1], rotation: [0, 0, 0, 1]}}
world:
  octomap: {header: {frame_id: camera}, origin: {position: [2, 0, 0]}, resource: map.bt}
)"),
               poseAt(2.0, 0.0, 1.0));
}

TEST_F(OctomapFile, MayHaveMoveItsMessage)
{
  for (const bool binary : {true, false})
  {
    const SerializedOctree octree = serialized(tree_, binary);
    std::ostringstream yaml;
    yaml << "world:\n  octomap:\n    header: {seq: 0, stamp: {secs: 0, nsecs: 0}, frame_id: rail}\n"
         << "    origin:\n      position: {x: 0.0, y: 0.0, z: 0.0}\n      orientation: {x: 0.0, y: 0.0, z: 0.0, w: "
            "0.0}\n"
         << "    octomap:\n      header: {frame_id: rail}\n      binary: " << (binary ? "True" : "False")
         << "\n      id: \"OcTree\"\n      resolution: 0.05\n      data: [";
    for (std::size_t i = 0; i < octree.bytes.size(); ++i)
      yaml << (i == 0 ? "" : ", ") << static_cast<int>(octree.bytes[i]);
    yaml << "]\n";
    expectLeaves(load(yaml.str()));
  }
}

TEST_F(OctomapFile, OfAnotherKindIsRefused)
{
  const auto refused = [this](const std::string& text, const std::string& fragment)
  {
    folder_.write("wrong.bt", text);
    const std::string error = errorOf([&] { load("octomap: wrong.bt\n"); });
    EXPECT_NE(error.find(fragment), std::string::npos) << error;
    EXPECT_NE(error.find("scene.yaml:1: "), std::string::npos) << error;
  };
  const std::string first = "# Octomap OcTree binary file\n";
  refused("solid cube\n", "it is not a .bt or .ot file of liboctomap");
  refused(first, "has no line 'id CLASS'");
  refused(first + "id OcTree\nres 0.1\n", "'data'");
  refused(first + "id OcTree\nres much\ndata\nab", "has no line");
  refused(first + "id OcTree\nres 0.1\ndata\na", "the data end inside of the octree");
  refused(first + "id SemanticOcTree\nres 0.1\ndata\nab", "'SemanticOcTree'; known are");
  EXPECT_TRUE(load("world: {octomap: {octomap: {data: []}}}\n").objects.empty());
}

TEST_F(OctomapFile, ThatIsGivenTwiceIsRefused)
{
  tree_.writeBinary(folder_.path("map.bt"));
  EXPECT_THROW(load("octomap: map.bt\nworld: {octomap: {resource: map.bt}}\n"), Error);
  EXPECT_THROW(
      load("world: {octomap: {resource: map.bt, octomap: {data: [0, 0], binary: 1, id: OcTree, resolution: 1}}}\n"),
      Error);
  octomap::OcTree(0.1).writeBinary(folder_.path("empty.bt"));
  EXPECT_THROW(
      load("world: {octomap: {resource: empty.bt, octomap: {data: [0, 0], binary: 1, id: OcTree, resolution: 1}}}\n"),
      Error)
      << "the message must not be dropped because the file is empty";
}

TEST_F(OctomapFile, TimesOfAPostureThatRosCannotHoldAreRefused)
{
  const auto posture = [this](const std::string& text)
  {
    return load(
        "robot_state: {attached_collision_objects: [{link_name: pole, object: {id: tool, primitives: "
        "[{type: box, dimensions: [0.1, 0.1, 0.1]}]}, detach_posture: " +
        text + "}]}\n");
  };
  EXPECT_NO_THROW(posture("{header: {stamp: 4294967295}, joint_names: [], points: [{time_from_start: -2147483647}]}"));
  EXPECT_THROW(posture("{header: {stamp: -1}, joint_names: [], points: []}"), Error);
  EXPECT_THROW(posture("{joint_names: [], points: [{time_from_start: 3e9}]}"), Error);
}

TEST_F(OctomapFile, ObjectsKeepTheFieldsThatChangeNoVerdict)
{
  const PlanningScene scene = load(R"(
robot_state:
  attached_collision_objects:
    - link_name: pole
      object:
        id: tool
        type: {key: hammer, db: '{}'}
        primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]
      weight: 0.75
      detach_posture:
        header: {seq: 0, stamp: {secs: 3, nsecs: 5}, frame_id: pole}
        joint_names: [finger]
        points:
          - positions: [0.04]
            velocities: []
            accelerations: []
            effort: [1]
            time_from_start: {secs: 1, nsecs: 500000000}
world:
  collision_objects:
    - {id: cup, type: {key: "17", db: shop}, primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]}
)");
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ((ObjectType{"17", "shop"}), scene.objects.at(0).type);
  const AttachedObject& tool = scene.attached.at(0);
  EXPECT_EQ((ObjectType{"hammer", "{}"}), tool.object.type);
  EXPECT_EQ(0.75, tool.weight);
  const JointTrajectory expected{"pole", 3000000005, {"finger"}, {{{0.04}, {}, {}, {1.0}, 1500000000}}};
  EXPECT_TRUE(expected == tool.detach_posture);
}
}  // namespace
}  // namespace gpu_planning_scene::core
