#include "gpu_planning_scene/client/sharded_checker.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gpu_planning_scene/GetPlanningScene.h>
#include <gpu_planning_scene/GetReport.h>
#include <gpu_planning_scene/PlanningSceneComponents.h>

#include "client/answers.h"
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
using CancelTest = std::function<bool()>;

constexpr std::size_t kPartsPerNode = 2;         // or more, so that a slow node does not hold up the others
constexpr std::size_t kUnsplitStates = 4096;     // of a request for one node: fewer are not worth the threads
constexpr std::size_t kLeastPart = 2048;         // states
constexpr std::chrono::milliseconds kPause{20};  // before a busy node is asked again
constexpr std::chrono::milliseconds kRetry{50};  // between two rounds with all nodes

/// Throws Error.
void require(const ShardedCheckerOptions& options)
{
  if (options.part_states == 0)
    throw Error("part_states is 0; a part needs at least one state");
  if (!(options.timeout > 0.0))  // also not a number
    throw Error("timeout is not a positive number of seconds");
  if (!(options.patience >= 0.0))
    throw Error("patience is not a number of seconds of at least 0");
}
}  // namespace

struct ShardedChecker::Impl
{
  Impl(const std::vector<std::string>& names, const ShardedCheckerOptions& chosen) : options(chosen)
  {
    if (names.empty())
      throw Error("a ShardedChecker needs at least one node; give the name of the leader first");
    require(options);
    for (const std::string& name : names)
      nodes.push_back(std::make_unique<NodeConnections>(name, options.timeout));
  }

  /// The revision and the robot's state of the first node that gives them. No value: `failure` has the last reason.
  std::optional<CommonState> findCommonState(const CancelTest& is_cancelled, Failure& failure)
  {
    gpu_planning_scene::GetPlanningScene::Request request;
    request.components.components = gpu_planning_scene::PlanningSceneComponents::ROBOT_STATE;
    for (const auto& node : nodes)
      try
      {
        const auto answer =
            node->call<gpu_planning_scene::GetPlanningScene>("get_planning_scene", request, is_cancelled);
        const std::uint64_t revision = answer.scene.scene_revision;
        // A replica may lag behind. The leader's revisions begin anew when it starts again.
        if (answer.success && revision != 0 && isNewEnough(revision, node == nodes.front()))
          return commonStateOf(answer.scene);
        const std::string why = !answer.success ? answer.message
                                : revision == 0 ? "it has no revision"
                                                : "it has revision " + std::to_string(revision) + ", but revision " +
                                                      std::to_string(newest) + " was there before";
        failure = {answer.success ? Failure().status : answer.status, node->node() + ": its scene is missing: " + why};
      }
      catch (const NoAnswer& fault)
      {
        failure = noAnswerOf(node->node(), std::string("its scene is missing: ") + fault.what()).failure;
      }
    return std::nullopt;
  }

  /// Only the leader may go back to a lower revision.
  bool isNewEnough(std::uint64_t revision, bool is_leader)
  {
    std::uint64_t known = newest;
    do
    {
      if (revision < known && !is_leader)
        return false;
    } while (!newest.compare_exchange_weak(known, revision));
    return true;
  }

  /// The number of variables of the robot; 0 if no node reports it.
  std::size_t variableCount(const CancelTest& is_cancelled)
  {
    for (const auto& node : nodes)
    {
      if (variables != 0)
        break;
      try
      {
        const auto report = node->call<gpu_planning_scene::GetReport>("get_report", {}, is_cancelled);
        if (!report.success)
          continue;
        const auto name = std::find(report.names.begin(), report.names.end(), "variables");
        const auto index = static_cast<std::size_t>(name - report.names.begin());
        if (index < report.values.size())
          variables = static_cast<std::size_t>(report.values[index]);
      }
      catch (const NoAnswer&)
      {
        continue;  // the next node is asked
      }
    }
    return variables;
  }

  std::vector<Request> split(const Request& request, const CommonState& common, const CancelTest& is_cancelled)
  {
    std::vector<Request> parts;
    if (const std::size_t states = plainStates(request); states != 0)
    {
      const std::size_t wanted = kPartsPerNode * nodes.size();
      const std::size_t even = std::max(kLeastPart, (states + wanted - 1) / wanted);
      parts = partsOf(request, common, variableCount(is_cancelled),
                      states <= kUnsplitStates ? states : std::min(even, options.part_states));
    }
    if (parts.empty())
    {
      parts.push_back(request);
      parts.back().scene_revision = common.revision;
    }
    return parts;
  }

  const ShardedCheckerOptions options;
  std::vector<std::unique_ptr<NodeConnections>> nodes;
  std::atomic<std::size_t> next{0};       // the node that gets the next request that is not split
  std::atomic<std::size_t> variables{0};  // of the robot; 0: not known yet
  std::atomic<std::uint64_t> newest{0};   // revision of the scene
};

/// One call of check().
class ShardedChecker::Call
{
 public:
  Call(Impl& checker, const Request& request, const CancelTest& is_cancelled)
    : checker_(checker),
      request_(request),
      is_cancelled_(is_cancelled),
      patience_(durationOf(checker.options.patience)),
      until_(Clock::now() + patience_)
  {
  }

  /// Rounds with all nodes, until the whole request is answered, or nothing will help, or the patience is over.
  Response answer()
  {
    for (;;)
    {
      if (is_cancelled_ && is_cancelled_())
        throw Cancelled();
      if (hasWork())
      {
        Failures failures;
        if (serveAll(failures))
          return joined(request_, work_->takeAnswers());
        failure_ = failures.reported();
        if (failures.areFinal() && (request_.scene_revision != 0 || !failures.lackScene()))
          return responseOf(failure_);
        // The next round begins with the newest scene, unless the request names another one.
        if (failures.lackScene() && request_.scene_revision == 0)
          work_.reset();
      }
      if (Clock::now() > until_)
        return responseOf({failure_.status, "no node can answer; the last reason: " + failure_.message});
      std::this_thread::sleep_for(kRetry);
    }
  }

 private:
  /// Whether there are parts. Makes them if a node gives its scene.
  bool hasWork()
  {
    if (work_)
      return true;
    std::optional<CommonState> common = checker_.findCommonState(is_cancelled_, failure_);
    if (!common)
      return false;
    if (request_.scene_revision != 0)
      common->revision = request_.scene_revision;
    work_ = std::make_unique<SharedWork>(checker_.split(request_, *common, is_cancelled_));
    return true;
  }

  /// A round with all nodes. Returns whether all parts are answered.
  bool serveAll(Failures& failures)
  {
    const std::size_t answered = work_->answeredCount();
    const std::size_t first = checker_.next++;
    const auto node = [&](std::size_t i) -> NodeConnections&
    { return *checker_.nodes[(first + i) % checker_.nodes.size()]; };
    if (work_->count() == 1)
      for (std::size_t i = 0; i < checker_.nodes.size() && !work_->isComplete(); ++i)
        serve(node(i), failures);
    else
    {
      std::vector<std::future<void>> threads;
      for (std::size_t i = 0; i < checker_.nodes.size(); ++i)
        threads.push_back(std::async(std::launch::async, [&, i] { serve(node(i), failures); }));
      for (std::future<void>& thread : threads)
        thread.get();
    }
    if (work_->answeredCount() > answered)
      until_ = Clock::now() + patience_;
    return work_->isComplete();
  }

  /// Sends parts to one node until all are answered or the node fails. If it throws, no node gets further parts.
  void serve(NodeConnections& node, Failures& failures)
  {
    try
    {
      while (const std::optional<std::size_t> part = work_->take())
      {
        Answer answer = answerTo(work_->part(*part), node);
        if (answer.outcome == Outcome::Answered)
        {
          work_->answer(*part, std::move(answer.response));
          continue;
        }
        work_->giveBack(*part);
        if (!asksAgain(answer.outcome))
        {
          failures.add(answer.outcome, answer.failure);
          return;
        }
        std::this_thread::sleep_for(kPause);
      }
    }
    catch (...)
    {
      work_->stop();
      throw;
    }
  }

  /// Whether a node gets parts in this round after such an outcome. A busy node does, while other threads serve the
  /// other nodes. But a single part goes to the next node at once.
  bool asksAgain(Outcome outcome) const
  {
    return outcome == Outcome::Busy && work_->count() > 1 && Clock::now() <= until_;
  }

  Answer answerTo(const Request& part, NodeConnections& node) const
  {
    try
    {
      return answerOf(node.node(), node.call<gpu_planning_scene::CheckStates>("check_states", part, is_cancelled_),
                      part.scene_revision);
    }
    catch (const NoAnswer& fault)
    {
      return noAnswerOf(node.node(), fault.what());
    }
  }

  Impl& checker_;
  const Request& request_;
  const CancelTest& is_cancelled_;
  const Clock::duration patience_;
  Clock::time_point until_;  // the patience ends
  std::unique_ptr<SharedWork> work_;
  Failure failure_;  // the last one
};

ShardedChecker::ShardedChecker(const std::vector<std::string>& nodes, const ShardedCheckerOptions& options)
  : impl_(std::make_unique<Impl>(nodes, options))
{
}

ShardedChecker::~ShardedChecker() = default;

ShardedChecker::Response ShardedChecker::check(const Request& request, const std::function<bool()>& is_cancelled)
{
  return Call(*impl_, request, is_cancelled).answer();
}
}  // namespace gpu_planning_scene::core
