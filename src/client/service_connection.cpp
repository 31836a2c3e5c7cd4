#include "client/service_connection.h"

#include <limits>

#include <ros/header.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>

// ROS's protocol of services, TCPROS (https://wiki.ros.org/ROS/TCPROS): each side sends a header of fields; then
// requests and responses follow one another. A length of 4 bytes is before each header, request and response, and one
// byte, whether the service has succeeded, before a response. roscpp's client waits without a limit for the connection
// and for the answer, cannot be interrupted, and does not report why a node refuses the connection.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint32_t kLargestHeader = 1U << 20U;  // bytes; those of roscpp and rospy have some hundred

/// The host and the port of a service. The master is asked without a limit: roscpp has none for it.
std::pair<std::string, std::uint32_t> addressOf(const std::string& service)
{
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = service;
  std::pair<std::string, std::uint32_t> address;
  if (!ros::master::execute("lookupService", request, response, uri, false))
    throw NoAnswer("the master " + ros::master::getURI() + " does not know the service " + service);
  if (!ros::network::splitURI(static_cast<std::string&>(uri), address.first, address.second))
    throw NoAnswer("the address " + static_cast<std::string&>(uri) + " of the service " + service + " is wrong");
  return address;
}
}  // namespace

ServiceConnection::ServiceConnection(const std::string& service, const std::string& md5sum, const CallLimit& limit)
  : ServiceConnection(addressOf(service), service, md5sum, limit)
{
}

ServiceConnection::ServiceConnection(const std::pair<std::string, std::uint32_t>& address, const std::string& service,
                                     const std::string& md5sum, const CallLimit& limit)
  : connection_(address.first, address.second, limit)
{
  shakeHands(service, md5sum, limit);
}

void ServiceConnection::shakeHands(const std::string& service, const std::string& md5sum, const CallLimit& limit)
{
  boost::shared_array<std::uint8_t> fields;
  std::uint32_t size = 0;
  ros::Header::write(
      {{"callerid", ros::this_node::getName()}, {"service", service}, {"md5sum", md5sum}, {"persistent", "1"}}, fields,
      size);
  connection_.send(&size, sizeof size, limit);
  connection_.send(fields.get(), size, limit);

  std::vector<std::uint8_t> received = receiveBlock(kLargestHeader, limit);
  ros::Header header;
  std::string fault;
  if (!header.parse(received.data(), static_cast<std::uint32_t>(received.size()), fault))
    throw NoAnswer("the header of the service " + service + " is wrong: " + fault);
  if (!header.getValue("error", fault))
    return;
  const bool is_other_type = fault.find("md5sum") != std::string::npos;
  throw NoAnswer((is_other_type ? "the node has another version of this package, or another type of service: "
                                : "the node refuses the connection: ") +
                 fault);
}

std::vector<std::uint8_t> ServiceConnection::call(const ros::SerializedMessage& request, const CallLimit& limit)
{
  connection_.send(request.buf.get(), request.num_bytes, limit);
  std::uint8_t has_succeeded = 0;
  connection_.receive(&has_succeeded, sizeof has_succeeded, limit);
  std::vector<std::uint8_t> response = receiveBlock(std::numeric_limits<std::uint32_t>::max(), limit);
  if (has_succeeded == 0)
    throw NoAnswer("the service has failed: " + std::string(response.begin(), response.end()));
  return response;
}

std::vector<std::uint8_t> ServiceConnection::receiveBlock(std::uint32_t most, const CallLimit& limit)
{
  std::uint32_t length = 0;  // little-endian, as all processors of ROS are
  connection_.receive(&length, sizeof length, limit);
  if (length > most)
    throw NoAnswer("what answers is not a node of ROS");
  std::vector<std::uint8_t> bytes(length);
  connection_.receive(bytes.data(), length, limit);
  return bytes;
}
}  // namespace gpu_planning_scene::core
