#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/bounded_message.h"
#include "node/endpoints/respond.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
/// The node whose scene is followed.
struct FollowOptions
{
  std::string node;      ///< full name
  std::string topic;     ///< full name of the topic with its changes
  std::string service;   ///< full name of its service for the whole scene
  double period = 5.0;   ///< seconds between two fetches
  double timeout = 5.0;  ///< seconds: longest wait for the answer of the service
};

/// Follows the scene of another node. Its thread calls the service `GetScene`, and then takes the messages of the
/// topic. The scene counts as known from the first fetch on, until the publisher or one of the two connections changes,
/// a message cannot be applied, or the service does not answer. Then the whole scene is fetched anew. The derived class
/// calls start() at the end of its constructor, and stop() in its destructor.
template <class SceneMessage, class GetScene>
class SceneFollower
{
 public:
  SceneFollower(const SceneFollower&) = delete;
  SceneFollower& operator=(const SceneFollower&) = delete;

  /// The reason why the followed scene is not known now; empty if it is known. Thread-safe.
  std::string fault() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (fault_.empty() && is_calling_ && Clock::now() - call_began_ > std::chrono::duration<double>(options_.timeout))
      return unknown(options_.service + " does not answer");
    // While the thread fetches, messages wait.
    if (fault_.empty() && is_fetching_ && Clock::now() - call_began_ > kLongFetch && !queue_.isEmpty())
      return unknown("it changes while it is being fetched, which takes long");
    return fault_;
  }

  /// Throws Unavailable if the followed scene is not known now. Thread-safe.
  void requireScene() const
  {
    if (const std::string reason = fault(); !reason.empty())
      throw Unavailable(reason);
  }

  /// Drops the connection of a running fetch, which ends the fetch. This is repeated until the thread ends, because the
  /// fetch may be about to connect.
  void stop()
  {
    stopping_ = true;
    timer_.stop();
    while (thread_.joinable() && !ended_)
    {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        client_.shutdown();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (thread_.joinable())
      thread_.join();
  }

 protected:
  using Request = typename GetScene::Request;
  using Response = typename GetScene::Response;

  /// `timers`: the node handle for a timer; it must outlive this object.
  SceneFollower(const ros::NodeHandle& node, ros::NodeHandle& timers, FollowOptions options)
    : options_(std::move(options)), node_(node), timers_(timers)
  {
    lose("it has not arrived yet; call again later");
    node_.setCallbackQueue(&queue_);
  }
  virtual ~SceneFollower() = default;

  void start()
  {
    // Without a bound, because roscpp drops messages silently. The thread takes them at once, except during a fetch,
    // which has a timeout.
    subscriber_ = node_.subscribe<Message, const Event&>(
        options_.topic, 0,
        boost::function<void(const Event&)>([this](const Event& event) { messages_.push_back(event); }));
    timer_ = timers_.createWallTimer(
        ros::WallDuration(kWatchPeriod), [this](const ros::WallTimerEvent&) { endLongCall(); });
    thread_ = std::thread([this] { run(); });
  }

  // Called on the thread. An error in one of them means that the scene is no longer known.
  virtual Request request() = 0;
  /// Takes the answer to a request of request().
  virtual void take(const Response& answer) = 0;
  virtual void apply(const SceneMessage& message) = 0;

  const FollowOptions& options() const { return options_; }
  /// Whether the scene is known, and whether it has been known before. Only for the thread.
  bool isCurrent() const { return is_current_; }
  bool wasCurrent() const { return was_current_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Message = Bounded<SceneMessage>;
  using Event = ros::MessageEvent<const Message>;

  static constexpr double kPollInterval = 0.05;             // seconds between two looks at the connections
  static constexpr std::chrono::milliseconds kRetry{500};   // between two fetches while the scene is not known
  static constexpr std::chrono::milliseconds kSettle{500};  // from the first fetch to the next: see fetch()
  static constexpr double kWatchPeriod = 0.1;               // seconds: between two looks at a long fetch
  // A fetch that takes longer is noticed if messages wait. MoveIt's own publisher collects changes for as long.
  static constexpr std::chrono::milliseconds kLongFetch{500};
  static constexpr double kLongestPeriod = 1e8;                // seconds; a longer period would overflow the clock
  static constexpr std::chrono::milliseconds kLongLoss{1000};  // after this time, a loss of the scene is logged

  void run()
  {
    while (!stopping_)
    {
      queue_.callAvailable(ros::WallDuration(kPollInterval));
      const std::string error = errorOf([this] { step(); });
      if (!error.empty())
        lose(error);
      logLongLoss();
    }
    ended_ = true;
  }

  void step()
  {
    if (!hasPublisher())
    {
      messages_.clear();
      return;
    }
    if (is_current_)
      applyMessages();
    if (Clock::now() < next_fetch_)
      return;
    // The fetched scene is newer than all messages that have arrived before the request.
    queue_.callAvailable();
    if (is_current_)
      applyMessages();
    messages_.clear();
    fetch();
  }

  bool hasPublisher()
  {
    const std::uint32_t publishers = subscriber_.getNumPublishers();
    if (publishers == 0)
      lose("no node publishes " + options_.topic);
    else if (publishers > 1)
      lose("several nodes publish " + options_.topic);
    else if (is_current_ && !isConnected())
      lose("the connection to " + options_.service + " was lost");
    return publishers == 1;
  }

  /// The connection to the service stays open, so that the end of its node is noticed.
  bool isConnected() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return client_.isValid();
  }

  void applyMessages()
  {
    std::vector<Event> messages;
    messages.swap(messages_);
    for (const Event& event : messages)
    {
      if (event.getConnectionHeaderPtr() != header_)
      {
        const bool is_first = header_ == nullptr;
        header_ = event.getConnectionHeaderPtr();
        if (!is_first)
        {
          lose("the connection to the publisher of " + options_.topic + " was made anew");
          return;
        }
      }
      const std::string error = errorOf(
          [&]
          {
            const Message& message = *event.getConstMessage();
            message.requireRead();
            apply(message.message);
          });
      if (error.empty())
        continue;
      lose("a message on " + options_.topic + " cannot be applied: " + error);
      return;
    }
  }

  std::string unknown(const std::string& reason) const
  {
    return "the scene of " + options_.node + " is not known: " + reason;
  }

  /// From now on, requests are refused with this reason.
  void lose(const std::string& reason)
  {
    if (is_current_)
      next_fetch_ = lost_at_ = Clock::now();
    is_current_ = false;
    const std::lock_guard<std::mutex> lock(mutex_);
    fault_ = unknown(reason);
  }

  void logLongLoss()
  {
    const std::string reason = fault();
    if (is_current_ || Clock::now() - lost_at_ < kLongLoss || reason == logged_)
      return;
    ROS_WARN_STREAM(reason << "; checks, plans and changes are refused");
    logged_ = reason;
  }

  void fetch()
  {
    Request asked = request();
    Bounded<Response> response;
    const bool was_answered = call(asked, response);
    next_fetch_ = Clock::now() + kRetry;
    std::string error;
    if (!was_answered)
      error = options_.service + " does not answer";
    else if (!response.fault.empty())
      error = "the answer of " + options_.service + " cannot be read: " + response.fault;
    else
      error = errorOf([&] { take(response.message); });
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_fetching_ = false;
    }
    if (error.empty())
    {
      // A publisher needs a moment to send its messages to a new subscriber. So the first fetch is soon followed by
      // another one.
      const std::chrono::duration<double> period(std::min(options_.period, kLongestPeriod));
      const bool is_settled = is_current_;
      next_fetch_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       is_settled ? period : std::min<std::chrono::duration<double>>(period, kSettle));
      is_current_ = true;
      was_current_ = true;
      logged_.clear();
      const std::lock_guard<std::mutex> lock(mutex_);
      fault_.clear();
      return;
    }
    lose(error);
  }

  bool call(Request& asked, Bounded<Response>& response)
  {
    ros::ServiceClient client;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      client = client_;
      is_calling_ = is_fetching_ = true;
      call_began_ = Clock::now();
    }
    if (!client.isValid())
    {
      // It connects at once, which can take long. So it is made without the lock.
      ros::ServiceClientOptions service(options_.service, ros::service_traits::md5sum<GetScene>(), true, {});
      client = node_.serviceClient(service);
      const std::lock_guard<std::mutex> lock(mutex_);
      client_ = client;
    }
    const bool was_answered = client.isValid() && client.call(asked, response, ros::service_traits::md5sum<GetScene>());
    const std::lock_guard<std::mutex> lock(mutex_);
    is_calling_ = false;
    // roscpp counts a connection as valid if it ends while it is being made.
    if (!was_answered)
    {
      client_.shutdown();
      client_ = ros::ServiceClient();
    }
    return was_answered;
  }

  void endLongCall()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_calling_ && Clock::now() - call_began_ > std::chrono::duration<double>(options_.timeout))
      client_.shutdown();
  }

  const FollowOptions options_;
  mutable ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::NodeHandle& timers_;
  ros::Subscriber subscriber_;

  // Used by the thread only.
  std::vector<Event> messages_;              // received and not applied yet
  boost::shared_ptr<ros::M_string> header_;  // of the connection of the last message
  bool is_current_ = false;
  bool was_current_ = false;
  Clock::time_point next_fetch_ = Clock::now();
  Clock::time_point lost_at_ = Clock::now();
  std::string logged_;  // the last reason in the log

  mutable std::mutex mutex_;  // guards the members below
  std::string fault_;
  ros::ServiceClient client_;
  bool is_calling_ = false;
  bool is_fetching_ = false;
  Clock::time_point call_began_;

  std::atomic<bool> stopping_{false};
  std::atomic<bool> ended_{false};
  ros::WallTimer timer_;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
