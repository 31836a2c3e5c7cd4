#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "client/call_limit.h"

namespace gpu_planning_scene::core
{
/// A TCP connection. Every wait has a limit, also the one for the connection itself. Only the look-up of the host's
/// name has none but that of the system. All functions with a limit throw NoAnswer, and Cancelled.
class TcpConnection
{
 public:
  TcpConnection(const std::string& host, std::uint32_t port, const CallLimit& limit);

  void send(const void* bytes, std::size_t count, const CallLimit& limit);
  void receive(void* bytes, std::size_t count, const CallLimit& limit);
  /// Whether the connection is open and no byte waits to be received.
  bool isQuiet() const;

 private:
  /// A socket, which is closed at the end.
  class Socket
  {
   public:
    explicit Socket(int descriptor = -1) : descriptor_(descriptor) {}
    Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Socket& operator=(Socket&& other) noexcept
    {
      std::swap(descriptor_, other.descriptor_);
      return *this;
    }
    ~Socket();
    int operator*() const { return descriptor_; }

   private:
    int descriptor_;
  };

  Socket socket_;
};
}  // namespace gpu_planning_scene::core
