#include <gtest/gtest.h>

#include "gpu_planning_scene/resources.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
const PackageResolver kPackages = packageResolver({{"arm", "/opt/arm"}});

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
  EXPECT_EQ(resolved("package://arm/meshes/link 1.stl"), "/opt/arm/meshes/link 1.stl");
  EXPECT_EQ(resolved("package://arm/./meshes//a/../link.stl"), "/opt/arm/meshes/link.stl");
}

TEST(Uri, PercentEscapesAreDecodedInUris)
{
  EXPECT_EQ(resolved("package://arm/KR5%20sixx%2fR650.stl"), "/opt/arm/KR5 sixx/R650.stl");
  EXPECT_EQ(resolved("file:///a%20b.stl"), "/a b.stl");
  EXPECT_EQ(resolved("package://arm/100%.stl"), "/opt/arm/100%.stl");
  EXPECT_EQ(resolved("package://arm/50%zz"), "/opt/arm/50%zz");
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
  EXPECT_NE(error.find("--package leg=DIR"), std::string::npos) << error;
  EXPECT_NE(errorOf([] { resolveUri("package://arm/a.stl", "", PackageResolver()); }), "");
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
