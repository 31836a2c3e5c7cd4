#include <algorithm>
#include <cctype>
#include <cstdint>

#include "gpu_planning_scene/error.h"
#include "model/meshes/byte_order.h"
#include "model/meshes/mesh_formats.h"
#include "model/meshes/words.h"

// The format of 3D Systems, Inc.: StereoLithography Interface Specification, 1988. Normals are left out, because the
// order of the vertices gives them.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;  // normal, three vertices, attribute
constexpr std::size_t kNormalBytes = 12;

/// Keywords are in lower case by the specification, but some programs write capitals.
bool is(std::string_view word, std::string_view keyword)
{
  return word.size() == keyword.size() && std::equal(
                                              word.begin(), word.end(), keyword.begin(),
                                              [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

std::size_t binarySize(std::string_view content)
{
  const std::size_t begin = kHeaderBytes + sizeof(std::uint32_t);
  return content.size() < begin ? begin
                                : begin + kFacetBytes * valueOf<std::uint32_t>(content.data() + kHeaderBytes, false);
}

void readBinary(std::string_view content, MeshBuilder& mesh)
{
  std::vector<Eigen::Vector3d> corners(3);
  for (std::size_t at = kHeaderBytes + sizeof(std::uint32_t); at < content.size(); at += kFacetBytes)
  {
    const char* value = content.data() + at + kNormalBytes;
    for (Eigen::Vector3d& corner : corners)
      for (int axis = 0; axis < 3; ++axis, value += sizeof(float))
        corner[axis] = static_cast<double>(valueOf<float>(value, false));
    mesh.addPolygon(corners);
  }
}

class AsciiStl
{
 public:
  AsciiStl(std::string_view text, MeshBuilder& mesh) : words_(text), mesh_(mesh) {}

  /// A file may have several solids.
  void read()
  {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next())
    {
      require(word, "solid");
      words_.skipLine();  // its name
      readFacets();
      words_.skipLine();  // its name
    }
  }

 private:
  void readFacets()
  {
    std::vector<Eigen::Vector3d> corners(3);
    for (std::string_view word = words_.next(); !is(word, "endsolid"); word = words_.next())
    {
      if (word.empty())
        failInLine(words_.line(), "the file ends before 'endsolid'");
      require(word, "facet");
      require("normal");
      for (int axis = 0; axis < 3; ++axis)
        words_.next();
      require("outer");
      require("loop");
      for (Eigen::Vector3d& corner : corners)
      {
        require("vertex");
        for (int axis = 0; axis < 3; ++axis)
        {
          const std::string_view word_of_number = words_.next();
          corner[axis] = numberFrom(word_of_number, words_.line());
        }
      }
      require("endloop");
      require("endfacet");
      mesh_.addPolygon(corners);
    }
  }

  void require(const char* keyword) { require(words_.next(), keyword); }

  void require(std::string_view word, const char* keyword)
  {
    if (!is(word, keyword))
      failInLine(words_.line(), "expected '" + std::string(keyword) + "', found " +
                                    (word.empty() ? "the end of the file" : inQuotes(word)));
  }

  Words words_;
  MeshBuilder& mesh_;
};
}  // namespace

void readStl(std::string_view content, MeshBuilder& mesh)
{
  // Some programs begin the header of a binary file with "solid" too, so the size decides.
  const std::size_t binary_size = binarySize(content);
  if (content.size() == binary_size)
    return readBinary(content, mesh);
  const bool has_zero_byte = content.substr(0, kHeaderBytes + sizeof(std::uint32_t)).find('\0') != content.npos;
  const std::string_view text = withoutByteOrderMark(content);
  if (is(Words(text).next(), "solid") && !has_zero_byte)
    return AsciiStl(text, mesh).read();
  throw Error("it is no ASCII STL, which begins with 'solid', and a binary STL with this header has " +
              std::to_string(binary_size) + " bytes, not " + std::to_string(content.size()));
}
}  // namespace gpu_planning_scene::core
