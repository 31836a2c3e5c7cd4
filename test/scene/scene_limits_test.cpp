// The limits of a scene that a change must not exceed.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class Limits : public SceneChanges
{
};

TEST_F(Limits, OfObjectsCountTheWorldsAndThoseCarried)
{
  limits_.objects = 2;
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  change(attachedChange(Operation::Add, "b", "pole", {boxAt(0.1)}));
  refused("limits/objects", objectChange(Operation::Add, "c", {boxAt(0.1)}));
  refused("limits/objects", attachedChange(Operation::Add, "c", "pole", {boxAt(0.1)}));
  change(objectChange(Operation::Add, "a", {boxAt(0.2)}));  // replaces the object
  change(attachedChange(Operation::Add, "a", "pole"));      // the same object, now attached
  change(attachedChange(Operation::Remove, "a", "pole"));
  SceneChange swap;
  swap.is_diff = true;
  swap.objects = {objectChange(Operation::Remove, "a"), objectChange(Operation::Add, "c", {boxAt(0.1)})};
  apply(swap);
  SceneChange full;
  full.state.is_diff = false;
  full.objects = {objectChange(Operation::Add, "d", {boxAt(0.1)}), objectChange(Operation::Add, "e", {boxAt(0.1)})};
  apply(full);
}

TEST_F(Limits, OfShapesCountThoseOfAllObjects)
{
  limits_.shapes = 3;
  change(objectChange(Operation::Add, "a", {boxAt(0.1), boxAt(0.1)}));
  refused("limits/shapes", objectChange(Operation::Add, "b", {boxAt(0.1), boxAt(0.1)}));
  refused("limits/shapes", objectChange(Operation::Append, "a", {boxAt(0.1), boxAt(0.1)}));
  change(objectChange(Operation::Append, "a", {boxAt(0.1)}));
  refused("limits/shapes", attachedChange(Operation::Add, "b", "pole", {boxAt(0.1)}));
  change(objectChange(Operation::Add, "a", {boxAt(0.1)}));
  change(attachedChange(Operation::Add, "b", "pole", {boxAt(0.1), boxAt(0.1)}));
  refused("limits/shapes", attachedChange(Operation::Append, "b", "pole", {boxAt(0.1)}));
}

TEST_F(Limits, OfTrianglesCountEachMeshOnce)
{
  limits_.triangles = 2;
  const PlacedShape mesh = triangleAt();
  change(objectChange(Operation::Add, "a", {mesh, mesh, mesh}));
  change(objectChange(Operation::Add, "b", {triangleAt()}));
  refused("limits/triangles", objectChange(Operation::Add, "c", {triangleAt()}));
  change(objectChange(Operation::Add, "c", {mesh}));
}

TEST_F(Limits, OfFramesAndColorsCountWhatManyChangesAddUpTo)
{
  limits_.frames = 2;
  limits_.colors = 2;
  ObjectChange framed = objectChange(Operation::Add, "a", {boxAt(0.1)});
  framed.subframes["tip"] = poseAt(0, 0, 1);
  change(framed);
  framed.operation = Operation::Append;
  framed.subframes = {{"tail", poseAt(0, 0, 1)}};
  change(framed);
  framed.subframes = {{"side", poseAt(0, 0, 1)}};
  refused("limits/frames", framed);
  SceneChange fixed;
  fixed.is_diff = true;
  fixed.fixed_frames["hall"] = poseAt(0, 0, 1);
  refused("limits/frames", fixed);
  SceneChange colored;
  colored.is_diff = true;
  colored.colors = {{"a", Color{}}, {"b", Color{}}};
  apply(colored);
  colored.colors = {{"c", Color{}}};
  refused("limits/colors", colored);
}

TEST_F(Limits, OfAMeshAreItsOwn)
{
  limits_.triangles_of_mesh = 1;
  const Mesh two{"two", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  change(objectChange(Operation::Add, "a", {triangleAt()}));
  refused("limits/triangles_of_mesh", objectChange(Operation::Add, "b", {{std::make_shared<const Mesh>(two)}}));
}

TEST_F(Limits, OfNamesAreBytes)
{
  limits_.name_length = 3;
  change(objectChange(Operation::Add, "abc", {boxAt(0.1)}));
  refused("limits/name_length", objectChange(Operation::Add, "abcd", {boxAt(0.1)}));
  ObjectChange object = objectChange(Operation::Add, "abc", {boxAt(0.1)});
  object.subframes["corner"] = poseAt(0, 0, 0);
  refused("limits/name_length", object);
}

TEST_F(Limits, OfTheMatrixAreItsEntries)
{
  limits_.matrix_entries = 4;
  SceneChange matrix;
  matrix.is_diff = true;
  matrix.matrix = AllowedCollisionMatrix();
  matrix.matrix->setEntry("a", "b", true);
  apply(matrix);
  matrix.matrix->setEntry("a", "c", true);
  refused("limits/matrix_entries", matrix);
}

TEST_F(Limits, OfZeroAreNone)
{
  limits_ = {0, 0, 0, 0, 0, 0, 0, 0};
  change(objectChange(Operation::Add, std::string(5000, 'a'), {boxAt(0.1), triangleAt()}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
