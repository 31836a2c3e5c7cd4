#include "client/tcp_connection.h"

#include <cerrno>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gpu_planning_scene::core
{
namespace
{
std::string textOf(int error)
{
  return std::system_category().message(error);
}

/// Waits until the socket has one of the events.
void await(int socket, short events, const CallLimit& limit)
{
  pollfd entry{socket, events, 0};
  while (::poll(&entry, 1, limit.wait()) <= 0)
    ;  // the limit ends this loop
}

/// Whether a call of the system only has to wait. Throws NoAnswer if it has failed.
void requireWaiting(int error)
{
  if (error != EAGAIN && error != EWOULDBLOCK && error != EINTR)
    throw NoAnswer("the connection to the node is lost: " + textOf(error));
}

/// The error of a connection; 0: it is made.
int connectTo(int socket, const addrinfo& address, const CallLimit& limit)
{
  if (::connect(socket, address.ai_addr, address.ai_addrlen) == 0)
    return 0;
  if (errno != EINPROGRESS && errno != EINTR)
    return errno;
  await(socket, POLLOUT, limit);
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}
}  // namespace

TcpConnection::TcpConnection(const std::string& host, std::uint32_t port, const CallLimit& limit)
{
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int status = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); status != 0)
    throw NoAnswer("the host " + host + " of the node is not known: " + ::gai_strerror(status));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  int error = 0;
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next)
  {
    socket_ = Socket(::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, address->ai_protocol));
    error = *socket_ < 0 ? errno : connectTo(*socket_, *address, limit);
    if (error == 0)
    {
      const int yes = 1;  // a request is sent as a whole, so there is nothing to collect
      ::setsockopt(*socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      return;
    }
  }
  throw NoAnswer("no connection to " + host + ":" + std::to_string(port) + ": " + textOf(error));
}

TcpConnection::Socket::~Socket()
{
  if (descriptor_ >= 0)
    ::close(descriptor_);
}

void TcpConnection::send(const void* bytes, std::size_t count, const CallLimit& limit)
{
  for (const char* next = static_cast<const char*>(bytes); count != 0;)
  {
    await(*socket_, POLLOUT, limit);
    const ssize_t sent = ::send(*socket_, next, count, MSG_NOSIGNAL);
    if (sent < 0)
    {
      requireWaiting(errno);
      continue;
    }
    next += sent;
    count -= static_cast<std::size_t>(sent);
  }
}

void TcpConnection::receive(void* bytes, std::size_t count, const CallLimit& limit)
{
  for (char* next = static_cast<char*>(bytes); count != 0;)
  {
    await(*socket_, POLLIN, limit);
    const ssize_t received = ::recv(*socket_, next, count, 0);
    if (received == 0)
      throw NoAnswer("the node has closed the connection");
    if (received < 0)
    {
      requireWaiting(errno);
      continue;
    }
    next += received;
    count -= static_cast<std::size_t>(received);
  }
}

bool TcpConnection::isQuiet() const
{
  pollfd entry{*socket_, POLLIN, 0};
  return ::poll(&entry, 1, 0) == 0;
}
}  // namespace gpu_planning_scene::core
