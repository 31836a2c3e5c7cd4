#include "scene/files/scene_text_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>

#include "base/text/utf8.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/files/open_file.h"
#include "scene/files/text_tokens.h"
#include "scene/message_values.h"
#include "scene/shape_order.h"

namespace gpu_planning_scene::core
{
namespace
{
const char* const kOtherFormats =
    "; a file whose name ends in .scene has the text format of RViz's MotionPlanning plugin, without comments; give a "
    "YAML file another ending";

class SceneTextReader
{
 public:
  SceneTextReader(const std::string& text, const std::string& file, PlanningScene& scene, double object_padding)
    : tokens_(text, file), scene_(scene), object_padding_(object_padding)
  {
  }

  void read()
  {
    scene_.name = tokens_.restOfLine();
    for (;;)
    {
      // Any text may be the name in the first line. So the line after it shows whether this is the format at all.
      const std::string where = scene_.objects.empty() ? " after the scene's name in the first line" : "";
      const std::string expected = "'*' (an object) or '.' (the end)" + where;
      const std::string marker = tokens_.word(expected.c_str());
      if (marker == ".")
        return;
      if (marker != "*")
        tokens_.fail("expected " + expected + ", found '" + marker.substr(0, 40) + "'" +
                     (where.empty() ? "" : kOtherFormats));
      scene_.objects.push_back(readObject());
    }
  }

 private:
  /// In all files, an object begins with its name. If a line of several words follows, that line is its pose.
  WorldObject readObject()
  {
    WorldObject object;
    object.padding = object_padding_;
    object.id = tokens_.restOfLine();
    if (object.id.empty())
      tokens_.fail("the object has no name");
    if (!ids_.insert(object.id).second)
      tokens_.fail("object '" + object.id + "' is given twice");
    if (object.id == kOctomapId)
      tokens_.fail("the name '" + object.id + "' is kept for the octomap, which this format does not have");
    if (scene_.robot->linkIndex(object.id) >= 0)
      tokens_.fail("object '" + object.id + "' has the name of a link");
    if (tokens_.nextLineHasSeveralWords())
      object.pose = tokens_.pose();
    const std::size_t shapes = tokens_.count("the number of shapes");
    if (shapes == 0)
      tokens_.fail("object '" + object.id + "' has no shapes");
    for (std::size_t i = 0; i < shapes; ++i)
      readShape(object);
    orderShapes(object.shapes);
    if (const std::string_view next = tokens_.peek(); next != "*" && next != ".")
      readSubframes(object);
    return object;
  }

  void readShape(WorldObject& object)
  {
    const Shape shape = readGeometry(object.id);
    object.shapes.push_back({shape, tokens_.pose()});
    std::array<float, 4> color{};
    for (float& component : color)
    {
      const double value = tokens_.number("a color (r g b a)");
      if (value < 0.0 || value > 1.0)
        tokens_.fail("a color's components must be from 0 to 1");
      component = static_cast<float>(value);
    }
    if (std::any_of(color.begin(), color.end(), [](float component) { return component > 0.0F; }))
      scene_.colors[object.id] = {color[0], color[1], color[2], color[3]};
  }

  Shape readGeometry(const std::string& id)
  {
    const std::string kind = tokens_.word("a shape");
    Shape shape = readKind(kind, id);
    try
    {
      validateShape(shape, "object '" + id + "'");
    }
    catch (const Error& error)
    {
      tokens_.fail(error.what());
    }
    return shape;
  }

  Shape readKind(const std::string& kind, const std::string& id)
  {
    if (kind == "box")
      return Box{tokens_.vector("a box's sizes (x y z)")};
    if (kind == "sphere")
      return Sphere{tokens_.number("a sphere's radius")};
    if (kind == "mesh")
      return readMesh(id);
    if (kind == "plane")
      return readPlane();
    if (kind != "cylinder" && kind != "cone")
      tokens_.fail("unknown shape '" + kind.substr(0, 40) + "'; known are box, sphere, cylinder, cone, plane and mesh");
    const double radius = tokens_.number("a radius");
    const double length = tokens_.number("a length");
    return kind == "cone" ? Shape(Cone{radius, length}) : Shape(Cylinder{radius, length});
  }

  HalfSpace readPlane()
  {
    Eigen::Vector4d plane;
    for (int i = 0; i < 4; ++i)
      plane[i] = tokens_.number("a plane (a b c d)");
    try
    {
      return halfSpaceBehind(plane);
    }
    catch (const Error& error)
    {
      tokens_.fail(error.what());
    }
  }

  std::shared_ptr<const Mesh> readMesh(const std::string& id)
  {
    auto mesh = std::make_shared<Mesh>();
    mesh->name = id;
    mesh->vertices.resize(tokens_.count("the number of vertices"));
    mesh->triangles.resize(tokens_.count("the number of triangles"));
    for (Eigen::Vector3d& vertex : mesh->vertices)
      vertex = tokens_.vector("a vertex (x y z)");
    for (std::array<std::uint32_t, 3>& triangle : mesh->triangles)
      for (std::uint32_t& corner : triangle)
      {
        const std::size_t index = tokens_.index("a triangle's vertex");
        if (index >= mesh->vertices.size())
          tokens_.fail("vertex " + std::to_string(index) + " is out of range; the mesh has " +
                       std::to_string(mesh->vertices.size()) + " vertices");
        corner = static_cast<std::uint32_t>(index);
      }
    return mesh;
  }

  void readSubframes(WorldObject& object)
  {
    const std::size_t subframes = tokens_.count("the number of subframes");
    for (std::size_t i = 0; i < subframes; ++i)
    {
      const std::string name = tokens_.word("a subframe's name");
      if (!object.subframes.emplace(name, tokens_.pose()).second)
        tokens_.fail("subframe '" + name.substr(0, 40) + "' is given twice");
    }
  }

  TextTokens tokens_;
  PlanningScene& scene_;
  const double object_padding_;
  std::set<std::string> ids_;
};
}  // namespace

PlanningScene readSceneText(const std::string& text, const std::string& file, std::shared_ptr<const RobotModel> robot,
                            const SceneDefaults& defaults)
{
  if (text.find_first_not_of(" \t\r\n\v\f") == std::string::npos)
    throw Error(file + ": the file is empty; the shortest scene is a line with a name and a line with '.'");
  PlanningScene scene(std::move(robot), defaults);
  const std::string in_utf8 = inUtf8(text);
  SceneTextReader(in_utf8, file, scene, defaults.object_padding).read();
  return scene;
}

PlanningScene loadSceneTextFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                                const SceneDefaults& defaults)
{
  std::ifstream file = openFile(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return readSceneText(text, path, std::move(robot), defaults);
}
}  // namespace gpu_planning_scene::core
