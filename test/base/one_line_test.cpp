#include <gtest/gtest.h>

#include "base/text/one_line.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(OneLine, ACommonMessageStaysAsItIs)
{
  EXPECT_EQ(shortLine(""), "");
  for (const std::string text : {"busy", "there is no group 'legs'; there are: arm, hand ", " a  b "})
    EXPECT_EQ(shortLine(text), text);
}

TEST(OneLine, LongNamesAreShortenedInTheMiddle)
{
  // NOLINTNEXTLINE(bugprone-string-constructor): so long on purpose
  const std::string name = "first" + std::string(20000000, 'x') + "last";
  const std::string text = shortLine("there is no group '" + name + "'; there are: arm, hand");
  EXPECT_LT(text.size(), 500u);
  EXPECT_EQ(text.find("there is no group 'firstxxx"), 0u) << text;
  EXPECT_NE(text.find("xxxlast'; there are: arm, hand"), std::string::npos) << text;
  EXPECT_NE(text.find("[... 19999713 bytes ...]"), std::string::npos) << text;
}

TEST(OneLine, ALongListIsShortenedToItsBeginningAndEnd)
{
  std::string list;
  for (int i = 0; i < 100000; ++i)
    list += "joint_" + std::to_string(i) + ", ";
  const std::string text = shortLine(list);
  EXPECT_LT(text.size(), 2100u);
  EXPECT_EQ(text.find("joint_0, joint_1, "), 0u);
  EXPECT_NE(text.find("joint_99999, "), std::string::npos);
}

TEST(OneLine, NoCharacterIsCutIntoPieces)
{
  for (const char* start : {"", "a"})
  {
    std::string name = start;
    for (int i = 0; i < 1000; ++i)
      name += "\u00e9";
    const std::string text = shortLine(name);
    const std::size_t cut = text.find("[...");
    ASSERT_NE(cut, std::string::npos);
    EXPECT_EQ(text.substr(cut - 2, 2), "\u00e9");
    EXPECT_EQ(text.substr(text.find("...]") + 4, 2), "\u00e9");
  }
}

TEST(OneLine, ItIsOneLine)
{
  EXPECT_EQ(shortLine("group 'a\nb\x1b'"), "group 'a b '");
}
}  // namespace
}  // namespace gpu_planning_scene::core
