#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/bounded_message.h"
#include "node/endpoints/diagnostics.h"
#include "node/endpoints/respond.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
/// Whether the response of a service has a field `success`.
template <class Response, class = void>
constexpr bool kHasSuccess = false;
template <class Response>
constexpr bool kHasSuccess<Response, std::void_t<decltype(Response::success)>> = true;

/// Whether the response of a service has a field `message`.
template <class Response, class = void>
constexpr bool kHasMessage = false;
template <class Response>
constexpr bool kHasMessage<Response, std::void_t<decltype(Response::message)>> = true;

/// Services and topics with a callback queue and threads of their own. Messages are read with bounds (see Bounded), and
/// rejected messages are counted.
class Endpoints
{
 public:
  /// Throws the reason why no request is answered and no message is taken now. Thread-safe.
  using Precondition = std::function<void()>;

  Endpoints(const ros::NodeHandle& node, const ros::NodeHandle& own, std::size_t threads, Diagnostics& diagnostics,
            Precondition precondition = {});
  ~Endpoints();

  /// Advertises a service in the node's namespace. `answer` turns a request into a response. If it throws, the response
  /// has the error in its fields `success`, `status` and `message`. Without these fields, the error is logged, and
  /// without `success`, the call fails.
  template <class Service, class Answer>
  void advertise(const std::string& name, Answer answer)
  {
    const auto handle =
        [this, answer, name](Bounded<typename Service::Request>& request, typename Service::Response& response)
    {
      const Fault fault = faultOf(
          [&]
          {
            request.requireRead();
            if (closed_)
              throw ShuttingDown();
            requirePrecondition();
            response = answer(request.message);
            requirePrecondition();  // it may have been broken while the request waited
          });
      last_answer_ = std::chrono::steady_clock::now();
      return close(name, fault, response);
    };
    ros::AdvertiseServiceOptions options = boundedService<Service>(own_.resolveName(name), handle, &queue_);
    services_.push_back(own_.advertiseService(options));
  }

  /// Subscribes to a topic; "~NAME" is in the node's namespace. `take` throws an exception for a wrong message, and
  /// Busy if it has no room for a correct message.
  template <class Message, class Take>
  void subscribe(const std::string& name, std::uint32_t queue_size, Take take)
  {
    const std::string topic = topicName(name);
    topics_.push_back(subscribeBounded<Message>(node_, topic, queue_size,
                                                [this, take, topic](const Bounded<Message>& message)
                                                {
                                                  try
                                                  {
                                                    message.requireRead();
                                                    if (closed_)
                                                      throw ShuttingDown("the node is shutting down");
                                                    requirePrecondition();
                                                    take(message.message);
                                                  }
                                                  catch (const Busy& error)
                                                  {
                                                    reportLost(topic, error.what());
                                                  }
                                                  catch (...)
                                                  {
                                                    refuse(topic, currentFault().message);
                                                  }
                                                }));
  }

  /// The full name of a topic of subscribe().
  std::string topicName(const std::string& name) const;

  /// Counts and logs a rejected message.
  void refuse(const std::string& topic, const std::string& why);

  /// From now on, requests get the status SHUTTING_DOWN, and messages are rejected.
  void close();
  /// Calls close(), waits for running callbacks, and rejects the requests and messages that wait.
  void stop();
  /// After stop(): rejects the requests and messages that have arrived since then. Returns whether a request got its
  /// answer after close() or shortly before: roscpp may not have written this answer yet.
  bool refuseWaiting();

 private:
  void requirePrecondition() const
  {
    if (precondition_)
      precondition_();
  }

  /// Reports a fault in the response. Returns false if the service call fails. An answer whose `success` and `status`
  /// contradict each other is a fault: clients decide by either of them.
  template <class Response>
  bool close(const std::string& name, const Fault& fault, Response& response)
  {
    if constexpr (kHasMessage<Response>)
    {
      if (fault)
        response = failed<Response>(fault);
      else if (response.status == 0 || (response.success != 0) != (response.status == AnswerStatus::OK))
        response = failed<Response>({AnswerStatus::INTERNAL_ERROR, "the status " + std::to_string(response.status) +
                                                                       " of the answer contradicts its success"});
      if (!response.success)
        diagnostics_.refused(response.message);
      return true;
    }
    else
    {
      if (fault)
        refuseRequest(name, fault.message);
      if constexpr (kHasSuccess<Response>)
        response.success = !fault;
      return kHasSuccess<Response> || !fault;
    }
  }
  void refuseRequest(const std::string& service, const std::string& why);
  void reportLost(const std::string& topic, const std::string& why);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::NodeHandle own_;
  Diagnostics& diagnostics_;
  const Precondition precondition_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::Subscriber> topics_;
  std::atomic<bool> closed_{false};
  std::chrono::steady_clock::time_point closed_at_;
  std::atomic<std::chrono::steady_clock::time_point> last_answer_{std::chrono::steady_clock::time_point::min()};
  std::vector<std::thread> threads_;
};
}  // namespace gpu_planning_scene::core
