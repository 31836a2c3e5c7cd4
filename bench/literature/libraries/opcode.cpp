#include "literature/libraries/opcode.h"

#include <ode/ode.h>

#include "gpu_planning_scene/error.h"

// P. Terdiman's OPCODE (2001), trees of axis-aligned boxes in float, as part of the Open Dynamics Engine. Domain: any
// mesh, surfaces only. The use is that of the comments of ode/collision_trimesh.h and ode/collision.h: a dTriMeshData
// for each mesh, dCollide for each pose, and the flag CONTACTS_UNIMPORTANT, which skips the refinement of contacts.
namespace gpu_planning_scene::core::literature
{
namespace
{
/// Initialises ODE once in a process and once in each thread, as ode/odeinit.h asks.
void initialiseOde()
{
  static const bool process = dInitODE2(0) != 0;
  thread_local const bool done = process && dAllocateODEDataForThread(dAllocateFlagCollisionData) != 0;
  if (!done)
    throw Error("the Open Dynamics Engine cannot be initialised");
  if (dCheckConfiguration("ODE_EXT_opcode") == 0)
    throw Error("this build of the Open Dynamics Engine has no OPCODE; install Debian's libode-dev");
}

/// A mesh as a geometry of ODE. It owns the arrays, which ODE only refers to.
class OdeMesh
{
 public:
  explicit OdeMesh(const Mesh& mesh)
  {
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      for (int axis = 0; axis < 3; ++axis)
        coordinates_.push_back(static_cast<float>(vertex[axis]));
    for (const auto& t : mesh.triangles)
      indices_.insert(indices_.end(), t.begin(), t.end());
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data_, coordinates_.data(), 3 * sizeof(float), static_cast<int>(mesh.vertices.size()),
                                indices_.data(), static_cast<int>(indices_.size()), 3 * sizeof(dTriIndex));
    geometry_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
  }
  ~OdeMesh()
  {
    dGeomDestroy(geometry_);
    dGeomTriMeshDataDestroy(data_);
  }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;

  void place(const Eigen::Isometry3d& pose)
  {
    dMatrix3 rotation;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 4; ++k)
        rotation[4 * i + k] = k < 3 ? pose.linear()(i, k) : 0.0;
    dGeomSetRotation(geometry_, rotation);
    dGeomSetPosition(geometry_, pose.translation().x(), pose.translation().y(), pose.translation().z());
  }
  dGeomID geometry() const { return geometry_; }

 private:
  std::vector<float> coordinates_;
  std::vector<dTriIndex> indices_;
  dTriMeshDataID data_;
  dGeomID geometry_;
};

class Opcode : public PosewiseMethod
{
 public:
  Opcode(const Mesh& a, const Mesh& b) : a_(a), b_(b) { a_.place(Eigen::Isometry3d::Identity()); }

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override
  {
    b_.place(b_in_a);
    dContactGeom contact;
    const int flags = static_cast<int>(CONTACTS_UNIMPORTANT | 1U);
    return dCollide(a_.geometry(), b_.geometry(), flags, &contact, sizeof contact) > 0;
  }

  OdeMesh a_;
  OdeMesh b_;
};
}  // namespace

std::vector<MethodInfo> opcodeMethods()
{
  return {{"opcode",
           "OPCODE (ODE)",
           "Terdiman 2001; Open Dynamics Engine",
           "library",
           {},
           [](const auto& a, const auto& b)
           {
             initialiseOde();
             return std::make_unique<Opcode>(*a, *b);
           }}};
}
}  // namespace gpu_planning_scene::core::literature
