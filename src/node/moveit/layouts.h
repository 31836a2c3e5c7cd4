#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The layout of a message: one line for each constant, and for each field in the order of the bytes. Fields of
/// messages in the message are named as FIELD.FIELD. `definition`: the text of ros::message_traits::Definition. Throws
/// Error if a type is not defined in the text.
std::vector<std::string> layoutOf(const std::string& definition);

/// Throws Error if the layouts of two messages differ; it names the first difference. `only_ours`: number of fields at
/// the end of our message that MoveIt's message lacks. `name`: of the message, for the error.
void requireEqualLayouts(const std::string& name, const std::string& ours, const std::string& theirs,
                         std::size_t only_ours);

/// Throws Error if a message of moveit_msgs has another layout than our message of the same name.
void requireMoveItLayouts();
}  // namespace gpu_planning_scene::core
