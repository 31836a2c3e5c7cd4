#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/mesh_reader.h"
#include "gpu_planning_scene/resources.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// One number of a robot state: radians, metres, or a quaternion's component.
/// Named as in MoveIt: the joint's name where the joint has one variable; JOINT/x, /y, /theta for a planar joint;
/// JOINT/trans_x, _y, _z and JOINT/rot_x, _y, _z, _w for a floating one.
struct Variable
{
  std::string name;
  bool bounded = false;  ///< has limits in the URDF
  double lower = 0.0;    ///< the limits, or the range for random states of an unbounded variable
  double upper = 0.0;    ///< (see RobotModelOptions)
  /// The largest magnitude that a state may have here: for translations, what moves no joint by more than
  /// kLargestLength; for angles and quaternions any finite number.
  double largest = std::numeric_limits<double>::max();
};

enum class JointType
{
  Fixed,
  Revolute,
  Continuous,
  Prismatic,
  Planar,
  Floating
};

/// How many variables a joint of that type has (one that is not a mimic).
int variableCount(JointType type);

/// The directions in which a planar joint's x and y move and its normal, as columns (right-handed). Where the normal is
/// z they are x, y and z, as in MoveIt, which knows no other normal.
Eigen::Matrix3d planarDirections(const Eigen::Vector3d& normal);

struct Joint
{
  std::string name;
  JointType type = JointType::Fixed;
  int parent_link = -1;  ///< -1: the joint is the SRDF's virtual joint, its parent the planning frame
  int child_link = -1;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< the joint's frame in the parent link's
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit length; the normal of a planar joint
  int first_variable = -1;                                   ///< -1 for fixed joints; a mimic joint has its leader's
  double multiplier = 1.0;                                   ///< position = multiplier * variable + offset
  double offset = 0.0;
  bool mimic = false;
  bool passive = false;  ///< named by the SRDF's passive_joint
};

struct Link
{
  std::string name;
  int parent_joint = -1;            ///< -1 for the root link without a virtual joint
  std::vector<PlacedShape> shapes;  ///< the collision elements, in the link's frame
};

/// A planning group of the SRDF, resolved.
struct Group
{
  std::string name;
  std::vector<int> joints;       ///< in the order of RobotModel::joints, fixed and mimic ones included
  std::vector<int> variables;    ///< those that its active joints own, ascending
  std::vector<int> moved_links;  ///< every link that those variables move, ascending (MoveIt: updated links)
};

struct LinkPair
{
  int first;   ///< lower link index
  int second;  ///< higher link index
  std::string reason;
};

/// What the SRDF says of collisions; interpreted by AllowedCollisionMatrix.
struct SrdfCollisions
{
  bool has_srdf = false;
  std::vector<LinkPair> disabled;        ///< disable_collisions
  std::vector<LinkPair> enabled;         ///< enable_collisions
  std::vector<int> disabled_by_default;  ///< disable_default_collisions
};

struct RobotModelOptions
{
  PackageResolver packages;                              ///< may be empty where no URI needs it
  MeshAccess meshes;                                     ///< who reads mesh files, and from where
  std::string urdf_folder;                               ///< what relative mesh paths are relative to; may be empty
  std::string urdf_name = "robot_description";           ///< for messages: the file or parameter
  std::string srdf_name = "robot_description_semantic";  ///< for messages
  /// Random states of unbounded variables are drawn from these: angles (continuous, planar theta) from [-pi, pi],
  /// translations of planar and floating joints from [-unbounded_translation, +unbounded_translation], quaternions
  /// uniformly over rotations.
  double unbounded_translation = 1.0;
};

class Kinematics;

/// A robot: the kinematic tree of a URDF with its collision shapes, and what its SRDF adds. Immutable, thread-safe.
/// A *state* is a row of `variables().size()` doubles.
class RobotModel : public std::enable_shared_from_this<RobotModel>
{
 public:
  /// `urdf` and `srdf` are XML texts; an empty `srdf` means that there is none. `warnings` (may be null) receives a
  /// line for each thing that is odd but harmless (an SRDF entry that names an unknown link, say). Throws Error with
  /// name and line for malformed XML, missing meshes, unknown links or joints in groups.
  static std::shared_ptr<const RobotModel> fromXml(const std::string& urdf, const std::string& srdf,
                                                   const RobotModelOptions& options,
                                                   std::vector<std::string>* warnings = nullptr);
  /// The same from files; `srdf_path` may be empty. Sets urdf_folder, urdf_name and srdf_name.
  static std::shared_ptr<const RobotModel> fromFiles(const std::string& urdf_path, const std::string& srdf_path,
                                                     RobotModelOptions options,
                                                     std::vector<std::string>* warnings = nullptr);

  const std::string& name() const { return name_; }
  /// The frame that link poses are given in: the virtual joint's parent frame, or the root link's name.
  const std::string& planningFrame() const { return planning_frame_; }
  const std::vector<Link>& links() const { return links_; }     ///< parents before children; [0] is the root link
  const std::vector<Joint>& joints() const { return joints_; }  ///< parents before children
  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<Group>& groups() const { return groups_; }
  const SrdfCollisions& srdfCollisions() const { return srdf_collisions_; }

  int linkIndex(const std::string& name) const;       ///< -1 if there is none
  int jointIndex(const std::string& name) const;      ///< -1 if there is none
  int variableIndex(const std::string& name) const;   ///< -1 if there is none
  const Group& group(const std::string& name) const;  ///< throws Error that lists the groups there are

  /// Links that a joint joins directly (no shapes in between: links without collision shapes are stepped over, so
  /// that two bodies joined by an empty link count as adjacent). Pairs of links with shapes, sorted.
  std::vector<std::pair<int, int>> adjacentLinks() const;

  /// Forward kinematics: the pose of every link in the planning frame. `state` has variables().size() values, `poses`
  /// room for links().size(). A quaternion of a floating joint is normalised; one of zero length means no rotation.
  void linkPoses(const double* state, Eigen::Isometry3d* poses) const;

  /// A random state: variables uniform between lower and upper, floating rotations uniform over SO(3).
  void randomState(std::mt19937_64& generator, double* state) const;

  /// All variables 0, or the middle of their limits where 0 is outside; floating joints the unit quaternion.
  std::vector<double> defaultState() const;

  std::size_t triangleCount() const;  ///< of all meshes of all links, boxes and curved shapes not counted

  /// The robot as it was loaded, but with each link's shapes scaled about their own origins, and meshes, as in MoveIt,
  /// about the mean of their vertices. `factors`: one per link; empty: all 1. What a factor of 1 leaves as it was is
  /// shared. Throws Error for a wrong number of factors, or one that is not finite and above 0.
  std::shared_ptr<const RobotModel> scaled(const std::vector<double>& factors) const;
  /// The factors that it was scaled with; empty: all 1.
  const std::vector<double>& linkScale() const { return link_scale_; }

 private:
  friend class RobotModelBuilder;
  std::string name_;
  std::string planning_frame_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<Variable> variables_;
  std::vector<Group> groups_;
  SrdfCollisions srdf_collisions_;
  std::unordered_map<std::string, int> link_indices_;
  std::unordered_map<std::string, int> joint_indices_;
  std::unordered_map<std::string, int> variable_indices_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotModel> as_loaded_;  // null: this one
  std::vector<double> link_scale_;
};
}  // namespace gpu_planning_scene::core
