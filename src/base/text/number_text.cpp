#include "base/text/number_text.h"

#include <limits>
#include <locale>
#include <sstream>

namespace gpu_planning_scene::core
{
std::string exactText(double value)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  text << std::scientific << value;
  return text.str();
}

std::string numberText(double value)
{
  constexpr int kDigits = 9;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(kDigits);
  text << value;
  return text.str();
}
}  // namespace gpu_planning_scene::core
