#include "gpu_planning_scene/client/sharded_checker.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gpu_planning_scene/GetPlanningScene.h>
#include <gpu_planning_scene/GetReport.h>
#include <gpu_planning_scene/PlanningSceneComponents.h>
#include <gpu_planning_scene/Status.h>

#include "client/node_connections.h"
#include "client/request_parts.h"
#include "client/shared_work.h"
#include "gpu_planning_scene/error.h"

// A thread for each node takes one part after the other, so faster nodes get more parts (self-scheduling). A part that
// a node does not answer is taken by the thread of another node. All parts name one revision of the scene. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;
using Request = ShardedChecker::Request;
using Response = ShardedChecker::Response;
using gpu_planning_scene::Status;

constexpr std::size_t kPartsPerNode = 2;         // or more, so that a slow node does not hold up the others
constexpr std::size_t kUnsplitStates = 4096;     // of a request for one node: fewer are not worth the threads
constexpr std::size_t kLeastPart = 2048;         // states
constexpr std::chrono::milliseconds kPause{20};  // before a busy node is asked again
constexpr std::chrono::milliseconds kRetry{50};  // between two rounds with all nodes

enum class Outcome
{
  Answered,
  Unable,       ///< the node cannot answer now
  Busy,         ///< it can answer soon
  OtherScenes,  ///< it does not have the revision
  Refused       ///< it does not accept the request
};

/// See Status.msg. A node with an internal error counts as one that refuses the request: other nodes get the request
/// too, but if all of them fail, the client does not try again and again.
Outcome outcomeOf(const Response& response, std::uint64_t revision)
{
  switch (response.status)
  {
    case Status::OK:
      return revision == 0 || response.scene_revision == revision ? Outcome::Answered : Outcome::OtherScenes;
    case Status::BUSY:
      return Outcome::Busy;
    case Status::UNKNOWN_REVISION:
      return Outcome::OtherScenes;
    case Status::SHUTTING_DOWN:
    case Status::UNAVAILABLE:
      return Outcome::Unable;
    default:
      return Outcome::Refused;
  }
}

/// Why there is no answer.
struct Failure
{
  std::uint8_t status = Status::UNAVAILABLE;
  std::string message;
};

Response failed(const Failure& failure)
{
  Response response;
  response.success = 0;
  response.status = failure.status;
  response.message = failure.message;
  return response;
}

/// The errors of the nodes in a round after which parts of the request have no answer.
class Failures
{
 public:
  void add(Outcome outcome, const Failure& failure)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (outcome == Outcome::Refused)
      refusal_ = failure;
    else
      is_passing_ = true;
    lacks_scene_ = lacks_scene_ || outcome == Outcome::OtherScenes;
    last_ = failure;
  }

  bool lacksScene() const { return lacks_scene_; }
  /// The failure for the user.
  const Failure& reported() const { return refusal_ ? *refusal_ : last_; }
  /// Whether no other node and no later time will help.
  bool areFinal() const { return refusal_ && !is_passing_; }

 private:
  std::mutex mutex_;
  std::optional<Failure> refusal_;
  Failure last_;
  bool is_passing_ = false;
  bool lacks_scene_ = false;
};
}  // namespace

struct ShardedChecker::Impl
{
  Impl(std::vector<std::string> names, const ShardedCheckerOptions& chosen) : options(chosen), watch(chosen.timeout)
  {
    if (names.empty())
      throw Error("a ShardedChecker needs at least one node; give the name of the leader first");
    for (std::string& name : names)
      nodes.push_back(std::make_unique<NodeConnections>(std::move(name), watch));
  }

  /// The revision and the robot's state of the first node that answers. False if none does.
  bool findCommonState(CommonState& common)
  {
    gpu_planning_scene::GetPlanningScene::Request request;
    request.components.components = gpu_planning_scene::PlanningSceneComponents::ROBOT_STATE;
    for (const auto& node : nodes)
      if (gpu_planning_scene::GetPlanningScene::Response response;
          node->call<gpu_planning_scene::GetPlanningScene>("get_planning_scene", request, response))
      {
        common = commonStateOf(response.scene);
        return true;
      }
    return false;
  }

  /// The number of variables of the robot; 0 if no node reports it.
  std::size_t variableCount()
  {
    if (variables == 0)
      for (const auto& node : nodes)
      {
        gpu_planning_scene::GetReport::Response report;
        if (!node->call<gpu_planning_scene::GetReport>("get_report", {}, report) || !report.success)
          continue;
        const auto name = std::find(report.names.begin(), report.names.end(), "variables");
        if (name != report.names.end())
          variables = static_cast<std::size_t>(report.values[static_cast<std::size_t>(name - report.names.begin())]);
        break;
      }
    return variables;
  }

  std::vector<Request> split(const Request& request, const CommonState& common)
  {
    std::vector<Request> parts;
    if (const std::size_t states = plainStates(request); states != 0)
    {
      const std::size_t wanted = kPartsPerNode * nodes.size();
      const std::size_t even = std::max(kLeastPart, (states + wanted - 1) / wanted);
      parts = partsOf(request, common, variableCount(),
                      states <= kUnsplitStates ? states : std::min(even, options.part_states));
    }
    if (parts.empty())
    {
      parts.push_back(request);
      parts.back().scene_revision = common.revision;
    }
    return parts;
  }

  /// Sends parts to one node until all are answered or the node fails.
  void serve(NodeConnections& node, SharedWork& work, Failures& failures, Clock::time_point until)
  {
    while (const std::optional<std::size_t> part = work.take())
    {
      Response response;
      const bool was_answered = node.call<gpu_planning_scene::CheckStates>("check_states", work.part(*part), response);
      const Outcome outcome = was_answered ? outcomeOf(response, work.part(*part).scene_revision) : Outcome::Unable;
      if (outcome == Outcome::Answered)
      {
        work.answer(*part, std::move(response));
        continue;
      }
      work.giveBack(*part);
      if (outcome != Outcome::Busy || Clock::now() > until)
      {
        Failure failure;
        if (was_answered)
          failure.status = response.status;
        if (outcome == Outcome::OtherScenes)
          failure.status = Status::UNKNOWN_REVISION;
        failure.message = node.node() + ": " + (was_answered ? response.message : "the node does not answer");
        failures.add(outcome, failure);
        return;
      }
      std::this_thread::sleep_for(kPause);
    }
  }

  void serveAll(SharedWork& work, std::size_t parts, Failures& failures, Clock::time_point until)
  {
    const std::size_t first = next++ % nodes.size();
    const auto node = [&](std::size_t i) -> NodeConnections& { return *nodes[(first + i) % nodes.size()]; };
    if (parts == 1)
    {
      for (std::size_t i = 0; i < nodes.size() && !work.isComplete(); ++i)
        serve(node(i), work, failures, until);
      return;
    }
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      threads.emplace_back([&, i] { serve(node(i), work, failures, until); });
    for (std::thread& thread : threads)
      thread.join();
  }

  Response check(const Request& request)
  {
    const auto patience = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.patience));
    Clock::time_point until = Clock::now() + patience;
    std::unique_ptr<SharedWork> work;
    std::size_t parts = 0;
    Failure failure{Status::UNAVAILABLE, "no node gives its scene"};
    for (;;)
    {
      CommonState common;
      if (!work && findCommonState(common))
      {
        common.revision = request.scene_revision == 0 ? common.revision : request.scene_revision;
        std::vector<Request> made = split(request, common);
        parts = made.size();
        work = std::make_unique<SharedWork>(std::move(made));
      }
      if (work)
      {
        const std::size_t answered = work->answeredCount();
        Failures failures;
        serveAll(*work, parts, failures, until);
        if (work->isComplete())
          return joined(work->takeAnswers());
        failure = failures.reported();
        if (failures.areFinal())
          return failed(failure);
        if (work->answeredCount() > answered)
          until = Clock::now() + patience;
        // The next round begins with the newest scene, unless the request names another one.
        if (failures.lacksScene() && request.scene_revision == 0)
          work.reset();
      }
      if (Clock::now() > until)
        return failed({failure.status, "no node can answer; the last reason: " + failure.message});
      std::this_thread::sleep_for(kRetry);
    }
  }

  const ShardedCheckerOptions options;
  CallWatch watch;
  std::vector<std::unique_ptr<NodeConnections>> nodes;
  std::atomic<std::size_t> next{0};       // the node that gets the next request that is not split
  std::atomic<std::size_t> variables{0};  // of the robot; 0: not known yet
};

ShardedChecker::ShardedChecker(std::vector<std::string> nodes, const ShardedCheckerOptions& options)
  : impl_(std::make_unique<Impl>(std::move(nodes), options))
{
}

ShardedChecker::~ShardedChecker() = default;

ShardedChecker::Response ShardedChecker::check(const Request& request)
{
  return impl_->check(request);
}
}  // namespace gpu_planning_scene::core
