#pragma once

#include <fstream>
#include <string>

namespace gpu_planning_scene::core
{
/// Opens a text file for reading. Throws Error if it cannot be read (with the reason), is a folder, or is empty.
std::ifstream openFile(const std::string& path);
}  // namespace gpu_planning_scene::core
