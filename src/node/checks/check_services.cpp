#include "node/checks/check_services.h"

#include <chrono>
#include <future>
#include <utility>

#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kInspections = 2;                    // at the same time
constexpr std::chrono::milliseconds kPollInterval{100};    // interval in which a waiting request checks for shutdown
constexpr std::chrono::milliseconds kShutdownGrace{4000};  // longest wait for the checker during a shutdown
}  // namespace

CheckServices::CheckServices(const SceneStore& store, CheckServer& server, const MemoryGuard& memory,
                             const CheckServicesOptions& options, OtherFrames others)
  : store_(store),
    server_(server),
    memory_(memory),
    options_(options),
    others_(std::move(others)),
    inspections_(kInspections, options.max_waiting_inspections),
    revision_waits_(options.max_revision_waits, 0)
{
}

void CheckServices::stop()
{
  stopping_ = true;
  inspections_.stop();
  revision_waits_.stop();
}

/// The scene that a request names by its revision; no value: the request names none (0).
std::optional<Snapshot> CheckServices::wantedScene(std::uint64_t revision)
{
  if (revision == 0)
    return std::nullopt;
  std::optional<Admission::Pass> pass;
  if (revision > store_.snapshot().scene->revision)
    pass.emplace(revision_waits_);
  return store_.at(revision, std::chrono::steady_clock::now() + options_.revision_wait,
                   [this] { return stopping_.load(); });
}

/// Waits for the answer. After the start of the shutdown, the wait is bounded, because the checker may hang.
CheckAnswer CheckServices::answerOf(CheckJob job) const
{
  std::future<CheckAnswer> answer = server_.submit(std::move(job));
  std::chrono::milliseconds waited{0};  // since the start of the shutdown
  while (answer.wait_for(kPollInterval) != std::future_status::ready)
  {
    waited += stopping_ ? kPollInterval : std::chrono::milliseconds{0};
    if (waited >= kShutdownGrace)
      throw ShuttingDown();
  }
  return answer.get();
}
}  // namespace gpu_planning_scene::core
