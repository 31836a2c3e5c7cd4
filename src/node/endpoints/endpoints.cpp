#include "node/endpoints/endpoints.h"

#include <boost/make_shared.hpp>

#include "base/text/one_line.h"

namespace gpu_planning_scene::core
{
namespace
{
// An answer is written within this time, on a thread of roscpp.
constexpr std::chrono::milliseconds kTimeToWrite{500};

// A callback ends a wait, and stop() adds one for each thread. Hundreds of threads wait here. If they all woke for
// nothing twice a second, they would delay a request by milliseconds. The wait has an end because glibc may lose a
// wake-up of a condition variable with many waiting threads (glibc bug 25847).
const ros::WallDuration kLongWait(30.0);

/// Wakes a thread that waits for a callback.
class WakeUp : public ros::CallbackInterface
{
 public:
  CallResult call() override { return Success; }
};
}  // namespace

Endpoints::Endpoints(const ros::NodeHandle& node, const ros::NodeHandle& own, std::size_t threads,
                     Diagnostics& diagnostics, Precondition precondition)
  : node_(node), own_(own), diagnostics_(diagnostics), precondition_(std::move(precondition))
{
  node_.setCallbackQueue(&queue_);
  own_.setCallbackQueue(&queue_);
  threads_.reserve(threads);
  for (std::size_t i = 0; i < threads; ++i)
    threads_.emplace_back(
        [this]
        {
          while (!closed_)
            queue_.callOne(kLongWait);
        });
}

Endpoints::~Endpoints()
{
  stop();
}

void Endpoints::close()
{
  if (!closed_.exchange(true))
    closed_at_ = std::chrono::steady_clock::now();
}

/// Services and topics stay up until the destructor: to take them down drops connections, to which roscpp may still be
/// writing answers.
void Endpoints::stop()
{
  close();
  for (std::size_t i = 0; i < threads_.size(); ++i)  // a callback wakes one thread
    queue_.addCallback(boost::make_shared<WakeUp>());
  for (std::thread& thread : threads_)
    thread.join();
  threads_.clear();
  refuseWaiting();
}

bool Endpoints::refuseWaiting()
{
  queue_.callAvailable();
  return closed_at_ < last_answer_.load() + kTimeToWrite;
}

std::string Endpoints::topicName(const std::string& name) const
{
  return name.front() == '~' ? own_.resolveName(name.substr(1)) : node_.resolveName(name);
}

void Endpoints::refuse(const std::string& topic, const std::string& why)
{
  const std::string line = topic + ": " + shortLine(why);
  diagnostics_.refused(line);
  ROS_WARN_STREAM_THROTTLE(1.0, "message rejected on " << line);
}

void Endpoints::refuseRequest(const std::string& service, const std::string& why)
{
  const std::string line = own_.resolveName(service) + ": " + shortLine(why);
  diagnostics_.refused(line);
  ROS_WARN_STREAM_THROTTLE(1.0, "request refused on " << line);
}

void Endpoints::reportLost(const std::string& topic, const std::string& why)
{
  const std::string line = topic + ": " + shortLine(why);
  diagnostics_.refused(line);
  ROS_ERROR_STREAM_THROTTLE(1.0, "message lost on " << line);
}
}  // namespace gpu_planning_scene::core
