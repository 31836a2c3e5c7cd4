#pragma once

namespace gpu_planning_scene::core
{
/// Whether the environment variable GPU_PLANNING_SCENE_GL_DEBUG asks for debug contexts: `log` or `abort`. Other values
/// throw Error.
bool wantsDebugContext();

/// Writes each message of the driver about the current context to stderr, except for notifications (KHR_debug). With
/// the value `abort`, a message other than a hint about performance ends the process. Does nothing unless
/// wantsDebugContext().
void reportDriverMessages();
}  // namespace gpu_planning_scene::core
