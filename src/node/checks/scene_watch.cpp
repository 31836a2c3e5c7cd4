#include "node/checks/scene_watch.h"

#include <algorithm>
#include <chrono>

#include <ros/console.h>

#include "base/text/one_line.h"
#include "collision/report/scene_text.h"
#include "model/full_states.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kPeriod = 1.0;  // seconds

CheckJob reportJob()
{
  CheckJob job;
  job.report = true;
  return job;
}
}  // namespace

SceneWatch::SceneWatch(ros::NodeHandle& own, const SceneStore& store, CheckServer& server)
  : store_(store), server_(server)
{
  const CheckAnswer answer = server.submit(reportJob()).get();
  for (const std::string& line : describeScene(*answer.scene, *answer.report, answer.device))
    ROS_INFO_STREAM(line);
  take(answer);
  timer_ = own.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { look(); });
}

/// Never waits, because other timers share the thread. Ignores errors of the checker: the requests of clients get
/// the same errors as their answers.
void SceneWatch::look()
{
  warnOfPassiveJoints();
  try
  {
    if (!answer_.valid() && store_.snapshot().scene->revision != revision_)
      answer_ = server_.submit(reportJob());
    else if (answer_.valid() && answer_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      take(answer_.get());
  }
  catch (const std::exception& error)
  {
    ROS_DEBUG_STREAM("no report of the new scene: " << error.what());
  }
}

/// Warns once: as soon as requests need not name all joints, because the current state is known but for passive joints.
void SceneWatch::warnOfPassiveJoints()
{
  if (has_warned_of_passive_joints_)
    return;
  const Snapshot now = store_.snapshot();
  const std::vector<bool> known = now.partialState().known;
  if (std::find(known.begin(), known.end(), false) != known.end())
    return;
  has_warned_of_passive_joints_ = true;
  if (const std::string warning = assumedPassiveJoints(*now.scene->robot, now.known); !warning.empty())
    ROS_WARN_STREAM(shortLine(warning));
}

void SceneWatch::take(const CheckAnswer& answer)
{
  std::vector<std::string> warnings = warningsOfScene(*answer.scene, *answer.report);
  for (const std::string& warning : warnings)
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
      ROS_WARN_STREAM(shortLine(warning));
  warnings_ = std::move(warnings);
  revision_ = answer.scene->revision;
}
}  // namespace gpu_planning_scene::core
