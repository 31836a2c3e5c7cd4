#include "peers/vamp/vamp_pairs.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::benchmark
{
std::pair<std::string, std::string> linkPair(const std::string& a, const std::string& b)
{
  return {std::min(a, b), std::max(a, b)};
}

LinkPairs readVampPairs(const std::string& path)
{
  std::ifstream file(path);
  if (!file)
    throw Error("cannot read " + path + ", which has VAMP's pairs of links");
  LinkPairs pairs;
  bool in_check = false;
  for (std::string line; std::getline(file, line);)
  {
    if (line.find("static bool fkcc(") != std::string::npos)
      in_check = true;
    else if (line.find("static bool fkcc_attach(") != std::string::npos)
      break;
    std::istringstream words(line);
    std::string slashes;
    std::string first;
    std::string versus;
    std::string second;
    std::string more;
    if (in_check && words >> slashes >> first >> versus >> second && slashes == "//" && versus == "vs." &&
        !(words >> more))
      pairs.insert(linkPair(first, second));
  }
  if (pairs.empty())
    throw Error(path + ": the function fkcc has no comment `// LINK vs. LINK`, so VAMP's pairs of links are unknown");
  return pairs;
}
}  // namespace gpu_planning_scene::core::benchmark
