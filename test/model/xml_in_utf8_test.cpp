// Descriptions in ISO-8859-1, declared or not.

#include <gtest/gtest.h>

#include "base/text/utf8.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(XmlInUtf8, IsTheTextItselfIfItIsUtf8)
{
  for (const std::string text : {"", "plain", "gr\xC3\xBC\xC3\x9F", "\xEF\xBB\xBF<a/>", "\xE2\x82\xAC \xF0\x9F\xA4\x96",
                                 "<?xml version='1.0' encoding='ISO-8859-1'?><a/>"})
    EXPECT_EQ(text, xmlInUtf8(text));
}

TEST(XmlInUtf8, IsMadeOfIso88591)
{
  EXPECT_EQ("m\xC3\xBCll \xC3\xA9", xmlInUtf8("m\xFCll \xE9"));
  EXPECT_EQ("<?xml version='1.0' encoding='UTF-8'?><!-- \xC3\xA9 -->",
            xmlInUtf8("<?xml version='1.0' encoding='ISO-8859-1'?><!-- \xE9 -->"));
  EXPECT_EQ("<?xml encoding=\"UTF-8\" ?>\xC3\xA9", xmlInUtf8("<?xml encoding=\"latin1\" ?>\xE9"));
  EXPECT_EQ("<?xml version=\"1.0\"?>\xC3\xA9 encoding='x'", xmlInUtf8("<?xml version=\"1.0\"?>\xE9 encoding='x'"));
}

TEST(XmlInUtf8, IsMadeOfBytesThatAreNoCharacterOfUtf8)
{
  // Incomplete, overlong, a surrogate, and beyond the last code point (RFC 3629). Each byte becomes two.
  for (const std::string text :
       {"\xC3", "\xE2\x82", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80"})
    EXPECT_EQ(2 * text.size(), xmlInUtf8(text).size()) << testing::PrintToString(text);
}

TEST(XmlInUtf8, NamesOfARobotInIso88591AreUtf8)
{
  const TemporaryFolder folder;
  for (const std::string declaration : {"", "<?xml version='1.0' encoding='ISO-8859-1'?>"})
  {
    const std::string urdf = folder.write("r.urdf", declaration + "<robot name='r'><link name='t\xEAte'/></robot>");
    const std::string srdf = folder.write(
        "r.srdf", declaration + "<robot name='r'><passive_joint name='\xE9'/><group name='\xE0'/></robot>");
    std::vector<std::string> warnings;
    const auto robot = RobotModel::fromFiles(urdf, srdf, {}, &warnings);
    EXPECT_EQ("t\xC3\xAAte", robot->links()[0].name);
    EXPECT_EQ("\xC3\xA0", robot->groups().at(0).name);
    EXPECT_NE(std::string::npos, warnings.at(0).find("passive joint '\xC3\xA9'")) << warnings[0];
  }
  EXPECT_EQ("t\xC3\xAAte",
            RobotModel::fromXml("<robot name='r'><link name='t\xEAte'/></robot>", "", {})->links()[0].name);
}
}  // namespace
}  // namespace gpu_planning_scene::core
