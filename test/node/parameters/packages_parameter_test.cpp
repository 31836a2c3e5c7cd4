// The parameter ~packages. No ROS master is needed.

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/parameters/node_parameters.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(PackagesParameter, IsAMapOrAList)
{
  const std::map<std::string, std::string> expected = {{"arm", "/opt/arm"}, {"hand", "/opt/hand"}};
  XmlRpc::XmlRpcValue map;
  map["arm"] = "/opt/arm";
  map["hand"] = "/opt/hand";
  EXPECT_EQ(expected, packageFolders(map));
  XmlRpc::XmlRpcValue list;
  list[0] = "arm=/opt/arm";
  list[1] = "hand: /opt/hand";
  EXPECT_EQ(expected, packageFolders(list));
  XmlRpc::XmlRpcValue list_of_maps;
  list_of_maps[0]["arm"] = "/opt/arm";
  list_of_maps[1]["hand"] = "/opt/hand";
  EXPECT_EQ(expected, packageFolders(list_of_maps));
}

TEST(PackagesParameter, AnythingElseIsRefused)
{
  XmlRpc::XmlRpcValue number(5);
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(number); }).find("~packages"));
  XmlRpc::XmlRpcValue text("arm");
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(text); }).find("'arm' is not NAME=DIR"));
  XmlRpc::XmlRpcValue map;
  map["arm"] = 5;
  EXPECT_NE(std::string::npos, errorOf([&] { packageFolders(map); }).find("'arm' is not a string"));
  map["arm"] = "robots/arm";
  EXPECT_NE(std::string::npos,
            errorOf([&] { packageFolders(map); }).find("'robots/arm' of package 'arm' is not an absolute path"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
