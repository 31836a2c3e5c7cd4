#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "gpu_planning_scene/error.h"
#include "model/meshes/collada_document.h"
#include "model/meshes/collada_geometry.h"
#include "model/meshes/collada_transform.h"
#include "model/meshes/mesh_formats.h"
#include "model/meshes/words.h"

// M. Barnes, E. Levy Finch (editors): COLLADA - Digital Asset Schema Release 1.4.1, Khronos 2008. It is read here,
// because Assimp rounds numbers to float, reads long ones as 0, fills notches and holes of polygons, ends the process
// at a <skew>, and mistakes the axes of a <lookat>.
namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;

// Elements of a node or a scene that hold no mesh.
constexpr std::array<std::string_view, 5> kWithoutMesh = {
    {"asset", "evaluate_scene", "extra", "instance_camera", "instance_light"}};

/// Metres of a unit of length.
double unitOf(const XMLElement& asset)
{
  const XMLElement* unit = asset.FirstChildElement("unit");
  const char* metres = unit == nullptr ? nullptr : unit->Attribute("meter");
  if (metres == nullptr)
    return 1.0;
  const double value = numberFrom(metres, static_cast<std::size_t>(unit->GetLineNum()));
  if (!(value > 0.0))
    failAt(*unit, "a unit of " + inQuotes(metres) + " metres is not above 0");
  return value;
}

/// Collects the geometries of a scene graph with the poses of their nodes.
class SceneReader
{
 public:
  SceneReader(const ColladaDocument& document, MeshBuilder& mesh)
    : document_(document), geometries_(document), mesh_(mesh)
  {
    const XMLElement* asset = document.root().FirstChildElement("asset");
    unit_ = asset == nullptr ? 1.0 : unitOf(*asset);
    requireOneUnit(document.root());
  }

  void read() { readChildren(scene(), Eigen::Affine3d(Eigen::Scaling(unit_))); }

 private:
  /// An <asset> inside an element can give it another unit.
  void requireOneUnit(const XMLElement& element) const
  {
    forEachChild(
        element,
        [&](const XMLElement& child)
        {
          if (std::string_view(child.Name()) != "asset")
            requireOneUnit(child);
          else if (child.FirstChildElement("unit") != nullptr && unitOf(child) != unit_)
            failAt(child, "it has another unit than the file; export the file with one unit");
        });
  }

  /// A file without <scene> may have several scenes, of which none counts more than the others.
  const XMLElement& scene() const
  {
    if (const XMLElement* scene = document_.root().FirstChildElement("scene"))
      return document_.target(onlyChild(*scene, "instance_visual_scene"), "url", "visual_scene");
    return onlyChild(onlyChild(document_.root(), "library_visual_scenes"), "visual_scene");
  }

  void readNode(const XMLElement& node, const Eigen::Affine3d& parent)
  {
    if (std::find(path_.begin(), path_.end(), &node) != path_.end())
      failAt(node, "it contains itself");
    path_.push_back(&node);
    Eigen::Affine3d pose = parent;
    forEachChild(node,
                 [&](const XMLElement& child)
                 {
                   if (isColladaTransform(child))
                     pose = pose * colladaTransform(child);
                 });
    readChildren(node, pose);
    path_.pop_back();
  }

  void readChildren(const XMLElement& element, const Eigen::Affine3d& pose)
  {
    forEachChild(
        element,
        [&](const XMLElement& child)
        {
          const std::string_view name = child.Name();
          if (name == "node")
            readNode(child, pose);
          else if (name == "instance_node")
            readNode(document_.target(child, "url", "node"), pose);
          else if (name == "instance_geometry")
            readGeometry(child, pose);
          else if (name == "instance_controller")
            failAt(child, "a mesh that a skeleton deforms cannot be read; export the model without it");
          else if (!isColladaTransform(child) &&
                   std::find(kWithoutMesh.begin(), kWithoutMesh.end(), name) == kWithoutMesh.end())
            failAt(child, "unknown element <" + std::string(name) + ">: it may hold a mesh, which would be lost");
        });
  }

  void readGeometry(const XMLElement& instance, const Eigen::Affine3d& pose)
  {
    mesh_.setPose(pose);
    geometries_.add(document_.target(instance, "url", "geometry"), mesh_);
  }

  const ColladaDocument& document_;
  ColladaGeometries geometries_;
  MeshBuilder& mesh_;
  double unit_;
  std::vector<const XMLElement*> path_;  // from the scene to the node that is read
};
}  // namespace

void readCollada(std::string_view content, MeshBuilder& mesh)
{
  const ColladaDocument document(content);
  SceneReader(document, mesh).read();
}
}  // namespace gpu_planning_scene::core
