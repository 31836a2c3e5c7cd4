#include <cstdlib>
#include <locale>
#include <string>

#include <gtest/gtest.h>

#include "base/text/number_text.h"

namespace gpu_planning_scene::core
{
namespace
{
class DecimalComma : public std::numpunct<char>
{
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\\3"; }
};

TEST(ExactText, IsReadBackAsTheSameNumberWhateverTheLocale)
{
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(exactText(0.25), "2.50000000000000000e-01");
  for (const double value : {0.1, -1.0 / 3.0, 12345678.9, 5e-324, 1.7976931348623157e308})
    EXPECT_EQ(std::strtod(exactText(value).c_str(), nullptr), value);
  std::locale::global(before);
}
}  // namespace
}  // namespace gpu_planning_scene::core
