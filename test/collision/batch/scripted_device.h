#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "collision/batch/batch_device.h"
#include "collision/batch/device_parts.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
/// A cart on a rail from x = -1 m to 1 m, and a wall that it hits at x = `side` * 0.5 m, but not on the other side.
inline std::shared_ptr<const PlanningScene> cartScene(double side, std::uint64_t revision)
{
  static const auto robot = robotOf(R"(
    <link name="rail"/>
    <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>)");
  PlanningScene scene(robot);
  scene.objects.push_back(
      {"wall", Eigen::Isometry3d(Eigen::Translation3d(0.55 * side, 0.0, 0.0)), {{Box{{0.9, 1, 1}}}}});
  scene.revision = revision;
  return std::make_shared<const PlanningScene>(scene);
}

/// Controls and records devices that know the answers of cartScene.
struct DeviceScript
{
  using Step = std::function<void()>;  // throws, or waits, or does nothing

  std::mutex mutex;                               // guards the members below
  std::deque<Step> opens, prepares, parts, ends;  // one step for each of the next calls; calls without a step just run
  std::string name = "a device";
  std::string fault;
  bool is_software = false;
  std::size_t part_size = 256;
  std::vector<std::size_t> undecided;  // states that the device leaves undecided
  int opened = 0;
  int alive = 0;
  std::atomic<std::size_t> states{0};  // that were answered
  std::vector<std::thread::id> destroyed_on;

  void next(std::deque<Step>& steps)
  {
    Step step;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (steps.empty())
        return;
      step = std::move(steps.front());
      steps.pop_front();
    }
    if (step)
      step();
  }
};

class ScriptedDevice : public BatchDevice
{
 public:
  explicit ScriptedDevice(std::shared_ptr<DeviceScript> script) : script_(std::move(script))
  {
    script_->next(script_->opens);
    const std::lock_guard<std::mutex> lock(script_->mutex);
    ++script_->opened;
    ++script_->alive;
  }
  ~ScriptedDevice() override
  {
    script_->next(script_->ends);
    const std::lock_guard<std::mutex> lock(script_->mutex);
    --script_->alive;
    script_->destroyed_on.push_back(std::this_thread::get_id());
  }

  void prepare(const DeviceTask& task) override
  {
    side_ = 0.0;
    script_->next(script_->prepares);
    side_ = task.scene->world.at(0).pose.translation().x() > 0.0 ? 1.0 : -1.0;
    body_ = task.scene->world.at(0).body;
  }

  void check(DeviceParts& parts) override
  {
    for (StateRange part = parts.take(size()); part.count != 0; part = parts.take(size()))
    {
      script_->next(script_->parts);
      states_.resize(part.count);
      parts.copy(part, states_.data());
      first_ = part.begin;
      const std::size_t piece = part.count > 2 ? part.count / 2 : part.count;  // a part may be brought in pieces
      for (const StateRange& brought :
           {StateRange{part.begin, piece}, StateRange{part.begin + piece, part.count - piece}})
        bring(brought, parts);
    }
  }

  std::string name() const override { return script_->name; }
  bool isSoftware() const override { return script_->is_software; }
  std::string fault() const override
  {
    const std::lock_guard<std::mutex> lock(script_->mutex);
    return script_->fault;
  }

 private:
  std::size_t size() const
  {
    const std::lock_guard<std::mutex> lock(script_->mutex);
    return script_->part_size;
  }
  void bring(const StateRange& brought, DeviceParts& parts)
  {
    if (brought.count == 0)
      return;
    const StateRange mine = parts.beginAnswer(brought);
    std::vector<std::size_t> open;
    for (std::size_t i = mine.begin; i < mine.end(); ++i)
      answer(i, parts, open);
    script_->states += mine.count;
    if (mine.count != 0)
      parts.endAnswer(mine, open);
  }
  void answer(std::size_t i, DeviceParts& parts, std::vector<std::size_t>& open)
  {
    const std::lock_guard<std::mutex> lock(script_->mutex);
    if (std::find(script_->undecided.begin(), script_->undecided.end(), i) != script_->undecided.end())
      return open.push_back(i);
    const double margin = parts.margins() ? *parts.margins()->of(i) : 0.0;
    if (states_[i - first_] * side_ < -margin)
      return;
    parts.result().valid[i] = 0;
    parts.result().colliding[i] = {1, body_};
  }

  std::shared_ptr<DeviceScript> script_;
  std::vector<double> states_;  // of the part
  std::size_t first_ = 0;       // of them
  double side_ = 0.0;           // 0: not prepared
  std::int32_t body_ = 0;
};

/// `count` states; each third one is at x = 0.5 m, the others at x = -0.5 m.
inline std::vector<double> cartStates(std::size_t count)
{
  std::vector<double> states(count, -0.5);
  for (std::size_t i = 0; i < count; i += 3)
    states[i] = 0.5;
  return states;
}

inline std::vector<std::uint8_t> cartAnswers(const std::vector<double>& states, double side)
{
  std::vector<std::uint8_t> valid;
  for (const double x : states)
    valid.push_back(x * side < 0.0 ? 1 : 0);
  return valid;
}
}  // namespace gpu_planning_scene::core
