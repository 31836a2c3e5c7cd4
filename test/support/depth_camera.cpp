#include "support/depth_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/problem/checked_pairs.h"

// A z-buffer: triangles are clipped at the near plane, and each pixel gets the depth of the triangle's plane.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearPlane = 0.01;  // metres

using Polygon = std::vector<Vector3d>;

/// The part of a triangle behind the near plane (I. E. Sutherland, G. W. Hodgman: Reentrant polygon clipping.
/// Communications of the ACM, 1974).
Polygon behindNearPlane(const std::array<Vector3d, 3>& triangle)
{
  Polygon clipped;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vector3d& a = triangle[i];
    const Vector3d& b = triangle[(i + 1) % 3];
    if (a.z() >= kNearPlane)
      clipped.push_back(a);
    if ((a.z() >= kNearPlane) != (b.z() >= kNearPlane))
      clipped.push_back(a + (kNearPlane - a.z()) / (b.z() - a.z()) * (b - a));
  }
  return clipped;
}

double cross(const Vector2d& a, const Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

class DepthBuffer
{
 public:
  DepthBuffer(const PinholeCamera& camera, const Isometry3d& camera_pose) : to_camera_(camera_pose.inverse())
  {
    image_.camera = camera;
    image_.depths.assign(camera.pixel(0, camera.height), std::numeric_limits<float>::infinity());
  }

  void draw(const std::vector<PlacedShape>& shapes, const Isometry3d& pose)
  {
    for (const PlacedShape& placed : shapes)
    {
      if (std::holds_alternative<HalfSpace>(placed.shape))
        continue;
      const Tessellation surface = tessellate(placed.shape);
      const Isometry3d place = to_camera_ * pose * placed.pose;
      for (const auto& corners : surface.mesh->triangles)
      {
        std::array<Vector3d, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i)
          triangle[i] = place * surface.mesh->vertices[static_cast<std::size_t>(corners[i])];
        drawTriangle(triangle);
      }
    }
  }

  DepthImage take() { return std::move(image_); }

 private:
  Vector2d pixelOf(const Vector3d& point) const
  {
    const PinholeCamera& camera = image_.camera;
    return {camera.cx + camera.fx * point.x() / point.z(), camera.cy + camera.fy * point.y() / point.z()};
  }

  void drawTriangle(const std::array<Vector3d, 3>& triangle)
  {
    const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const Polygon polygon = behindNearPlane(triangle);
    if (polygon.empty() || normal.norm() < 1e-16)
      return;
    const PinholeCamera& camera = image_.camera;
    std::vector<Vector2d> corners;
    Vector2d low = Vector2d::Constant(1e9);
    Vector2d high = -low;
    for (const Vector3d& corner : polygon)
    {
      corners.push_back(pixelOf(corner));
      low = low.cwiseMin(corners.back());
      high = high.cwiseMax(corners.back());
    }
    double area = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      area += cross(corners[i], corners[(i + 1) % corners.size()]);
    const double side = area < 0.0 ? -1.0 : 1.0;
    const auto from = [](double value, int size)
    { return static_cast<int>(std::clamp(std::ceil(value), 0.0, 1.0 * size)); };
    for (int y = from(low.y(), camera.height); y < from(std::floor(high.y()) + 1.0, camera.height); ++y)
      for (int x = from(low.x(), camera.width); x < from(std::floor(high.x()) + 1.0, camera.width); ++x)
      {
        const Vector2d pixel(x, y);
        bool inside = true;
        for (std::size_t i = 0; i < corners.size() && inside; ++i)
          inside = side * cross(corners[(i + 1) % corners.size()] - corners[i], pixel - corners[i]) >= 0.0;
        if (!inside)
          continue;
        const Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
        const double depth = normal.dot(triangle[0]) / normal.dot(ray);
        float& smallest = image_.depths[camera.pixel(x, y)];
        if (depth >= kNearPlane)
          smallest = std::min(smallest, static_cast<float>(depth));
      }
  }

  const Isometry3d to_camera_;
  DepthImage image_;
};
}  // namespace

DepthImage depthImageOf(const PlanningScene& scene, const double* state, const PinholeCamera& camera,
                        const Isometry3d& camera_pose)
{
  std::vector<Isometry3d> link_poses(scene.robot->links().size());
  scene.robot->linkPoses(state, link_poses.data());
  DepthBuffer buffer(camera, camera_pose);
  for (const RobotBody& body : robotBodies(scene))
    buffer.draw(*body.shapes, link_poses[static_cast<std::size_t>(body.link)] * body.pose);
  for (const WorldObject& object : scene.objects)
    buffer.draw(object.shapes, object.pose);
  return buffer.take();
}

WorldObject boxAt(const std::string& id, const Vector3d& centre, const Vector3d& size)
{
  return {id, Isometry3d(Eigen::Translation3d(centre)), {{Box{size}}}};
}

double distanceFromSurface(const WorldObject& box, const Vector3d& point)
{
  const Vector3d half = 0.5 * std::get<Box>(box.shapes.at(0).shape).size;
  const Vector3d beyond = (box.pose.inverse() * point).cwiseAbs() - half;
  return std::abs(beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0));
}

Vector3d pointOf(const DepthImage& image, int x, int y)
{
  const PinholeCamera& camera = image.camera;
  const double depth = static_cast<double>(image.depths[camera.pixel(x, y)]);
  return depth * Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
}

void addNoise(DepthImage& image, const DepthNoise& noise, std::mt19937_64& generator)
{
  std::normal_distribution<float> error(0.0F, static_cast<float>(noise.deviation));
  std::bernoulli_distribution drops(noise.dropouts);
  for (float& depth : image.depths)
    if (drops(generator))
      depth = std::numeric_limits<float>::quiet_NaN();
    else if (std::isfinite(depth))
      depth += error(generator) * depth * depth;
}

Isometry3d cameraPose(const Vector3d& eye, const Vector3d& target)
{
  const Vector3d forward = (target - eye).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.translation() = eye;
  return pose;
}
}  // namespace gpu_planning_scene::core
