#include "model/mesh_files.h"

#include <cstring>
#include <sstream>

namespace gpu_planning_scene::core
{
namespace
{
template <typename Value>
void append(std::string& bytes, Value value)
{
  char buffer[sizeof value];
  std::memcpy(buffer, &value, sizeof value);
  bytes.append(buffer, sizeof value);
}
}  // namespace

std::string asciiStl(const Mesh& mesh)
{
  std::ostringstream text;
  text << "solid part\n";
  for (const auto& triangle : mesh.triangles)
  {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t vertex : triangle)
      text << "vertex " << mesh.vertices[vertex].transpose() << "\n";
    text << "endloop\nendfacet\n";
  }
  text << "endsolid part\n";
  return text.str();
}

std::string binaryStl(const Mesh& mesh, const std::string& header)
{
  std::string bytes = header;
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
  {
    bytes.append(12, '\0');  // the normal
    for (const std::uint32_t vertex : triangle)
      for (const double coordinate : mesh.vertices[vertex])
        append(bytes, static_cast<float>(coordinate));
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string objText(const Mesh& mesh)
{
  std::ostringstream text;
  for (const auto& vertex : mesh.vertices)
    text << "v " << vertex.transpose() << "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  return text.str();
}

std::string plyText(const Mesh& mesh)
{
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& vertex : mesh.vertices)
    text << vertex.transpose() << "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text << "3 " << a << " " << b << " " << c << "\n";
  return text.str();
}

std::string daeText(const Mesh& mesh, const std::string& up_axis, double unit, const std::string& transforms)
{
  std::ostringstream text;
  text << R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")"
       << unit << "\"/><up_axis>" << up_axis << R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count=")"
       << 3 * mesh.vertices.size() << "\">";
  for (const auto& vertex : mesh.vertices)
    text << vertex.transpose() << " ";
  text << R"(</float_array><technique_common><accessor source="#a" stride="3" count=")" << mesh.vertices.size() << R"(">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")"
       << mesh.triangles.size() << "\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>";
  for (const auto& [a, b, c] : mesh.triangles)
    text << a << " " << b << " " << c << " ";
  text << R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)"
       << transforms << R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  return text.str();
}
}  // namespace gpu_planning_scene::core
