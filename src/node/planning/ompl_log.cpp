#include "node/planning/ompl_log.h"

#include <ros/console.h>

namespace gpu_planning_scene::core
{
OmplLog::OmplLog()
{
  ompl::msg::useOutputHandler(this);
}

OmplLog::~OmplLog()
{
  ompl::msg::restorePreviousOutputHandler();
}

void OmplLog::log(const std::string& text, ompl::msg::LogLevel level, const char* /*filename*/, int /*line*/)
{
  if (level >= ompl::msg::LOG_ERROR)
    ROS_ERROR_STREAM_NAMED("ompl", text);
  else if (level == ompl::msg::LOG_WARN)
    ROS_WARN_STREAM_NAMED("ompl", text);
  else
    ROS_DEBUG_STREAM_NAMED("ompl", text);
}
}  // namespace gpu_planning_scene::core
