#include <atomic>
#include <cmath>

#include <embree3/rtcore.h>

#include "gpu_planning_scene/error.h"
#include "literature/libraries/embree_library.h"
#include "literature/trees/triangle_overlap.h"

// Embree (Wald, Woop, Benthin, Johnson, Ernst, "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014):
// rtcCollide. Its manual page says: only scenes of user geometries, whose trees have float boxes; the caller's function
// gets pairs of primitives that may intersect, and tests the primitives itself (here by the triangle test of all trees
// of bench/literature/trees, in double). Both scenes have one frame, so b's boxes are computed and its tree is refitted
// for each pose: RTC_BUILD_QUALITY_REFIT in a dynamic scene of quality LOW, as the manual page of
// rtcSetGeometryBuildQuality says. rtcCollide cannot be stopped at the first hit; the function skips later triangle
// tests. Domain: any mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
float below(double value)
{
  return std::nextafter(static_cast<float>(value), -INFINITY);
}
float above(double value)
{
  return std::nextafter(static_cast<float>(value), INFINITY);
}

void boundsOf(const RTCBoundsFunctionArguments* arguments)
{
  const Triangle& t = (*static_cast<const std::vector<Triangle>*>(arguments->geometryUserPtr))[arguments->primID];
  const Eigen::Vector3d lower = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
  const Eigen::Vector3d upper = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = below(lower.x());
  bounds.lower_y = below(lower.y());
  bounds.lower_z = below(lower.z());
  bounds.upper_x = above(upper.x());
  bounds.upper_y = above(upper.y());
  bounds.upper_z = above(upper.z());
}

/// Triangles as the only geometry of a scene.
class Scene
{
 public:
  Scene(RTCDevice device, std::vector<Triangle> placed) : triangles(std::move(placed))
  {
    geometry_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(triangles.size()));
    rtcSetGeometryUserData(geometry_, &triangles);
    rtcSetGeometryBoundsFunction(geometry_, boundsOf, nullptr);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    rtcCommitGeometry(geometry_);
    scene_ = rtcNewScene(device);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  ~Scene()
  {
    rtcReleaseScene(scene_);
    rtcReleaseGeometry(geometry_);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void trianglesHaveMoved()
  {
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  RTCScene scene() const { return scene_; }

  std::vector<Triangle> triangles;

 private:
  RTCGeometry geometry_;
  RTCScene scene_;
};

struct Query
{
  const std::vector<Triangle>& a;
  const std::vector<Triangle>& b;
  std::atomic<bool> hit{false};
  std::atomic<std::size_t> triangle_tests{0};
};

/// Several threads may call this function.
void testTriangles(void* user, RTCCollision* pairs, unsigned count)
{
  auto& query = *static_cast<Query*>(user);
  for (unsigned i = 0; i < count && !query.hit; ++i)
  {
    ++query.triangle_tests;
    if (trianglesOverlap(query.a[pairs[i].primID0], query.b[pairs[i].primID1]))
      query.hit = true;
  }
}

struct Release
{
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};

class Embree : public PosewiseMethod
{
 public:
  /// One thread, as for the other methods on the CPU.
  Embree(const Mesh& a, const Mesh& b)
    : device_(rtcNewDevice("threads=1")),
      still_(trianglesOf(b)),
      a_(device_.get(), trianglesOf(a)),
      b_(device_.get(), still_)
  {
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
      throw Error("Embree cannot build its trees");
  }

  WorkCounts work() const override { return {{"triangle tests", triangle_tests_}}; }

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override
  {
    for (std::size_t i = 0; i < still_.size(); ++i)
      b_.triangles[i] = moved(still_[i], b_in_a.linear(), b_in_a.translation());
    b_.trianglesHaveMoved();
    Query query{a_.triangles, b_.triangles};
    rtcCollide(a_.scene(), b_.scene(), testTriangles, &query);
    triangle_tests_ += static_cast<double>(query.triangle_tests);
    return query.hit;
  }

  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
  std::vector<Triangle> still_;  // b in its own frame
  Scene a_;
  Scene b_;
  double triangle_tests_ = 0.0;
};
}  // namespace

}  // namespace gpu_planning_scene::core::literature

gpu_planning_scene::core::literature::Method* gpsMakeEmbree(const gpu_planning_scene::core::Mesh& a,
                                                            const gpu_planning_scene::core::Mesh& b)
{
  return std::make_unique<gpu_planning_scene::core::literature::Embree>(a, b).release();
}
