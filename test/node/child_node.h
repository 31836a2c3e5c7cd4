#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace gpu_planning_scene::core
{
/// A planning_scene_node that a test starts by itself, with parameters of its own and the robot of the test's.
class ChildNode
{
 public:
  /// Waits until it answers. `arguments`: such as "_device:=cpu".
  ChildNode(const std::string& node_name, std::vector<std::string> arguments, const std::string& program = GPS_NODE);
  ~ChildNode();
  ChildNode(const ChildNode&) = delete;
  ChildNode& operator=(const ChildNode&) = delete;

  std::string service(const std::string& in_its_namespace) const { return "/" + name_ + "/" + in_its_namespace; }
  void interrupt() const;
  /// As `rosnode kill` does.
  void askToShutDown() const;
  /// Its exit code; -1 if it has not ended after so many seconds, or was killed.
  int wait(double seconds);

 private:
  std::string name_;
  pid_t process_ = 0;
};
}  // namespace gpu_planning_scene::core
