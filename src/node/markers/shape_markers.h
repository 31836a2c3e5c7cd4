#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <visualization_msgs/MarkerArray.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/solids.h"
#include "render/drawing.h"

namespace gpu_planning_scene::core
{
void setScale(visualization_msgs::Marker& marker, const Eigen::Vector3d& scale);

/// The number of triangles that draw a shape; 0 if RViz has a marker for the shape.
std::size_t trianglesOf(const Shape& shape);

/// An array of markers for RViz to which bodies are added. The first marker deletes all earlier markers.
class ShapeMarkers
{
 public:
  /// `surroundings`: the region, in the planning frame, in which planes are drawn.
  ShapeMarkers(const std_msgs::Header& header, const Eigen::AlignedBox3d& surroundings)
    : header_(header), surroundings_(surroundings)
  {
    array_.markers.emplace_back();
    array_.markers.back().header = header_;
    array_.markers.back().action = visualization_msgs::Marker::DELETEALL;
  }

  /// If all shapes together have more triangles, the largest are drawn as boxes. `shapes`: the triangle counts of the
  /// shapes that follow.
  void limitTriangles(std::size_t max_triangles, std::vector<std::size_t> shapes);

  /// The next markers belong to another body. `name`: their namespace.
  void begin(const std::string& name, const BodyColor& color) { begin(name, color, color); }

  /// `open`: the colour of triangles that bound no solid.
  void begin(const std::string& name, const BodyColor& color, const BodyColor& open);

  /// Adds a shape of the body. `pose`: in the planning frame.
  void addShape(const Shape& shape, const Eigen::Isometry3d& pose);

  /// Adds a marker with the body's namespace and colour. It is valid until the next call.
  visualization_msgs::Marker& add(int type, const Eigen::Isometry3d& pose);

  std::size_t trianglesDrawn() const { return drawn_; }

  /// The number of markers so far, with the one that deletes.
  std::size_t size() const { return array_.markers.size(); }

  visualization_msgs::MarkerArray take() { return std::move(array_); }

 private:
  void addToList(int type, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose);
  void addMesh(const Mesh& mesh, const Eigen::Isometry3d& pose);
  void addTriangles(const Mesh& mesh, const Eigen::Isometry3d& pose);
  void colorOpenTriangles(const SolidMesh& solid);
  void addPlane(const HalfSpace& plane, const Eigen::Isometry3d& pose);

  const std_msgs::Header header_;
  const Eigen::AlignedBox3d surroundings_;
  visualization_msgs::MarkerArray array_;
  std::size_t max_triangles_ = 0;
  std::size_t largest_drawn_ = 0;  // shapes with more triangles are drawn as boxes
  std::size_t drawn_ = 0;          // triangles so far
  std::map<std::string, int> next_id_;
  std::map<std::array<double, 13>, std::size_t> lists_;  // list markers of the body, by type, size and rotation
  std::string name_;
  BodyColor color_{};
  BodyColor open_color_{};
};
}  // namespace gpu_planning_scene::core
