#include "node/sensors/sensor_record.h"

#include <algorithm>
#include <utility>

#include <ros/this_node.h>

#include "base/text/number_text.h"

namespace gpu_planning_scene::core
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

constexpr double kLongestSilence = 1.0;  // seconds
constexpr double kShownLoss = 10.0;      // seconds: statuses are published each second, and measurements more often
constexpr double kLoggedSilence = 5.0;   // seconds: drivers of cameras may start after the node
}  // namespace

void SensorRecord::use(double its_lag)
{
  ++used;
  has_measured = true;
  used_at = ros::SteadyTime::now();
  silence_is_logged = false;
  fault.clear();
  lag = its_lag;
  longest_lag = std::max(longest_lag, lag);
}

void SensorRecord::lose(const std::string& what)
{
  loss = what;
  lost_at = ros::SteadyTime::now();
}

void SensorRecord::forget()
{
  has_measured = false;
  loss.clear();
}

void SensorRecord::reject(const std::string& why)
{
  ++rejected;
  fault = why;
}

std::string SensorRecord::octomapFault(const std::string& topic, double seconds) const
{
  if (!loss.empty())
    return "sensor " + topic + ": " + loss;
  const double silent = (ros::SteadyTime::now() - used_at).toSec();
  if (seconds == 0.0 || (has_measured && silent <= seconds))
    return "";
  return "the octomap may be out of date: no measurement of sensor " + topic + " was used " +
         (has_measured ? "for " + numberText(silent) + " s"
          : used > 0   ? "since the octomap was cleared"
                       : "yet") +
         (fault.empty() ? "" : "; the last one was rejected: " + fault);
}

std::string SensorRecord::silence(const std::string& topic)
{
  if (silence_is_logged || (ros::SteadyTime::now() - used_at).toSec() < kLoggedSilence)
    return "";
  silence_is_logged = true;
  return "sensor " + topic + ": " +
         (!fault.empty() ? "no measurement could be used for 5 s, the last one because of: " + fault
                         : "no measurement came for 5 s, so the octomap does not follow it; is the topic published? "
                           "rostopic info " +
                               topic + " lists its publishers");
}

DiagnosticStatus SensorRecord::status(const std::string& topic)
{
  DiagnosticStatus status;
  status.name = ros::this_node::getName().substr(1) + ": sensor " + topic;
  status.level = DiagnosticStatus::OK;
  status.message = "measures";
  if (!fault.empty())
  {
    status.level = DiagnosticStatus::ERROR;
    status.message = "the octomap does not follow this sensor: " + fault;
  }
  else if (!loss.empty() && (ros::SteadyTime::now() - lost_at).toSec() < kShownLoss)
  {
    status.level = DiagnosticStatus::ERROR;
    status.message = loss;
  }
  else if (used == 0 || (ros::SteadyTime::now() - used_at).toSec() > kLongestSilence)
  {
    status.level = DiagnosticStatus::WARN;
    status.message = "no measurement for more than a second";
  }
  const auto add = [&status](const std::string& key, const std::string& value)
  {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = value;
  };
  add("used", std::to_string(used));
  add("dropped", std::to_string(dropped));
  add("rejected", std::to_string(rejected));
  add("lag", std::to_string(lag));
  add("longest_lag", std::to_string(std::exchange(longest_lag, 0.0)));
  return status;
}
}  // namespace gpu_planning_scene::core
