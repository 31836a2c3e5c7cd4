// Requests with wrong bytes, sent without roscpp. The node answers them with an error and continues.

#include <cstring>

#include <netdb.h>
#include <ros/service_manager.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
void append(std::string& bytes, std::uint32_t number)
{
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void appendField(std::string& header, const std::string& field)
{
  append(header, static_cast<std::uint32_t>(field.size()));
  header += field;
}

/// A connection to one of the node's services after the handshake.
class RawClient
{
 public:
  explicit RawClient(const std::string& service)
  {
    std::string host;
    std::uint32_t port = 0;
    if (!ros::ServiceManager::instance()->lookupService(service, host, port))
      throw std::runtime_error("no service " + service);
    addrinfo hints{};
    hints.ai_family = AF_INET;  // roscpp does not listen to IPv6, which Debian's "localhost" names too
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0)
      throw std::runtime_error("no host " + host);
    socket_ = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    const int status = connect(socket_, found->ai_addr, found->ai_addrlen);
    freeaddrinfo(found);
    const timeval timeout{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    if (status != 0)
      throw std::runtime_error("no connection to " + service);
    std::string fields;
    appendField(fields, "callerid=/hostile");
    appendField(fields, "md5sum=*");
    appendField(fields, "service=" + service);
    std::string header;
    append(header, static_cast<std::uint32_t>(fields.size()));
    write(header + fields);
    read(number());
  }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient() { close(socket_); }

  /// Sends a body and returns the body of the response; empty if there is no response.
  std::string ask(const std::string& body)
  {
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(body.size()));
    write(bytes + body);
    read(1);
    return read(number());
  }

 private:
  void write(const std::string& bytes)
  {
    EXPECT_EQ(static_cast<ssize_t>(bytes.size()), send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }
  std::string read(std::size_t count)
  {
    std::string bytes(count, '\0');
    const ssize_t got = recv(socket_, bytes.data(), count, MSG_WAITALL);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
    return bytes;
  }
  std::uint32_t number()
  {
    const std::string bytes = read(4);
    std::uint32_t value = 0;
    if (bytes.size() == 4)
      std::memcpy(&value, bytes.data(), 4);
    return value;
  }

  int socket_ = -1;
};

using HostileBytes = RunningNode;

TEST_F(HostileBytes, AnArrayThatIsSaidToBeEndlessIsRefused)
{
  std::string body;
  append(body, 0);            // group
  append(body, 0xffffffffU);  // joint_names: a wrong length
  append(body, 0);
  EXPECT_NE(std::string::npos, RawClient(name("check_states")).ask(body).find("ends early"));
  EXPECT_TRUE(isFree());
}

TEST_F(HostileBytes, BytesThatMeanNothingAreRefusedByEachService)
{
  for (const char* service : {"check_states", "check_motions", "apply_planning_scene", "get_report", "show_tree_level"})
    for (const std::size_t length : {0, 3, 100, 10000})
      RawClient(name(service)).ask(std::string(length, '\xfe'));
  EXPECT_TRUE(isFree());
}

TEST_F(HostileBytes, AClientThatGoesAwayInTheMiddleHarmsNobody)
{
  for (int i = 0; i < 20; ++i)
    RawClient half(name("check_states"));
  EXPECT_TRUE(isFree());
}
}  // namespace
}  // namespace gpu_planning_scene::core
