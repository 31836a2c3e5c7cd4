#include <iterator>

#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/files/open_file.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostBytes = std::size_t{512} << 20U;  // as MeshLimits::file

/// The next line of the header. A file of another kind may have no line breaks at all.
bool readLine(std::istream& file, std::string& line)
{
  line.clear();
  for (int next = file.get(); next != std::istream::traits_type::eof() && next != '\n'; next = file.get())
  {
    if (line.size() == kLongestLine)
      throw Error("the header of the octree has a line of more than " + std::to_string(kLongestLine) + " bytes");
    line.push_back(static_cast<char>(next));
  }
  return !file.eof();
}

/// The header: a line for the kind of the file, comments, then "id", "res", "size" with their values, and "data".
SerializedOctree readOctreeStream(std::istream& file)
{
  SerializedOctree octree;
  std::string line;
  readLine(file, line);
  if (line != "# Octomap OcTree binary file" && line != "# Octomap OcTree file")
    throw Error(
        "it is not a .bt or .ot file of liboctomap: its first line must be '# Octomap OcTree binary file' or "
        "'# Octomap OcTree file'");
  octree.binary = line == "# Octomap OcTree binary file";
  octree.id.clear();
  bool has_more = readLine(file, line);
  for (; has_more && line != "data"; has_more = readLine(file, line))
  {
    const std::size_t space = line.find(' ');
    const std::string value = space == std::string::npos ? "" : line.substr(space + 1);
    if (line.compare(0, space, "id") == 0)
      octree.id = value;
    else if (line.compare(0, space, "res") == 0)
      octree.resolution = parseNumber(value).value_or(0.0);
  }
  if (!has_more || octree.id.empty() || octree.resolution == 0.0)
    throw Error("the header of the octree has no line 'id CLASS', 'res METRES' or 'data'");
  // The length is checked while the file is read, because a pipe has none.
  for (std::istreambuf_iterator<char> at(file), end; at != end; ++at)
  {
    if (octree.bytes.size() == kMostBytes)
      throw Error("the octree has more than " + std::to_string(kMostBytes) + " bytes");
    octree.bytes.push_back(static_cast<std::int8_t>(*at));
  }
  return octree;
}
}  // namespace

SerializedOctree loadOctreeFile(const std::string& path)
{
  std::ifstream file = openFile(path);
  try
  {
    return readOctreeStream(file);
  }
  catch (const Error& error)
  {
    throw Error(path + ": " + error.what());
  }
}
}  // namespace gpu_planning_scene::core
