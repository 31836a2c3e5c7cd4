// The allowed-collision matrix, and the lifetime of its entries: an entry lives as long as the object that it names.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(AllowedCollisionMatrix, ARemovedBodyIsAsIfItHadNeverBeenNamed)
{
  AllowedCollisionMatrix matrix;
  matrix.setEntry("a", "b", true);
  matrix.setEntry("a", "c", false);
  const AllowedCollisionMatrix before = matrix;
  matrix.setEntry("big", "a", true);
  matrix.setEntry("b", "big", true);
  matrix.setEntry("big", "big", true);
  matrix.setEntry("big", "alone", true);
  matrix.setDefault("big", true);
  EXPECT_EQ((std::vector<std::string>{"a", "alone", "b", "big"}), matrix.allowedPartners("big"));
  matrix.removeEntry("big");
  EXPECT_TRUE(matrix == before) << "also 'alone', which had no other entry, is gone";
  EXPECT_FALSE(matrix.allowed("big", "a"));
  EXPECT_TRUE(matrix.allowedPartners("big").empty());
  matrix.removeEntry("big");
  EXPECT_TRUE(matrix == before);
}

TEST(AllowedCollisionMatrix, ABodyWithADefaultKeepsItWhenItsLastPartnerIsRemoved)
{
  AllowedCollisionMatrix matrix;
  matrix.setDefault("a", true);
  matrix.setEntry("a", "b", false);
  EXPECT_EQ((std::vector<std::string>{"a"}), matrix.removeEntry("b")) << "'a' may touch 'b' now";
  EXPECT_TRUE(matrix.allowed("a", "b"));
}

TEST(AllowedCollisionMatrix, ADefaultThatForbadePairsIsReportedWhenItsBodyIsRemoved)
{
  AllowedCollisionMatrix matrix;
  matrix.setDefault("palm", true);
  matrix.setDefault("can", false);
  matrix.setEntry("thumb", "can", false);
  EXPECT_FALSE(matrix.allowed("palm", "can"));
  EXPECT_EQ((std::vector<std::string>{"palm"}), matrix.removeEntry("can")) << "'palm' may touch a new 'can'";
  EXPECT_TRUE(matrix.allowed("palm", "can"));
}

TEST(AllowedCollisionMatrix, APairThatAnEntryAllowedIsNotReportedWhenItsBodyIsRemoved)
{
  AllowedCollisionMatrix matrix;
  matrix.setDefault("palm", true);
  matrix.setDefault("can", false);
  matrix.setEntry("palm", "can", true);
  EXPECT_TRUE(matrix.removeEntry("can").empty()) << "'palm' could touch 'can' before";
}

/// All links may touch 'big'.
class AllowedObject : public SceneChanges
{
 protected:
  AllowedObject()
  {
    change(objectChange(Operation::Add, "big", {boxAt(0.1)}));
    allowBig();
  }

  void allowBig()
  {
    SceneChange allow;
    allow.is_diff = true;
    allow.matrix = scene_.allowed_collisions;
    for (const Link& link : scene_.robot->links())
      allow.matrix->setEntry("big", link.name, true);
    allow.matrix->setDefault("big", true);
    apply(allow);
  }

  bool isAllowed() const { return scene_.allowed_collisions.allowed("big", "cart"); }
};

TEST_F(AllowedObject, LosesItsEntriesWhenItIsRemoved)
{
  const AllowedCollisionMatrix srdf = AllowedCollisionMatrix::fromRobot(*scene_.robot);
  for (const char* id : {"big", ""})
  {
    SCOPED_TRACE(id);
    EXPECT_TRUE(isAllowed());
    change(objectChange(Operation::Remove, id));
    EXPECT_TRUE(scene_.allowed_collisions == srdf);
    change(objectChange(Operation::Add, "big", {boxAt(0.1)}));
    EXPECT_FALSE(isAllowed());
    EXPECT_TRUE(warnings_.empty());
    allowBig();
  }
}

TEST_F(AllowedObject, LosesThemAlsoWhereItComesBackInTheSameChange)
{
  SceneChange again;
  again.is_diff = true;
  again.objects = {objectChange(Operation::Remove, "big"), objectChange(Operation::Add, "big", {boxAt(0.1)})};
  apply(again);
  EXPECT_FALSE(isAllowed());
}

TEST_F(AllowedObject, LosesThemWhenItIsDroppedByTheLinkThatCarriesIt)
{
  change(attachedChange(Operation::Add, "big", "pole"));
  EXPECT_TRUE(isAllowed()) << "it is the same object";
  SceneChange replace;
  replace.is_diff = true;
  replace.state.is_diff = false;
  replace.state.variables["slide"] = 0.0;
  apply(replace);
  EXPECT_TRUE(warned("object 'big' was removed"));
  change(objectChange(Operation::Add, "big", {boxAt(0.1)}));
  EXPECT_FALSE(isAllowed());
}

TEST_F(AllowedObject, KeepsItsEntriesWhileItIsReplacedCarriedAndPutBack)
{
  change(objectChange(Operation::Add, "big", {boxAt(0.2)}));
  EXPECT_TRUE(isAllowed());
  EXPECT_TRUE(warnings_.empty());
  change(attachedChange(Operation::Add, "big", "pole"));
  EXPECT_TRUE(isAllowed());
  change(attachedChange(Operation::Remove, "big", ""));
  EXPECT_TRUE(isAllowed());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(AllowedObject, KeepsThemWhereTheRemovalSaysThatItComesBack)
{
  ObjectChange remove = objectChange(Operation::Remove, "big");
  remove.keeps_allowed_collisions = true;
  change(remove);
  EXPECT_TRUE(scene_.objects.empty());
  EXPECT_TRUE(isAllowed());
}

TEST_F(AllowedObject, IsWarnedOfWhereEarlierEntriesAllowANewObject)
{
  change(objectChange(Operation::Remove, "big"));
  allowBig();
  change(objectChange(Operation::Add, "big", {boxAt(0.1)}));
  EXPECT_TRUE(isAllowed());
  EXPECT_TRUE(warned("object 'big' is new, and the allowed-collision matrix lets it touch"));
  change(objectChange(Operation::Remove, "big"));
  allowBig();
  change(attachedChange(Operation::Add, "big", "pole", {boxAt(0.1)}));
  EXPECT_TRUE(warned("object 'big' is new"));

  change(attachedChange(Operation::Remove, "big", ""));
  change(objectChange(Operation::Remove, "big"));
  SceneChange both;
  both.is_diff = true;
  both.matrix = scene_.allowed_collisions;
  both.matrix->setEntry("big", "cart", true);
  both.objects = {objectChange(Operation::Add, "big", {boxAt(0.1)})};
  apply(both);
  EXPECT_TRUE(isAllowed());
  EXPECT_TRUE(warnings_.empty()) << "the same change says what the object may touch";
}
TEST_F(AllowedObject, IsWarnedOfWhenItsRemovalEndsAProhibition)
{
  SceneChange forbid;
  forbid.is_diff = true;
  forbid.matrix = AllowedCollisionMatrix::fromRobot(*scene_.robot);
  forbid.matrix->setDefault("cart", true);
  forbid.matrix->setEntry("big", "cart", false);
  apply(forbid);
  EXPECT_FALSE(isAllowed());
  change(objectChange(Operation::Remove, "big"));
  EXPECT_TRUE(isAllowed());
  EXPECT_TRUE(warned("the matrix entry that forbids contact with 'cart'"));
}

/// Full scenes. The SRDF allows the collision of cart and pole, and of 'nut' with everything.
class MatrixOfAFullScene : public SceneChanges
{
 protected:
  MatrixOfAFullScene()
  {
    std::string urdf = sliderUrdf();
    const std::string nut = "<link name=\"nut\"/>";
    urdf.replace(urdf.find(nut), nut.size(),
                 "<link name='nut'><collision><geometry><sphere radius='0.01'/></geometry></collision></link>");
    std::string srdf = sliderSrdf();
    srdf.insert(srdf.find("</robot>"), "<disable_default_collisions link=\"nut\"/>");
    scene_ = PlanningScene(RobotModel::fromXml(urdf, srdf, {}));
    robots_ = AllowedCollisionMatrix::fromRobot(*scene_.robot);
    change(objectChange(Operation::Add, "can", {boxAt(0.1)}));
    change(objectChange(Operation::Add, "mug", {boxAt(0.1)}));
  }

  void setMatrix(const AllowedCollisionMatrix& matrix)
  {
    SceneChange diff;
    diff.is_diff = true;
    diff.matrix = matrix;
    apply(diff);
  }

  /// A full scene with these objects, and with the matrix, if there is one.
  void replaceScene(const std::vector<std::string>& ids, const std::optional<AllowedCollisionMatrix>& matrix)
  {
    SceneChange full;
    full.matrix = matrix;
    for (const std::string& id : ids)
      full.objects.push_back(objectChange(Operation::Add, id, {boxAt(0.1)}));
    apply(full);
  }

  AllowedCollisionMatrix robots_;  // the robot's own matrix
};

TEST_F(MatrixOfAFullScene, WithoutOneAPairThatTheRobotsOwnMatrixAllowsIsNamed)
{
  AllowedCollisionMatrix checks_all;
  checks_all.setEntry("cart", "pole", false);
  setMatrix(checks_all);
  replaceScene({}, std::nullopt);
  ASSERT_EQ(2u, warnings_.size()) << "the other one names the can and the mug";
  EXPECT_TRUE(warned("3 pairs of bodies are no longer checked, for example 'cart' and 'nut'")) << warnings_[0];
  EXPECT_TRUE(warned("has no allowed_collision_matrix, so the robot's own matrix applies again")) << warnings_[0];
  setMatrix(checks_all);
  replaceScene({"can", "mug", "new"}, std::nullopt);
  EXPECT_TRUE(warned("6 pairs of bodies")) << "the nut and each object: " << warnings_.at(0);
}

TEST_F(MatrixOfAFullScene, WithoutOneAnAttachedObjectCountsExceptWithItsOwnLinks)
{
  setMatrix(AllowedCollisionMatrix());
  AttachedChange cup = attachedChange(Operation::Add, "cup", "pole", {boxAt(0.1)});
  SceneChange full;
  full.state.is_diff = false;
  full.state.attached = {cup};
  apply(full);
  EXPECT_TRUE(warned("4 pairs of bodies")) << warnings_.at(0);
  setMatrix(AllowedCollisionMatrix());
  full.state.attached[0].touch_links = {"nut"};
  apply(full);
  EXPECT_TRUE(warned("3 pairs of bodies")) << warnings_.at(0);
}

TEST_F(MatrixOfAFullScene, WithoutOneNothingIsSaidIfNoPairIsLost)
{
  AllowedCollisionMatrix more = robots_;
  more.setEntry("can", "pole", true);
  setMatrix(more);
  replaceScene({"can", "mug"}, std::nullopt);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0] << ": more pairs are checked";
  replaceScene({"can", "mug"}, std::nullopt);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
}

TEST_F(MatrixOfAFullScene, WithOneItIsMeantAsItIs)
{
  setMatrix(AllowedCollisionMatrix());
  replaceScene({"can", "mug"}, robots_);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  AllowedCollisionMatrix without_links;
  without_links.setEntry("can", "mug", true);
  replaceScene({"can", "mug"}, without_links);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0] << ": pairs of links that it does not name are checked";
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole"));
}

TEST_F(MatrixOfAFullScene, NothingIsSaidOfTheEntriesOfObjectsThatItReplaces)
{
  AllowedCollisionMatrix forbids;
  forbids.setDefault("pole", true);
  forbids.setEntry("pole", "can", false);
  forbids.setEntry("pole", "cup", false);
  const auto fill = [&]
  {
    setMatrix(forbids);
    SceneChange diff;
    diff.is_diff = true;
    diff.state.attached = {attachedChange(Operation::Add, "cup", "cart", {boxAt(0.1)})};
    diff.objects = {objectChange(Operation::Add, "can", {boxAt(0.1)})};
    apply(diff);
  };
  fill();
  replaceScene({}, robots_);
  EXPECT_FALSE(warned("was removed together with the matrix entry")) << warnings_[0];
  fill();
  replaceScene({}, forbids);
  EXPECT_FALSE(warned("was removed together with the matrix entry")) << warnings_[0];
  EXPECT_FALSE(scene_.allowed_collisions.allowed("pole", "can")) << "the new matrix still forbids it";
  fill();
  change(objectChange(Operation::Remove, "can"));
  EXPECT_TRUE(warned("'can' was removed together with the matrix entry")) << "a diff keeps the matrix";
}

TEST_F(MatrixOfAFullScene, OfDefaultsAloneReplacesTheRobotsEntriesWithAWarning)
{
  AllowedCollisionMatrix defaults;
  defaults.setDefault("can", true);
  replaceScene({"can", "mug"}, defaults);
  ASSERT_EQ(1u, warnings_.size());
  EXPECT_TRUE(
      warned("allowed_collision_matrix: it has only default entries, so the pairs that the SRDF allows are checked too "
             "(as in MoveIt)"));
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole"));
  EXPECT_TRUE(scene_.allowed_collisions.allowed("cart", "can"));
  defaults.setEntry("cart", "pole", true);
  replaceScene({"can", "mug"}, defaults);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
}
}  // namespace
}  // namespace gpu_planning_scene::core
