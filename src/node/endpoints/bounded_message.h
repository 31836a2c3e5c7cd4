#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <ros/advertise_service_options.h>
#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>
#include <ros/service_callback_helper.h>
#include <ros/service_traits.h>
#include <boost/array.hpp>
#include <boost/make_shared.hpp>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// [~limits/message_size] Sets the largest size of a message or request in bytes; 256 MiB by default. Thread-safe.
void setMessageLimit(std::uint32_t bytes);
/// Throws std::runtime_error, which names the parameter, if a message of this size is too large.
void requireMessageSize(std::uint32_t bytes);

/// Reads a message through its generated allInOne. Before it allocates memory for an array, it compares the length of
/// the array with the rest of the message. (roscpp allocates first: a length of 2^32 in a message of 12 bytes takes all
/// memory.) Throws std::runtime_error if the message ends early.
class BoundedStream
{
 public:
  BoundedStream(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  /// The generated allInOne calls next() for each field.
  template <class T>
  std::enable_if_t<std::is_arithmetic_v<T>> next(T& value)
  {
    copy(&value, sizeof value);
  }
  template <class T>
  std::enable_if_t<ros::message_traits::IsMessage<T>::value> next(T& message)
  {
    ros::serialization::Serializer<T>::template allInOne<BoundedStream, T&>(*this, message);
  }
  template <class T, std::size_t N>
  void next(boost::array<T, N>& values)
  {
    for (T& value : values)
      next(value);
  }
  template <class T, class Allocator>
  void next(std::vector<T, Allocator>& values)
  {
    if constexpr (std::is_arithmetic_v<T>)
    {
      values.resize(length(sizeof(T)));
      copy(values.data(), values.size() * sizeof(T));
    }
    else
    {
      // An element has at least one byte in the message, but may need a hundred times as much memory. So memory is
      // allocated element by element.
      const std::uint32_t count = length(1);
      values.clear();
      for (std::uint32_t i = 0; i < count; ++i)
        next(values.emplace_back());
    }
  }
  void next(std::string& text);
  void next(ros::Time& time);
  void next(ros::Duration& duration);

  bool atEnd() const { return at_ == end_; }

 private:
  /// Reads the length of an array. `least`: the smallest size of an element in bytes.
  std::uint32_t length(std::size_t least);
  void copy(void* to, std::size_t bytes);
  void require(std::size_t bytes) const;

  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

/// Reads a message that fills all `size` bytes; throws std::runtime_error otherwise.
template <class M>
void readBounded(const std::uint8_t* data, std::uint32_t size, M& message)
{
  requireMessageSize(size);
  BoundedStream stream(data, size);
  stream.next(message);
  if (!stream.atEnd())
    throw std::runtime_error("the message has bytes after its last field");
}

/// Takes the place of M in services and topics, with the traits of M.
template <class M>
struct Bounded
{
  M message;
  std::string fault;              ///< the reason why the message could not be read; empty if it was read
  bool is_out_of_memory = false;  ///< whether the reason is the memory of the node, and not the message

  /// If the message could not be read: throws std::bad_alloc if memory is the reason, and Error otherwise.
  void requireRead() const
  {
    if (is_out_of_memory)
      throw std::bad_alloc();
    if (!fault.empty())
      throw Error(fault);
  }
};

/// Options for a service whose handler gets the request with its fault.
template <class Service, class Handler>
ros::AdvertiseServiceOptions boundedService(const std::string& name, Handler handler,
                                            ros::CallbackQueueInterface* queue)
{
  using Request = Bounded<typename Service::Request>;
  using Response = typename Service::Response;
  using Spec = ros::ServiceSpec<Request, Response>;
  ros::AdvertiseServiceOptions options;
  options.service = name;
  options.md5sum = ros::service_traits::md5sum<Service>();
  options.datatype = ros::service_traits::datatype<Service>();
  options.req_datatype = ros::message_traits::datatype<typename Service::Request>();
  options.res_datatype = ros::message_traits::datatype<Response>();
  options.helper = boost::make_shared<ros::ServiceCallbackHelperT<Spec>>(typename Spec::CallbackType(
      [handler](Request& request, Response& response) { return handler(request, response); }));
  options.callback_queue = queue;
  return options;
}

/// Subscribes with a handler that gets the message with its fault.
template <class M, class Handler>
ros::Subscriber subscribeBounded(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue_size,
                                 Handler handler)
{
  using Pointer = boost::shared_ptr<const Bounded<M>>;
  return node.subscribe<Bounded<M>>(
      topic, queue_size, boost::function<void(const Pointer&)>([handler](const Pointer& m) { handler(*m); }));
}
}  // namespace gpu_planning_scene::core

namespace ros
{
namespace message_traits
{
template <class M>
struct IsMessage<gpu_planning_scene::core::Bounded<M>> : TrueType
{
};
template <class M>
struct MD5Sum<gpu_planning_scene::core::Bounded<M>>
{
  static const char* value() { return MD5Sum<M>::value(); }
  static const char* value(const gpu_planning_scene::core::Bounded<M>&) { return value(); }
};
template <class M>
struct DataType<gpu_planning_scene::core::Bounded<M>>
{
  static const char* value() { return DataType<M>::value(); }
  static const char* value(const gpu_planning_scene::core::Bounded<M>&) { return value(); }
};
template <class M>
struct Definition<gpu_planning_scene::core::Bounded<M>>
{
  static const char* value() { return Definition<M>::value(); }
  static const char* value(const gpu_planning_scene::core::Bounded<M>&) { return value(); }
};
}  // namespace message_traits

namespace serialization
{
template <class M>
struct Serializer<gpu_planning_scene::core::Bounded<M>>
{
  /// Never throws: after an exception, roscpp drops the connection and the client gets no reason.
  template <class Stream>
  static void read(Stream& stream, gpu_planning_scene::core::Bounded<M>& bounded)
  {
    const std::uint32_t size = stream.getLength();
    try
    {
      gpu_planning_scene::core::readBounded(stream.getData(), size, bounded.message);
      bounded.fault.clear();
      bounded.is_out_of_memory = false;
    }
    catch (const std::bad_alloc&)
    {
      bounded.message = M();
      bounded.fault = "out of memory";
      bounded.is_out_of_memory = true;
    }
    catch (const std::exception& error)
    {
      bounded.message = M();
      bounded.fault = error.what();
      bounded.is_out_of_memory = false;
    }
    stream.advance(size);
  }
};
}  // namespace serialization
}  // namespace ros
