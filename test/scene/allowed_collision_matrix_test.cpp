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
}  // namespace
}  // namespace gpu_planning_scene::core
