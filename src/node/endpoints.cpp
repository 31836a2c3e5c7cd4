#include "node/endpoints.h"

namespace gpu_planning_scene
{
Endpoints::Endpoints(const ros::NodeHandle& node, const ros::NodeHandle& own, std::size_t threads,
                     Diagnostics& diagnostics)
  : node_(node), own_(own), diagnostics_(diagnostics), spinner_(static_cast<std::uint32_t>(threads), &queue_)
{
  node_.setCallbackQueue(&queue_);
  own_.setCallbackQueue(&queue_);
  spinner_.start();
}

Endpoints::~Endpoints()
{
  stop();
}

/// Services and topics are taken down last: that drops connections, which answers are still written to.
void Endpoints::stop()
{
  spinner_.stop();
}

void Endpoints::refuse(const std::string& topic, const std::string& why)
{
  const std::string line = topic + ": " + shortLine(why);
  diagnostics_.refused(line);
  ROS_WARN_STREAM_THROTTLE(1.0, "a message is not used, on " << line);
}

void Endpoints::lose(const std::string& topic, const std::string& why)
{
  const std::string line = topic + ": " + shortLine(why);
  diagnostics_.refused(line);
  ROS_ERROR_STREAM_THROTTLE(1.0, "a message is lost, on " << line);
}
}  // namespace gpu_planning_scene
