#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The layout of a message: one line for each constant, and for each field in the order of the bytes. Fields of
/// messages in the message are named as FIELD.FIELD. `definition`: the text of ros::message_traits::Definition. Throws
/// Error if a type is not defined in the text.
std::vector<std::string> layoutOf(const std::string& definition);

/// A message of moveit_msgs and the message of this package as which its bytes are read or written.
struct LayoutPair
{
  std::string name;            ///< of MoveIt's message
  std::string ours;            ///< definition, as for layoutOf()
  std::string theirs;          ///< definition of MoveIt's message
  std::string first_own = {};  ///< field of our message that MoveIt's lacks, with all that follow it; empty: none
};

/// Throws Error if the two layouts differ; it names the message and the first difference.
void requireEqualLayouts(const LayoutPair& pair);

/// All messages whose bytes the node reads or writes as MoveIt's: those of the topics, and the requests and responses
/// of the services.
std::vector<LayoutPair> moveItLayouts();

/// Throws Error if a message of moveItLayouts() has another layout than our message.
void requireMoveItLayouts();
}  // namespace gpu_planning_scene::core
