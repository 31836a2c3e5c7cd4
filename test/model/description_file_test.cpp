// Files of a URDF or SRDF that the program xacro must expand. A script takes the place of xacro.

#include "model/description/description_file.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <variant>

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "support/xacro_stand_in.h"

namespace gpu_planning_scene::core
{
namespace
{
const char* const kRobot = R"(<robot name='r'>
<xacro:property name='height' value='2'/>
<link name='a'><collision><geometry><box size='1 1 ${height}'/></geometry></collision></link>
<link name='b'/>
<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>
</robot>)";
const char* const kSrdf = R"(<robot name='r'>
<xacro:include filename='x'/>
<group name='all'><joint name='j'/></group>
</robot>)";

const std::string kAdvice = "; expand it by hand, and give the result: xacro FILE [NAME:=VALUE] > expanded.urdf";

class XacroFile : public testing::Test
{
 protected:
  DescriptionText read(double seconds = 30.0)
  {
    return readDescription(
        path_, "URDF", packages_, [this](const std::string& line) { info_.push_back(line); }, seconds);
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.write("Sam's arm, new $(x).urdf.xacro", kRobot);
  std::vector<std::string> info_;
  std::map<std::string, std::string> packages_;
};

TEST_F(XacroFile, IsExpandedWhereXacroIsInstalled)
{
  const XacroStandIn xacro(kExpandingXacro);
  const std::string srdf = folder_.write("r.srdf.xacro", kSrdf);
  RobotModelOptions options;
  options.info = [this](const std::string& line) { info_.push_back(line); };
  std::vector<std::string> warnings;
  const auto robot = RobotModel::fromFiles(path_, srdf, options, &warnings);
  EXPECT_EQ(Eigen::Vector3d(1.0, 1.0, 2.0), std::get<Box>(robot->links().at(0).shapes.at(0).shape).size);
  EXPECT_EQ("all", robot->groups().at(0).name);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  const std::string by = "' is a xacro file: it was expanded with its default arguments by " + xacro.program();
  EXPECT_EQ((std::vector<std::string>{"URDF '" + path_ + by, "SRDF '" + srdf + by}), info_);
}

/// Does what xacro does: looks for a folder with the package's manifest on ROS_PACKAGE_PATH, and reads a file there.
const char* const kFindingXacro = R"(
for folder in $(echo "$ROS_PACKAGE_PATH" | tr ':' ' '); do
  if grep -qs '<name>my_arm</name>' "$folder/package.xml"; then found=$folder; break; fi
done
cat "${found:?no package my_arm}/urdf/arm.xml" | sed "s|FOLDER|$found|")";

TEST_F(XacroFile, FindsTheGivenPackages)
{
  // The folder of the package has another name and another manifest.
  folder_.write("checkout/package.xml", "<package><name>other</name></package>");
  folder_.write("checkout/urdf/arm.xml", "<robot name='r'><link name='FOLDER/meshes'/></robot>");
  const XacroStandIn xacro(kFindingXacro);
  packages_ = {{"my_arm_2", folder_.path("")}, {"my_arm", folder_.path("checkout")}};
  EXPECT_EQ("<robot name='r'><link name='" + folder_.path("checkout") + "/meshes'/></robot>", read().text);
  packages_ = {{"my_arm", folder_.path("none")}};
  EXPECT_EQ("the folder '" + folder_.path("none") + "' does not exist; check the folder given for package 'my_arm'",
            errorOf([&] { read(); }));
  RobotModelOptions options;
  options.package_folders = {{"my_arm", folder_.path("checkout")}};
  EXPECT_EQ(1u, RobotModel::fromFiles(path_, "", options)->links().size());
}

TEST_F(XacroFile, LeavesNothingOfTheGivenPackagesBehind)
{
  const std::string seen = folder_.write("seen", "");
  const XacroStandIn xacro("echo \"${ROS_PACKAGE_PATH%%:*}\" > '" + seen + "'; ls -d \"${ROS_PACKAGE_PATH%%:*}\"");
  packages_ = {{"a", folder_.path("")}};
  EXPECT_EQ(folder_.path(""), read().text.substr(0, folder_.path("").size()));
  std::ifstream file(seen);
  std::string package;
  std::getline(file, package);
  EXPECT_EQ("a", std::filesystem::path(package).filename());
  EXPECT_FALSE(std::filesystem::exists(package)) << package;
}

TEST_F(XacroFile, FaultsOfTheExpandedTextNameXacroAndTheLineOfItsOutput)
{
  const XacroStandIn xacro("echo \"<robot name='r'>\"; echo \"<link/></robot>\"");
  EXPECT_EQ(0u, errorOf([&] { RobotModel::fromFiles(path_, "", {}); }).find("xacro " + path_ + ":2: "))
      << errorOf([&] { RobotModel::fromFiles(path_, "", {}); });
}

TEST_F(XacroFile, AFailureOfXacroIsAnErrorWithItsMessage)
{
  const XacroStandIn xacro(
      "echo 'error: no argument side'; echo 'error: no argument side' >&2; echo 'in macro arm' >&2; exit 1");
  EXPECT_EQ("URDF '" + path_ + "' is a xacro file: " + xacro.program() +
                " failed with exit code 1: error: no argument side in macro arm" + kAdvice,
            errorOf([&] { read(); }));
  EXPECT_TRUE(info_.empty());
}

TEST_F(XacroFile, AXacroThatHangsIsStopped)
{
  const XacroStandIn xacro("exec sleep 60");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ("URDF '" + path_ + "' is a xacro file: " + xacro.program() + " takes longer than 0.2 s" + kAdvice,
            errorOf([&] { read(0.2); }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST_F(XacroFile, ACrashOfXacroAndAnEmptyOutputAreErrors)
{
  {
    const XacroStandIn xacro("kill -SEGV $$");
    EXPECT_NE(std::string::npos, errorOf([&] { read(); }).find(" crashed (signal 11): it printed no message"));
  }
  const XacroStandIn xacro("echo nothing to do >&2");
  EXPECT_NE(std::string::npos, errorOf([&] { read(); }).find(" printed nothing: nothing to do"));
}

TEST_F(XacroFile, WarningsOfXacroAreInTheLineThatTheUserGets)
{
  const XacroStandIn xacro(std::string("echo 'warning: deprecated' >&2; ") + kExpandingXacro);
  read();
  ASSERT_EQ(1u, info_.size());
  EXPECT_NE(std::string::npos, info_[0].find(", which says: warning: deprecated")) << info_[0];
}

TEST_F(XacroFile, IsGivenBackAsItIsWithoutXacro)
{
  const PathVariable path(folder_.path("none") + ":relative:");
  const DescriptionText description = read();
  EXPECT_EQ(path_, description.name);
  EXPECT_EQ(kRobot, description.text);
  EXPECT_TRUE(info_.empty());
}

TEST_F(XacroFile, AProgramInARelativeFolderOfPathIsNotRun)
{
  const XacroStandIn xacro(kExpandingXacro);
  const auto folder = std::filesystem::path(xacro.program()).parent_path();
  const PathVariable path(std::filesystem::relative(folder).string() + "::");
  EXPECT_EQ(path_, read().name);
}

TEST_F(XacroFile, AnExpandedFileIsNotGivenToXacro)
{
  const XacroStandIn xacro("exit 1");
  path_ = folder_.write("r.xacro", "<robot name='r'><link name='a'/><xacro:property name='x' value='2'/></robot>");
  EXPECT_EQ(path_, read().name);
  path_ = folder_.write("r.urdf", "this is no XML ${x}");
  EXPECT_EQ(path_, read().name);
}
}  // namespace
}  // namespace gpu_planning_scene::core
