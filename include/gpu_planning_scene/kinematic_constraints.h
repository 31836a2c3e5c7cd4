#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A point of a link is within a region. As moveit_msgs/PositionConstraint with one primitive.
struct PositionConstraint
{
  int link = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();         ///< metres, in the link's frame (target_point_offset)
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the region, in the planning frame
  std::variant<Sphere, Box> region = Sphere{};             ///< its centre is the origin of `pose`
};

/// A frame of a link has an orientation, up to tolerances about its three axes. As moveit_msgs/OrientationConstraint.
struct OrientationConstraint
{
  /// The three numbers that are compared with the tolerances. They describe the rotation from the wanted orientation
  /// to the frame.
  enum class Parameterization
  {
    /// Intrinsic angles about the x, y, z axes of the wanted orientation. The first two limit the tilt of the z axis.
    XyzEulerAngles,
    /// Axis times angle, as a vector along `axes`.
    RotationVector
  };

  int link = -1;
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();   ///< of the constrained frame, in the link's frame
  Eigen::Matrix3d wanted = Eigen::Matrix3d::Identity();  ///< of the constrained frame, in the planning frame
  Eigen::Vector3d tolerance = Eigen::Vector3d::Zero();   ///< radians, above 0; pi: any angle
  Parameterization parameterization = Parameterization::XyzEulerAngles;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< only for RotationVector: a rotation, in the planning frame
};

/// The values of a variable are within a range. The variable must not be a component of a quaternion.
struct JointConstraint
{
  int variable = -1;
  double lower = 0.0;  ///< radians or metres
  double upper = 0.0;
  bool is_turn = false;  ///< whole turns do not matter: an angle of a continuous or planar joint
};

/// Conditions on a robot state, all of which must hold. As moveit_msgs/Constraints.
///
/// Sets of poses with tolerances as goals and as constraints of motions: D. Berenson, S. Srinivasa, J. Kuffner: Task
/// space regions: A framework for pose-constrained manipulation planning. IJRR 30(12), 2011.
struct KinematicConstraints
{
  std::vector<PositionConstraint> positions;
  std::vector<OrientationConstraint> orientations;
  std::vector<JointConstraint> joints;

  /// Adds the range of a variable of this robot.
  void addJoint(const RobotModel& robot, int variable, double lower, double upper);

  bool isEmpty() const { return positions.empty() && orientations.empty() && joints.empty(); }

  /// A frame of a link has a pose. `frame`: in the link's frame. `pose`: in the planning frame. The distance of the
  /// origins is at most `position_tolerance` (metres); the angle between the orientations is at most
  /// `orientation_tolerance` (radians; pi or more: any orientation). Both are at least 1e-9.
  static KinematicConstraints pose(int link, const Eigen::Isometry3d& frame, const Eigen::Isometry3d& pose,
                                   double position_tolerance, double orientation_tolerance);

  /// Adds the constraints of another set.
  void append(const KinematicConstraints& other);

  /// Moves values outside the ranges of `joints` to the nearest end of their range.
  void clampJoints(double* state) const;

  /// The links of the constraints, ascending, each once.
  std::vector<int> links() const;

  /// Throws Error that begins with `where` if a link or variable is unknown, if a number is not finite, if a tolerance
  /// is below 1e-9 m or 5e-10 rad, if an orientation is not a rotation, or for a wrong range: it is empty, it is
  /// outside the limits of its variable, its variable is a component of a quaternion, or another range of the variable
  /// contradicts it.
  void validate(const RobotModel& robot, const std::string& where) const;
};

/// How far a robot state is from constraints.
struct ConstraintViolation
{
  double position = 0.0;     ///< metres: the largest distance of a point from its region
  double orientation = 0.0;  ///< radians: the largest excess of an angle over its tolerance
  double joint = 0.0;        ///< radians or metres: the largest distance of a variable from its range

  bool isNone() const { return position == 0.0 && orientation == 0.0 && joint == 0.0; }
  double sum() const { return position + orientation + joint; }
  /// For messages: "0.25 m from the wanted position and 0.1 rad from the wanted orientation".
  std::string text() const;
};

/// The violation in a state with these link poses. `poses`: one per link; only those of constraints.links() are read.
ConstraintViolation violationOf(const KinematicConstraints& constraints, const Eigen::Isometry3d* poses,
                                const double* state);
}  // namespace gpu_planning_scene::core
