#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_reader.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

// A package with a mesh, symbolic links that stay in the package or lead out of it, and meshes outside the package.
class AllowedRootsTest : public ::testing::Test
{
 protected:
  AllowedRootsTest()
  {
    folder_.write("arm/meshes/link.stl", "x");
    folder_.write("arm_2/link.stl", "x");
    folder_.write("free/link.stl", "x");
    folder_.write("secret.stl", "x");
    fs::create_symlink(folder_.path("secret.stl"), folder_.path("arm/out.stl"));
    fs::create_directory_symlink(folder_.path("arm_2"), folder_.path("arm/folder"));
    fs::create_symlink("meshes/link.stl", folder_.path("arm/in.stl"));
    fs::create_directory_symlink(folder_.path("arm"), folder_.path("linked_arm"));
    fs::create_symlink(folder_.path("secret.stl"), folder_.path("free/out.stl"));
  }

  std::string resolved(const std::string& uri) const
  {
    const PackageResolver packages =
        packageResolver({{"arm", folder_.path("arm")}, {"linked", folder_.path("linked_arm/")}});
    return resolveAllowed(uri, folder_.path("arm/meshes"), packages, allowed_);
  }
  std::string errorFor(const std::string& uri) const
  {
    return errorOf([&] { resolved(uri); });
  }
  // The path of `name` in the test's folder, without symbolic links in the folder's path.
  std::string real(const std::string& name) const { return (fs::canonical(folder_.path(".")) / name).string(); }

  TemporaryFolder folder_;
  AllowedRoots allowed_;
};

TEST_F(AllowedRootsTest, PackagesMayBeReadFrom)
{
  EXPECT_EQ(resolved("package://arm/meshes/link.stl"), real("arm/meshes/link.stl"));
  EXPECT_EQ(resolved("package://arm/meshes/x/../link.stl"), real("arm/meshes/link.stl"));
  EXPECT_EQ(resolved("package://arm/in.stl"), real("arm/meshes/link.stl")) << "a link within the package";
  EXPECT_EQ(resolved("package://linked/in.stl"), real("arm/meshes/link.stl")) << "a package that is itself a link";
  EXPECT_EQ(resolved("package://arm/none.stl"), real("arm/none.stl")) << "the file need not exist";
}

TEST_F(AllowedRootsTest, NoPathLeavesAPackage)
{
  for (const char* uri :
       {"package://arm/../secret.stl", "package://arm/%2e%2e/secret.stl", "package://arm/%2E%2e%2fsecret.stl",
        "package://arm/meshes/..%2f..%2fsecret.stl", "package://arm/out.stl", "package://arm/folder/link.stl",
        "package://linked/out.stl", "package://arm/../arm_2/link.stl", "package://../secret.stl",
        "package://%2e%2e/secret.stl", "package://arm%2Ffolder/link.stl", "package://arm%2ffolder%2flink.stl/x",
        "package://arm%2Fmeshes%2F..%2Ffolder/link.stl"})
    EXPECT_NE(errorFor(uri).find("leaves its package"), std::string::npos) << uri << ": " << errorFor(uri);
}

TEST_F(AllowedRootsTest, OtherFilesNeedARoot)
{
  for (const std::string& prefix : {std::string(), std::string("file://")})
  {
    const std::string inside = prefix + folder_.path("free/link.stl");
    allowed_.roots.clear();
    EXPECT_NE(errorFor(inside).find("~mesh/roots"), std::string::npos) << errorFor(inside);
    allowed_.roots = {folder_.path("arm"), folder_.path("free")};
    EXPECT_EQ(resolved(inside), real("free/link.stl"));
    for (const char* outside : {"secret.stl", "free/../secret.stl", "free/out.stl", "arm_2/link.stl", "free"})
      EXPECT_NE(errorFor(prefix + folder_.path(outside)).find("~mesh/roots"), std::string::npos) << outside;
  }
  EXPECT_NE(errorFor("file://" + folder_.path("free/%2e%2e/secret.stl")).find("~mesh/roots"), std::string::npos);
}

TEST_F(AllowedRootsTest, RelativePathsStayInTheFolderOfTheFileThatNamesThem)
{
  EXPECT_EQ(resolved("link.stl"), real("arm/meshes/link.stl"));
  EXPECT_NE(errorFor("../out.stl"), "");
  EXPECT_NE(errorFor("../../secret.stl"), "");
  allowed_.roots = {folder_.path("free")};
  EXPECT_EQ(resolved("../../free/link.stl"), real("free/link.stl"));
}

TEST_F(AllowedRootsTest, AFunctionOfTheCallerFindsFilesBeforeTheRules)
{
  MeshAccess access;
  access.roots = allowed_;
  access.find = [](const std::string& uri) { return uri == "package://none/a.stl" ? "/there/a.stl" : ""; };
  EXPECT_EQ(access.resolve("package://none/a.stl", "", PackageResolver()), "/there/a.stl");
  EXPECT_THROW(access.resolve("/x/a.stl", "", PackageResolver()), Error);
}

TEST_F(AllowedRootsTest, WithoutRootsAnyFileMayBeNamed)
{
  EXPECT_EQ(MeshAccess().resolve("/x/a.stl", "", PackageResolver()), "/x/a.stl");
}
}  // namespace
}  // namespace gpu_planning_scene::core
