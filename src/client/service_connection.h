#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <ros/serialized_message.h>

#include "client/call_limit.h"
#include "client/tcp_connection.h"

namespace gpu_planning_scene::core
{
/// A connection to a service of ROS. One call after the other goes over it. All functions with a limit throw NoAnswer,
/// and Cancelled; the connection is then of no use any more.
class ServiceConnection
{
 public:
  /// `service`: its full name. `md5sum`: that of the type of the service.
  ServiceConnection(const std::string& service, const std::string& md5sum, const CallLimit& limit);

  /// Whether the next call can use this connection.
  bool isOpen() const { return connection_.isQuiet(); }
  /// The serialised response. `request` is serialised with its length.
  std::vector<std::uint8_t> call(const ros::SerializedMessage& request, const CallLimit& limit);

 private:
  ServiceConnection(const std::pair<std::string, std::uint32_t>& address, const std::string& service,
                    const std::string& md5sum, const CallLimit& limit);
  /// A length, and as many bytes.
  std::vector<std::uint8_t> receiveBlock(std::uint32_t most, const CallLimit& limit);
  void shakeHands(const std::string& service, const std::string& md5sum, const CallLimit& limit);

  TcpConnection connection_;
};
}  // namespace gpu_planning_scene::core
