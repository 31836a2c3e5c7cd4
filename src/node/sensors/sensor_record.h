#pragma once

#include <cstdint>
#include <string>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/time.h>

namespace gpu_planning_scene::core
{
/// Counts of a sensor's measurements, and its diagnostic status. Not thread-safe.
struct SensorRecord
{
  std::uint64_t used = 0;
  std::uint64_t dropped = 0;
  std::uint64_t rejected = 0;
  ros::SteadyTime used_at = ros::SteadyTime::now();  ///< of the last used measurement; before it, the start
  bool has_measured = false;                         ///< since the last call of distrust() or forget()
  bool silence_is_logged = false;
  std::string fault;         ///< of the last measurement; empty if it was used
  std::string loss;          ///< the last one, see lose(); empty: none since the octomap was cleared
  ros::SteadyTime lost_at;   ///< of `loss`
  double lag = 0.0;          ///< seconds from the stamp of the last used measurement to the scene with it
  double longest_lag = 0.0;  ///< since the last call of status()

  /// Counts a measurement that is in the scene. `its_lag`: seconds, see `lag`.
  void use(double its_lag);
  /// Voxels are not in the scene although they were measured. `what`: one line.
  void lose(const std::string& what);
  /// Counts a measurement that is not in the scene. `why`: one line.
  void reject(const std::string& why);

  /// The octomap may be without this sensor's measurements: nothing is known until the next one.
  void distrust() { has_measured = false; }
  /// The octomap is empty: nothing is known until the next measurement, and nothing is lost.
  void forget();

  /// Why the octomap may lack what this sensor measures, in one line: no measurement was used in the last `seconds`, or
  /// voxels were lost. Otherwise empty. 0 seconds: a silent sensor is no fault.
  std::string octomapFault(const std::string& topic, double seconds) const;

  /// A line for the log if no measurement was used for so long that the user should look. Empty if one was used, or if
  /// this silence got its line already.
  std::string silence(const std::string& topic);

  /// ERROR if the last measurement was rejected or voxels were lost in the last 10 s, WARN if no measurement was used
  /// for a second. Resets `longest_lag`.
  diagnostic_msgs::DiagnosticStatus status(const std::string& topic);
};
}  // namespace gpu_planning_scene::core
