// The lines that name each part of a mesh that bounds no solid, or only with filled holes.

#include <gtest/gtest.h>

#include "gpu_planning_scene/body_parts.h"
#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A cube without its first triangles. Two of twelve have a tenth of its remaining area or more, one has less.
PlacedShape cubeWithout(std::size_t missing, SolidRule rule = SolidRule::Auto)
{
  auto mesh = std::make_shared<Mesh>(*tessellate(Box{{1.0, 1.0, 1.0}}).mesh);
  mesh->name = "cube.stl";
  mesh->solid = rule;
  mesh->triangles.erase(mesh->triangles.begin(), mesh->triangles.begin() + static_cast<std::ptrdiff_t>(missing));
  return {std::shared_ptr<const Mesh>(mesh)};
}

class BodyParts : public SceneChanges
{
 protected:
  /// The lines for an object with this shape.
  std::vector<std::string> linesOf(const PlacedShape& shape)
  {
    scene_ = PlanningScene(sliderRobot());
    change(objectChange(Operation::Add, "bin", {shape}));
    return describeOpenParts(scene_);
  }
};

using Lines = std::vector<std::string>;

TEST_F(BodyParts, AreNotNamedIfTheyAreClosedOrMended)
{
  EXPECT_EQ(Lines(), linesOf(cubeWithout(0)));
  auto mesh = std::make_shared<Mesh>(*std::get<std::shared_ptr<const Mesh>>(cubeWithout(0).shape));
  std::swap(mesh->triangles[3][0], mesh->triangles[3][1]);
  EXPECT_EQ(Lines(), linesOf({std::shared_ptr<const Mesh>(mesh)}));
  const std::vector<BodyPart> parts = openParts(scene_);
  ASSERT_EQ(1u, parts.size());
  EXPECT_EQ(PartKind::Mended, parts[0].part.kind);
  EXPECT_EQ("bin", scene_.bodyName(parts[0].body));
}

TEST_F(BodyParts, AreNamedWithTheirHolesAndTheRemedy)
{
  EXPECT_EQ((Lines{"object 'bin', mesh 'cube.stl': 1 hole of up to 1.4 m is filled (up to 9.1 % of a part's area)"}),
            linesOf(cubeWithout(1)));
  EXPECT_EQ((Lines{"object 'bin', mesh 'cube.stl': 1 part with 10 triangles is only a surface: 1 hole of up to 1.4 m "
                   "(20 % of the area; at most 10 % is filled). A body inside does not collide; `solid: filled` fills "
                   "the holes"}),
            linesOf(cubeWithout(2)));
  EXPECT_EQ((Lines{"object 'bin', mesh 'cube.stl': 1 hole of up to 1.4 m is filled (up to 20 % of a part's area)"}),
            linesOf(cubeWithout(2, SolidRule::Filled)));
  EXPECT_EQ((Lines{"object 'bin', mesh 'cube.stl': is a surface, as the rule 'surface' demands; a body inside it does "
                   "not collide"}),
            linesOf(cubeWithout(0, SolidRule::Surface)));
}

TEST_F(BodyParts, OfLinksObjectsAndWhatLinksCarryAreNamedInTheOrderOfBodies)
{
  scene_ = PlanningScene(sliderRobotOfMeshes());
  change(objectChange(Operation::Add, "bin", {boxAt(0.1), cubeWithout(2), cubeWithout(0)}));
  change(attachedChange(Operation::Add, "tool", "cart", {cubeWithout(4)}));
  const Lines lines = describeOpenParts(scene_);
  ASSERT_EQ(3u, lines.size());
  EXPECT_EQ(0u, lines[0].find("link 'pole', mesh '")) << lines[0];
  EXPECT_NE(std::string::npos, lines[0].find("1 part with 10 triangles is only a surface: 1 hole")) << lines[0];
  EXPECT_EQ(0u, lines[1].find("object 'bin', mesh 'cube.stl': 1 part with 10 triangles")) << lines[1];
  EXPECT_EQ(0u, lines[2].find("attached object 'tool', mesh 'cube.stl': 1 part with 8 triangles")) << lines[2];
}
}  // namespace
}  // namespace gpu_planning_scene::core
