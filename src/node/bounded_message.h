#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
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

namespace gpu_planning_scene::core
{
/// [~limits/message_size] bytes of a message or request; 256 MiB before it is set. Thread-safe.
void setMessageLimit(std::uint32_t bytes);
/// Throws std::runtime_error that names the parameter.
void requireMessageSize(std::uint32_t bytes);

/// Reads generated messages through their own allInOne, and holds the length of each array against what is left of the
/// message before memory is taken. (roscpp resizes first: a length of 2^32 in a message of 12 bytes takes all memory.)
/// Throws std::runtime_error where the message ends early.
class BoundedStream
{
 public:
  BoundedStream(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  /// What a generated allInOne calls for each field.
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
      // Every element takes at least a byte, but may take a hundred times more memory than that: it is taken bit by
      // bit.
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
  /// An array's length; `least` is how many bytes an element has at least.
  std::uint32_t length(std::size_t least);
  void copy(void* to, std::size_t bytes);
  void require(std::size_t bytes) const;

  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

/// The message in those bytes, wholly; throws std::runtime_error.
template <class M>
void readBounded(const std::uint8_t* data, std::uint32_t size, M& message)
{
  requireMessageSize(size);
  BoundedStream stream(data, size);
  stream.next(message);
  if (!stream.atEnd())
    throw std::runtime_error("a message is longer than what it holds");
}

/// To advertise and subscribe with in place of M, whose traits it has. `fault` says why there is no message, else it is
/// empty.
template <class M>
struct Bounded
{
  M message;
  std::string fault;
};

/// Advertises a service whose handler gets the request with its fault.
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
  /// Never throws: roscpp would drop the connection without a word to the client.
  template <class Stream>
  static void read(Stream& stream, gpu_planning_scene::core::Bounded<M>& bounded)
  {
    const std::uint32_t size = stream.getLength();
    try
    {
      gpu_planning_scene::core::readBounded(stream.getData(), size, bounded.message);
      bounded.fault.clear();
    }
    catch (const std::exception& error)
    {
      bounded.message = M();
      bounded.fault = error.what();
    }
    stream.advance(size);
  }
};
}  // namespace serialization
}  // namespace ros
