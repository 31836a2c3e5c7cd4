#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
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
/// One number of a robot state: radians, metres, or a component of a quaternion. The names are MoveIt's. The variable
/// of a joint with a single variable has the name of the joint. A planar joint has JOINT/x, /y, /theta; a floating
/// joint has JOINT/trans_x, _y, _z and JOINT/rot_x, _y, _z, _w.
struct Variable
{
  std::string name;
  bool bounded = false;  ///< it has limits
  double lower = 0.0;    ///< limits, or the range of random states of an unbounded variable
  double upper = 0.0;    ///< (see RobotModelOptions)
  /// The largest allowed magnitude of this number in a state. It keeps the coordinates of translations within
  /// kLargestLength, and the angles of revolute and continuous joints within 1e300. This includes the joints that mimic
  /// this one. For other numbers, it is the largest finite number.
  double largest = std::numeric_limits<double>::max();
  /// Source of the limits, for messages. Empty: the URDF's <limit>. Otherwise the URDF's <safety_controller>,
  /// JointLimits::source, or both.
  std::string limits_source = {};
  /// The largest speed (rad/s or m/s) and acceleration (rad/s^2 or m/s^2), above 0 and finite. The speed is that of the
  /// URDF's <limit>, unless joint_limits has another one. As in MoveIt, a speed of 0 in the URDF is no limit. No value:
  /// there is no limit. Only timePath uses them (planning/path_timing.h).
  std::optional<double> max_velocity = {};
  std::optional<double> max_acceleration = {};
};

/// Limits of a variable that replace those of the URDF: an entry of MoveIt's joint_limits. See readJointLimits in
/// planning_file.h.
struct JointLimits
{
  std::string variable;                     ///< as Variable::name
  std::optional<double> min_position = {};  ///< radians or metres; no value: the limit of the URDF stays
  std::optional<double> max_position = {};
  std::string source = "joint_limits";  ///< the file or parameter, for messages
  /// Above 0 and finite; no value: the limit of the URDF stays.
  std::optional<double> max_velocity = {};      ///< rad/s or m/s
  std::optional<double> max_acceleration = {};  ///< rad/s^2 or m/s^2
  bool drops_velocity_limit = false;            ///< has_velocity_limits is false: the URDF's limit does not count
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

/// Number of variables of a joint of this type. (Mimic joints have no variable of their own.)
int variableCount(JointType type);

/// The directions of a planar joint's x and y, and its normal, as the columns of a right-handed rotation. For the
/// normal z, the columns are the x, y and z axes. MoveIt supports only this normal.
Eigen::Matrix3d planarDirections(const Eigen::Vector3d& normal);

struct Joint
{
  std::string name;
  JointType type = JointType::Fixed;
  int parent_link = -1;  ///< -1: the SRDF's virtual joint, whose parent is the planning frame
  int child_link = -1;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< the joint's frame in the frame of the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit length; the normal of a planar joint
  int first_variable = -1;  ///< -1 for fixed joints; a mimic joint has the variable of its leader
  double multiplier = 1.0;  ///< of mimic joints: position = multiplier * variable + offset
  double offset = 0.0;
  bool mimic = false;
  bool passive = false;  ///< listed as a passive_joint of the SRDF
  /// A planar joint with the SRDF's property `motion_model` diff_drive: it turns, and drives along its heading.
  bool diff_drive = false;
};

struct Link
{
  std::string name;
  int parent_joint = -1;            ///< -1 for the root link without a virtual joint
  std::vector<PlacedShape> shapes;  ///< the collision elements, in the link's frame
};

/// A planning group of the SRDF, with its subgroups and chains resolved.
struct Group
{
  std::string name;
  std::vector<int> joints;       ///< in the order of RobotModel::joints, with fixed and mimic joints
  std::vector<int> variables;    ///< variables of its active joints, ascending
  std::vector<int> moved_links;  ///< links that these variables move, ascending (MoveIt: updated links)
};

/// A state that the SRDF names for a group (group_state): values of some variables of the group.
struct NamedState
{
  std::string name;
  std::string group;
  std::vector<int> variables;
  std::vector<double> values;  ///< one per variable
};

/// A pair of links that the SRDF names.
struct LinkPair
{
  int first;   ///< lower link index
  int second;  ///< higher link index
  std::string reason;
};

/// The collision entries of the SRDF. AllowedCollisionMatrix::fromRobot interprets them.
struct SrdfCollisions
{
  bool has_srdf = false;
  std::vector<LinkPair> disabled;        ///< disable_collisions
  std::vector<LinkPair> enabled;         ///< enable_collisions
  std::vector<int> disabled_by_default;  ///< disable_default_collisions
  /// disable_collisions with the reason Never that are checked, because limits are wider than those for which these
  /// pairs were found free.
  std::vector<LinkPair> unproven;
};

struct RobotModelOptions
{
  PackageResolver packages;  ///< may be empty if no URI names a package
  /// Folders of packages by their names: $(find NAME) in xacro files finds these first, then those on ROS_PACKAGE_PATH.
  std::map<std::string, std::string> package_folders;
  MeshAccess meshes;                                     ///< how to read mesh files, and from which folders
  std::string urdf_folder;                               ///< base folder of relative mesh paths; may be empty
  std::string urdf_name = "robot_description";           ///< for messages: name of the file or parameter
  std::string srdf_name = "robot_description_semantic";  ///< for messages
  /// Ranges of random states for unbounded variables: angles (continuous joints, planar theta) in [-pi, pi],
  /// translations of planar and floating joints in [-unbounded_translation, +unbounded_translation] (metres).
  /// Quaternions are uniform over the rotations.
  double unbounded_translation = 1.0;
  /// They replace limits of the URDF, also by wider ones, as in MoveIt. An entry that can have no effect gives a
  /// warning: the robot does not have the variable, or it belongs to a continuous, fixed or mimic joint or to a
  /// rotation.
  std::vector<JointLimits> joint_limits = {};
  std::function<void(const std::string& line)> info;  ///< receives a line for each program that was run; may be empty
};

class Kinematics;

/// A robot: the kinematic tree of a URDF with its collision shapes, and the content of its SRDF. Immutable and
/// thread-safe. A *state* is a row of `variables().size()` doubles.
class RobotModel : public std::enable_shared_from_this<RobotModel>
{
 public:
  /// `urdf` and `srdf` are XML texts in UTF-8 or ISO-8859-1; an empty `srdf` means that there is none. `warnings` (may
  /// be null) receives a line for each harmless fault, for example an SRDF entry with an unknown link, or a group with
  /// an unknown joint, which is left out as in MoveIt. The limits of a joint are those of its <limit>, and of its
  /// <safety_controller> where those are narrower, as in MoveIt. Throws Error with name and line for malformed XML,
  /// missing meshes, limits that no position is within, and names in the URDF that are misspelt or in the wrong place,
  /// if a shape or its pose would be lost.
  static std::shared_ptr<const RobotModel> fromXml(const std::string& urdf, const std::string& srdf,
                                                   const RobotModelOptions& options,
                                                   std::vector<std::string>* warnings = nullptr);
  /// Reads the two files and calls fromXml; `srdf_path` may be empty. Sets urdf_folder, urdf_name and srdf_name. A
  /// xacro file is expanded if the program xacro is on PATH: the program is run without arguments, for at most 60 s.
  static std::shared_ptr<const RobotModel> fromFiles(const std::string& urdf_path, const std::string& srdf_path,
                                                     RobotModelOptions options,
                                                     std::vector<std::string>* warnings = nullptr);

  const std::string& name() const { return name_; }
  /// The frame of the link poses: the parent frame of the virtual joint, or, without one, the root link's name.
  const std::string& planningFrame() const { return planning_frame_; }
  const std::vector<Link>& links() const { return links_; }     ///< parents before children; [0] is the root link
  const std::vector<Joint>& joints() const { return joints_; }  ///< parents before children
  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<Group>& groups() const { return groups_; }
  const std::vector<NamedState>& namedStates() const { return named_states_; }
  const SrdfCollisions& srdfCollisions() const { return srdf_collisions_; }

  int linkIndex(const std::string& name) const;       ///< -1 if there is none
  int jointIndex(const std::string& name) const;      ///< -1 if there is none
  int variableIndex(const std::string& name) const;   ///< -1 if there is none
  const Group& group(const std::string& name) const;  ///< throws Error that lists the groups if it is unknown
  /// The state of the SRDF with this name: NAME or GROUP/NAME. If several groups have a state NAME, for example an arm
  /// and its hand, it has the values of all of them. Throws Error that lists the states if there is none, and Error if
  /// two groups give a variable different values or the state has no variable.
  NamedState namedState(const std::string& name) const;

  /// Adjacent links, sorted: a link and its nearest ancestor with shapes, at most one degree of freedom between them.
  std::vector<std::pair<int, int>> adjacentLinks() const;

  /// Forward kinematics: writes the pose of every link in the planning frame. `state`: variables().size() values.
  /// `poses`: room for links().size(). The quaternion of a floating joint is normalised; a quaternion of zero length
  /// means no rotation.
  void linkPoses(const double* state, Eigen::Isometry3d* poses) const;

  /// Writes the poses of one link and of the links between it and the root, as linkPoses does. `known`: one entry per
  /// link; the poses of links with an entry other than 0 are already those of this state. Sets `known` to 1 for each
  /// link whose pose it writes.
  void computeLinkPose(const double* state, int link, Eigen::Isometry3d* poses, std::uint8_t* known) const;

  /// Writes a random state: variables are uniform between lower and upper, rotations of floating joints uniform over
  /// SO(3). The base moves too, where a planar or floating joint carries it, such as the virtual joint of an SRDF.
  void randomState(std::mt19937_64& generator, double* state) const;

  /// Writes a random state, in which planar and floating joints have the values of the state `base`: the robot stands
  /// still. `base` must not be `state`.
  void randomState(std::mt19937_64& generator, const double* base, double* state) const;

  /// A state with all variables 0, or in the middle of their limits if 0 is outside. Floating joints have the identity
  /// rotation.
  std::vector<double> defaultState() const;

  std::size_t triangleCount() const;  ///< in the meshes of all links, without boxes and curved shapes

  /// The robot as it was loaded, with the shapes of each link scaled about their own origins. Meshes are scaled about
  /// the mean of their vertices, as in MoveIt. `factors`: one per link; empty: all 1. Links with a factor of 1 share
  /// their shapes with the loaded robot. Throws Error if the number of factors is wrong, if a factor is not finite or
  /// not above 0, or if a scaled shape is not valid.
  std::shared_ptr<const RobotModel> scaled(const std::vector<double>& factors) const;
  /// The robot with other rules for the meshes of some links, by name. It keeps its scale. Throws Error for an unknown
  /// link, and for a link without a mesh.
  std::shared_ptr<const RobotModel> withSolids(const std::map<std::string, SolidRule>& rules) const;

  /// The scale factors of this robot, one per link; empty: all 1.
  const std::vector<double>& linkScale() const { return link_scale_; }

 private:
  friend class RobotModelBuilder;
  std::string name_;
  std::string planning_frame_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<Variable> variables_;
  std::vector<Group> groups_;
  std::vector<NamedState> named_states_;
  SrdfCollisions srdf_collisions_;
  std::unordered_map<std::string, int> link_indices_;
  std::unordered_map<std::string, int> joint_indices_;
  std::unordered_map<std::string, int> variable_indices_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotModel> as_loaded_;  // null: this robot is as it was loaded
  std::vector<double> link_scale_;
};
}  // namespace gpu_planning_scene::core
