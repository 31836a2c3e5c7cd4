#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A temporary folder. The destructor removes it with its contents.
class TemporaryFolder
{
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

/// The message of the Error that `action` throws; empty if it throws none.
std::string errorOf(const std::function<void()>& action);

/// A robot from the content of its <robot name="test"> element. Line numbers count from the first line of `urdf`.
std::shared_ptr<const RobotModel> robotOf(const std::string& urdf, const std::string& srdf = "",
                                          std::vector<std::string>* warnings = nullptr);

/// XML of a link with a box, and of a joint between two links. `inside` is added to the content of the joint.
std::string boxLink(const std::string& name);
std::string jointXml(const std::string& name, const std::string& type, const std::string& parent,
                     const std::string& child, const std::string& inside = "");
extern const char* const kLimits;  ///< a <limit> from -1 to 2

/// A robot that several tests share:
///     base -arm_1-> upper -arm_2-> fore -hand_fix-> hand -left-> finger_left, -right (mimics left)-> finger_right
///     base -pan-> head
/// arm_1 and arm_2 are revolute, pan is continuous, left and right are prismatic, hand_fix is fixed.
std::string armUrdf();
/// The message of the Error for this SRDF of that robot; empty if there is none.
std::string srdfError(const std::string& srdf);
std::vector<std::string> linkNames(const RobotModel& robot, const std::vector<int>& links);
std::vector<std::string> jointNames(const RobotModel& robot, const std::vector<int>& joints);
}  // namespace gpu_planning_scene::core
