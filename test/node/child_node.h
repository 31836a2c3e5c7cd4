#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace gpu_planning_scene::core
{
/// A planning_scene_node that a test starts itself, with separate parameters and the test's robot.
class ChildNode
{
 public:
  /// Starts the node and waits until it answers. `arguments`: for example "_device:=cpu".
  ChildNode(const std::string& node_name, std::vector<std::string> arguments, const std::string& program = GPS_NODE);
  ~ChildNode();
  ChildNode(const ChildNode&) = delete;
  ChildNode& operator=(const ChildNode&) = delete;

  std::string service(const std::string& in_its_namespace) const { return "/" + name_ + "/" + in_its_namespace; }
  void interrupt() const;
  /// The node does nothing more, but its connections stay.
  void freeze() const;
  /// Asks the node to shut down as `rosnode kill` does.
  void askToShutDown() const;
  /// Waits up to `seconds` for the node to end. Returns its exit code; -1 if it still runs or was ended by a signal.
  int wait(double seconds);

 private:
  std::string name_;
  pid_t process_ = 0;
};
}  // namespace gpu_planning_scene::core
