#include "base/text/parse_number.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
TEST(ParseNumber, ReadsDecimalNumbers)
{
  EXPECT_EQ(parseNumber("0"), 0.0);
  EXPECT_EQ(parseNumber("-.5"), -0.5);
  EXPECT_EQ(parseNumber("+1."), 1.0);
  EXPECT_EQ(parseNumber("00012"), 12.0);
  EXPECT_EQ(parseNumber("1E-5"), 1e-5);
  EXPECT_EQ(parseNumber("1e+5"), 1e5);
  EXPECT_EQ(parseNumber("0.1000000000000000055511151231257827"), 0.1);
}

TEST(ParseNumber, ReadsTheSmallestAndTheLargestDouble)
{
  EXPECT_EQ(parseNumber("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parseNumber("1e-320"), 1e-320);
  EXPECT_EQ(parseNumber("-1.7976931348623157e308"), std::numeric_limits<double>::lowest());
  EXPECT_EQ(parseNumber("0e-400"), 0.0);
}

TEST(ParseNumber, LeavesNanAndInfinityToTheCaller)
{
  EXPECT_EQ(parseNumber("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parseNumber("-Infinity"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parseNumber("nan").value_or(0.0)));
}

TEST(ParseNumber, RefusesNumbersOutOfTheRangeOfDouble)
{
  for (const char* text : {"1e400", "-1e400", "1e-400", "-1e-400", "2.4e-324", "1e99999999999999999999"})
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
}

TEST(ParseNumber, RefusesTextsThatAreNoDecimalNumber)
{
  for (const char* text : {"",    "-",   "+",   ".",   "e5",   "1e",   "1e+",    "x",   "infi", "nan(", "++1",
                           "+-1", "-+1", "1,5", "1_0", "1.5f", "0x10", "-0x1p3", "0X1", "0b1",  "1.5.2"})
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
}

TEST(ParseNumber, RefusesBlanksAndNullCharacters)
{
  for (const char* text : {" 1", "1 ", "\t1", "\n1", "\v1", "\f1", "\r1", "- 1"})
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
  EXPECT_EQ(parseNumber(std::string_view("1\0", 2)), std::nullopt);
  EXPECT_EQ(parseNumber(std::string_view("1\0002", 3)), std::nullopt);
}

TEST(ParseNumber, ReadsNoFurtherThanTheText)
{
  EXPECT_EQ(parseNumber(std::string_view("12345").substr(0, 2)), 12.0);
}
}  // namespace
}  // namespace gpu_planning_scene::core
