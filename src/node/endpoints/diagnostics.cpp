#include "node/endpoints/diagnostics.h"

#include <algorithm>

#include <ros/console.h>
#include <ros/this_node.h>

#include "base/text/one_line.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/body_parts.h"
#include "service/memory_guard.h"

namespace gpu_planning_scene::core
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

/// The number of parts of meshes that bound no solid.
std::size_t surfaceParts(const PlanningScene& scene)
{
  const std::vector<BodyPart> parts = openParts(scene);
  return static_cast<std::size_t>(std::count_if(
      parts.begin(), parts.end(), [](const BodyPart& entry) { return entry.part.kind == PartKind::Surface; }));
}

void add(DiagnosticStatus& status, const std::string& key, const std::string& value)
{
  status.values.emplace_back();
  status.values.back().key = key;
  status.values.back().value = value;
}

/// The sum of the device histories of all checkers.
DeviceHistory sumOf(const std::vector<std::shared_ptr<const StateChecker>>& checkers)
{
  DeviceHistory sum;
  for (const auto& checker : checkers)
  {
    const auto* with_devices = dynamic_cast<const BatchChecker*>(checker.get());
    if (with_devices == nullptr)
      continue;
    const DeviceHistory history = with_devices->history();
    sum.losses += history.losses;
    sum.rebuilds += history.rebuilds;
    sum.batches_on_cpu += history.batches_on_cpu;
    sum.on_cpu = sum.on_cpu || history.on_cpu;
    sum.rebuild_failed = sum.rebuild_failed || (history.on_cpu && history.rebuild_failed);
    if (!history.last_error.empty())
      sum.last_error = shortLine(history.last_error);
  }
  return sum;
}
}  // namespace

MakeChecker Diagnostics::watched(const MakeChecker& make)
{
  return [this, make](const std::shared_ptr<const PlanningScene>& scene)
  {
    std::shared_ptr<StateChecker> checker = make(scene);
    const std::lock_guard<std::mutex> lock(mutex_);
    checkers_.push_back(checker);
    return checker;
  };
}

void Diagnostics::watchScene(std::function<std::string()> fault)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  scene_fault_ = std::move(fault);
}

void Diagnostics::refused(const std::string& why)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++refused_;
  last_refusal_ = shortLine(why);
}

void Diagnostics::logDevice(const std::string& fault)
{
  if (fault == logged_fault_)
    return;
  if (fault.empty())
    ROS_INFO("the device is used again");
  else
    ROS_WARN_STREAM(fault << "; the answers stay the same");
  logged_fault_ = fault;
}

DiagnosticStatus Diagnostics::status(const SceneStore& store, const CheckServer& server)
{
  const CheckStatistics checks = server.statistics();
  const std::shared_ptr<const PlanningScene> scene = store.snapshot().scene;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::shared_ptr<const StateChecker>> checkers;
  for (const auto& weak : checkers_)
    if (auto checker = weak.lock())
      checkers.push_back(std::move(checker));
  checkers_.assign(checkers.begin(), checkers.end());
  const DeviceHistory history = sumOf(checkers);

  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - at_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(checks.states - states_) / seconds : 0.0;
  states_ = checks.states;
  at_ = now;

  DiagnosticStatus status;
  status.name = ros::this_node::getName().substr(1) + ": checks";
  status.hardware_id = checkers.empty() ? "" : checkers.front()->deviceName();
  status.level = DiagnosticStatus::OK;
  status.message = "checks states";
  const std::string device_fault =
      history.on_cpu ? "the device failed and the CPU is used: " + history.last_error : std::string();
  if (history.on_cpu)
  {
    status.level = history.rebuild_failed ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN;
    status.message = device_fault;
  }
  logDevice(device_fault);
  const std::string scene_fault = scene_fault_ ? scene_fault_() : "";
  if (!scene_fault.empty())
  {
    status.level = DiagnosticStatus::ERROR;
    status.message = scene_fault;
  }
  add(status, "scene_fault", scene_fault);
  add(status, "device", status.hardware_id);
  add(status, "on_cpu", history.on_cpu ? "true" : "false");
  add(status, "device_losses", std::to_string(history.losses));
  add(status, "device_rebuilds", std::to_string(history.rebuilds));
  add(status, "batches_on_cpu", std::to_string(history.batches_on_cpu));
  add(status, "last_device_error", history.last_error);
  add(status, "requests", std::to_string(checks.requests));
  add(status, "batches", std::to_string(checks.batches));
  add(status, "states", std::to_string(checks.states));
  add(status, "states_per_second", std::to_string(rate));
  add(status, "undecided", std::to_string(checks.undecided));
  add(status, "waiting_requests", std::to_string(checks.waiting_requests));
  add(status, "waiting_states", std::to_string(checks.waiting_states));
  add(status, "busy", std::to_string(checks.busy));
  add(status, "errors", std::to_string(checks.errors));
  add(status, "refused", std::to_string(refused_));
  add(status, "last_refusal", last_refusal_);
  add(status, "scene_revision", std::to_string(scene->revision));
  add(status, "objects", std::to_string(scene->objects.size()));
  add(status, "attached_objects", std::to_string(scene->attached.size()));
  add(status, "surface_parts", std::to_string(surfaceParts(*scene)));
  add(status, "memory", std::to_string(residentMemory()));
  return status;
}

DiagnosticsPublisher::DiagnosticsPublisher(ros::NodeHandle& node, Diagnostics& diagnostics, const SceneStore& store,
                                           const CheckServer& server)
  : publisher_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10))
{
  timer_ = node.createWallTimer(
      ros::WallDuration(1.0),
      [this, &diagnostics, &store, &server](const ros::WallTimerEvent&)
      {
        diagnostic_msgs::DiagnosticArray message;
        message.header.stamp = ros::Time::now();
        message.status.push_back(diagnostics.status(store, server));
        publisher_.publish(message);
      });
}
}  // namespace gpu_planning_scene::core
