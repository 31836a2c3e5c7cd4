#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_planning_scene/resources.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The tests of URIs need no packages of this machine, and searching for them takes long.
const bool kNoPackages = setenv("ROS_PACKAGE_PATH", "/none", 1) == 0;
const PackageResolver kPackages = packageResolver({{"arm", "/opt"}});

std::string resolved(const std::string& uri)
{
  return resolveUri(uri, "/robots/my robot", kPackages);
}

std::string errorFor(const std::string& uri)
{
  return errorOf([&] { resolved(uri); });
}

TEST(Uri, PackagePathsLieInThePackagesFolder)
{
  EXPECT_EQ(resolved("package://arm/meshes/link 1.stl"), "/opt/meshes/link 1.stl");
  EXPECT_EQ(resolved("package://arm/./meshes//a/../link.stl"), "/opt/meshes/link.stl");
}

TEST(Uri, PercentEscapesAreDecodedInUris)
{
  EXPECT_EQ(resolved("package://arm/KR5%20sixx%2fR650.stl"), "/opt/KR5 sixx/R650.stl");
  EXPECT_EQ(resolved("file:///a%20b.stl"), "/a b.stl");
  EXPECT_EQ(resolved("package://arm/100%.stl"), "/opt/100%.stl");
  EXPECT_EQ(resolved("package://arm/50%zz"), "/opt/50%zz");
}

TEST(Uri, PlainPathsAreTakenAsTheyAre)
{
  EXPECT_EQ(resolved("/a b%20c.stl"), "/a b%20c.stl");
  EXPECT_EQ(resolved("meshes/a%20b.stl"), "/robots/my robot/meshes/a%20b.stl");
  EXPECT_EQ(resolved("../meshes/a.stl"), "/robots/my robot/../meshes/a.stl");
}

TEST(Uri, FileUrisNeedAnAbsolutePath)
{
  EXPECT_EQ(resolved("file:///robots/a.stl"), "/robots/a.stl");
  EXPECT_EQ(resolved("file://localhost/robots/a.stl"), "/robots/a.stl");
  EXPECT_NE(errorFor("file://robots/a.stl").find("file://robots/a.stl"), std::string::npos);
  EXPECT_NE(errorFor("file://"), "");
}

TEST(Uri, PackagePathsMustNotLeaveThePackage)
{
  for (const char* uri : {"package://arm/../secret.stl", "package://arm/meshes/../../secret.stl",
                          "package://arm/%2e%2e/secret.stl", "package://../arm/a.stl", "package://arm//etc/a.stl"})
    EXPECT_NE(errorFor(uri).find("leaves its package"), std::string::npos) << uri << ": " << errorFor(uri);
}

TEST(Uri, UnknownPackagesAreNamedWithTheRemedy)
{
  const std::string error = errorFor("package://leg/a.stl");
  EXPECT_NE(error.find("'leg'"), std::string::npos) << error;
  EXPECT_NE(error.find("give packageResolver the folder of leg"), std::string::npos) << error;
  EXPECT_NE(errorOf([] { resolveUri("package://arm/a.stl", "", PackageResolver()); }), "");
}

TEST(Uri, TheRemedyIsThatOfTheProgram)
{
  const PackageResolver packages = packageResolver({}, "name its folder (packages:={NAME: DIR})");
  EXPECT_EQ(errorOf([&] { resolveUri("package://leg/a.stl", "", packages); }),
            "mesh URI 'package://leg/a.stl': the folder of package 'leg' is not known; put the package on "
            "ROS_PACKAGE_PATH, or name its folder (packages:={leg: DIR})");
}

TEST(Uri, AnUnknownPackageIsShownBesideThePackagesWhoseFoldersAreGiven)
{
  const PackageResolver packages = packageResolver({{"arm", "/opt"}, {"leg", "/opt"}}, "");
  EXPECT_EQ(errorOf([&] { resolveUri("package://lge/a.stl", "", packages); }),
            "mesh URI 'package://lge/a.stl': the folder of package 'lge' is not known (folders are given for: arm, "
            "leg); put the package on ROS_PACKAGE_PATH");
}

TEST(Uri, AGivenFolderThatDoesNotExistIsNamedWithItsPackage)
{
  const PackageResolver packages = packageResolver({{"leg", "/no/leg"}});
  EXPECT_EQ(errorOf([&] { resolveUri("package://leg/a.stl", "", packages); }),
            "mesh URI 'package://leg/a.stl': the folder '/no/leg' does not exist; check the folder given for package "
            "'leg'");
}

/// Sets ROS_PACKAGE_PATH while it lives.
class RosPackagePath
{
 public:
  explicit RosPackagePath(const std::string& path) { setenv("ROS_PACKAGE_PATH", path.c_str(), 1); }
  ~RosPackagePath() { setenv("ROS_PACKAGE_PATH", "/none", 1); }
};

TEST(PackageResolver, FindsPackagesAsRosDoes)
{
  const TemporaryFolder folder;
  const auto package = [&folder](const std::string& path, const std::string& name)
  {
    std::filesystem::create_directories(folder.path(path));
    folder.write(path + "/package.xml", "<?xml version=\"1.0\"?><package><name> " + name + " </name></package>");
  };
  package("first/repository/arm", "arm");              // below a folder that is no package
  package("first/other_name", "leg");                  // the name is in package.xml
  package("first/leg_of_old", "leg_of_old");           // not mistaken for its neighbours
  package("first/other_name/inside", "inside_a_leg");  // in a package
  package("first/.hidden/cat", "cat");
  package("first/ignored/dog", "dog");
  folder.write("first/ignored/CATKIN_IGNORE", "");
  package("first/leaf/owl", "owl");
  folder.write("first/leaf/rospack_nosubdirs", "");
  package("second/arm", "arm");  // the first one counts
  package("second/hand", "hand");
  std::filesystem::create_directory_symlink(folder.path("first"), folder.path("first/circle"));

  const RosPackagePath path(folder.path("none") + "::" + folder.path("first") + ":" + folder.path("second"));
  const PackageResolver packages = packageResolver({{"given", "/opt"}, {"hand", "/usr"}});
  EXPECT_EQ("/opt", packages("given"));
  EXPECT_EQ("/usr", packages("hand")) << "given folders come first";
  EXPECT_EQ(folder.path("first/other_name"), packages("leg"));
  EXPECT_EQ(folder.path("first/repository/arm"), packages("arm"));
  EXPECT_EQ(folder.path("second/hand"), packageResolver({})("hand"));
  for (const char* name : {"other_name", "inside_a_leg", "cat", "dog", "owl", "missing"})
    EXPECT_NE("", errorOf([&] { packages(name); })) << name;
}

TEST(Uri, FurtherSlashesBeforeThePackageArePassedOver)
{
  EXPECT_EQ("/opt/meshes/a.stl", resolveUri("package:///arm/meshes/a.stl", "", kPackages));
  const TemporaryFolder folder;
  const std::string mesh = folder.write("meshes/a.stl", "");
  const PackageResolver packages = packageResolver({{"arm", folder.path("")}});
  EXPECT_EQ(std::filesystem::canonical(mesh), resolveAllowed("package:///arm/meshes/a.stl", "", packages, {}));
}

TEST(Uri, UnresolvableUrisAreErrors)
{
  for (const char* uri : {"", "package://", "package://arm", "package://arm/", "package:///a.stl",
                          "http://example.com/a.stl", "model://arm/a.stl", "package://arm/a%00.stl"})
    EXPECT_NE(errorFor(uri), "") << uri;
  EXPECT_NE(errorOf([] { resolveUri("a.stl", "", kPackages); }).find("a.stl"), std::string::npos);
}
}  // namespace
}  // namespace gpu_planning_scene::core
