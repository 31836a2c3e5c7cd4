#pragma once

namespace gpu_planning_scene
{
/// Throws Error if OpenGL has recorded an error on the current context since the last call; `where` names the
/// operation.
void checkGl(const char* where);
}  // namespace gpu_planning_scene
