#include "node/sensors/sensors.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/this_node.h>

#include "base/text/number_text.h"
#include "gpu_planning_scene/octomap.h"
#include "node/endpoints/respond.h"
#include "node/sensors/measured_at.h"
#include "node/sensors/sensed_object.h"

namespace gpu_planning_scene::core
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

constexpr double kLongestSilence = 1.0;               // seconds
constexpr double kLargestAdvance = 1.0;               // seconds of a stamp before the node's clock
constexpr std::chrono::milliseconds kNextLookup{10};  // after which a missing frame is looked up again
constexpr std::chrono::milliseconds kRepublish{100};

const std_msgs::Header& headerOf(const std::variant<sensor_msgs::Image, sensor_msgs::PointCloud2>& message)
{
  return std::visit([](const auto& any) -> const std_msgs::Header& { return any.header; }, message);
}

/// Seconds from the stamp to now. Times of ROS cannot be subtracted if they differ by more than 68 years.
double ageOf(const std_msgs::Header& header)
{
  return ros::Time::now().toSec() - header.stamp.toSec();
}

bool isInWorld(const PlanningScene& scene, const std::string& id)
{
  return std::any_of(
      scene.objects.begin(), scene.objects.end(), [&id](const WorldObject& object) { return object.id == id; });
}

std::set<std::string> attachedIds(const PlanningScene& scene)
{
  std::set<std::string> ids;
  for (const AttachedObject& attached : scene.attached)
    ids.insert(attached.object.id);
  return ids;
}

/// The elements of `a` that are not in `b`.
std::set<std::string> difference(const std::set<std::string>& a, const std::set<std::string>& b)
{
  std::set<std::string> result;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(result, result.end()));
  return result;
}
}  // namespace

Sensors::Sensors(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneStore& store,
                 SceneStore::Lookup find_frame, double frame_timeout, const MemoryGuard& memory,
                 Diagnostics& diagnostics, const SensorsOptions& options)
  : store_(store),
    find_frame_(std::move(find_frame)),
    frame_timeout_(frame_timeout),
    memory_(memory),
    map_(options.map),
    topics_(node, own, 1, diagnostics)  // one thread: it only copies the messages
{
  if (isInWorld(*store_.snapshot().scene, kOctomapId))
    throw Error("parameter ~scene: the scene has an octomap, which the sensors of ~sensors would replace; remove it");
  store_.reserveOctomap();
  for (const SensorOptions& sensor_options : options.sensors)
  {
    sensors_.push_back(std::make_unique<Sensor>());
    Sensor& sensor = *sensors_.back();
    sensor.options = sensor_options;
    if (!sensor_options.sendsImages())
    {
      topics_.subscribe<sensor_msgs::PointCloud2>(
          sensor_options.topic, 1, [this, &sensor](const sensor_msgs::PointCloud2& cloud) { receive(sensor, cloud); });
      continue;
    }
    topics_.subscribe<sensor_msgs::CameraInfo>(
        sensor_options.camera_info_topic, 1,
        [this, &sensor](const sensor_msgs::CameraInfo& info)
        {
          const PinholeCamera camera = cameraOf(info);
          const std::lock_guard<std::mutex> lock(waiting_mutex_);
          sensor.camera = camera;
        });
    topics_.subscribe<sensor_msgs::Image>(sensor_options.topic, 1,
                                          [this, &sensor](const sensor_msgs::Image& image) { receive(sensor, image); });
  }
  ros::NodeHandle root = node;
  diagnostics_publisher_ = root.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  diagnostics_timer_ = root.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publishStatus(); });
  thread_ = std::thread([this] { run(); });
}

Sensors::~Sensors()
{
  stop();
}

void Sensors::stop()
{
  topics_.close();
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    stopping_ = true;
  }
  arrived_.notify_all();
  if (thread_.joinable())
    thread_.join();
  topics_.stop();
}

void Sensors::receive(Sensor& sensor, Message message)
{
  const ros::SteadyTime now = ros::SteadyTime::now();
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    // A tenth of the period is left for sensors whose own rate is the largest rate.
    if (sensor.options.max_rate > 0.0 && (now - sensor.accepted).toSec() < 0.9 / sensor.options.max_rate)
      return;
    sensor.accepted = now;
    sensor.dropped += sensor.waiting ? 1 : 0;
    sensor.waiting = Measured{std::move(message), now};
  }
  arrived_.notify_one();
}

/// The method of the thread: takes the sensors in turn.
void Sensors::run()
{
  while (true)
  {
    bool all_wait = true;
    for (const std::unique_ptr<Sensor>& sensor : sensors_)
      all_wait = !take(*sensor) && all_wait;
    republish();
    std::unique_lock<std::mutex> lock(waiting_mutex_);
    const bool has_current =
        std::any_of(sensors_.begin(), sensors_.end(), [](const auto& sensor) { return sensor->current.has_value(); });
    if (all_wait)
      arrived_.wait_for(lock, has_current ? kNextLookup : kRepublish,
                        [this]
                        {
                          return stopping_ ||
                                 std::any_of(sensors_.begin(), sensors_.end(),
                                             [](const auto& sensor) { return sensor->waiting && !sensor->current; });
                        });
    if (stopping_)
      return;
  }
}

/// Uses the measurement of a sensor. Returns false if there is none, or if it still waits for its frame.
bool Sensors::take(Sensor& sensor)
{
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    if (!sensor.current)
      sensor.current = std::exchange(sensor.waiting, std::nullopt);
  }
  if (!sensor.current)
    return false;
  const double waited = (ros::SteadyTime::now() - sensor.current->received).toSec();
  bool waits = false;
  const Fault fault = faultOf(
      [&]
      {
        try
        {
          use(sensor);
        }
        catch (const NotKnownYet&)
        {
          waits = waited < frame_timeout_;
          if (!waits)
            throw;
        }
      });
  if (waits)
    return false;
  if (fault)
    topics_.refuse(sensor.options.topic, fault.message);
  const std_msgs::Header header = headerOf(sensor.current->message);
  sensor.current.reset();
  const std::lock_guard<std::mutex> lock(waiting_mutex_);
  sensor.fault = fault.message;
  if (fault)
  {
    ++sensor.rejected;
    return true;
  }
  ++sensor.used;
  sensor.used_at = ros::SteadyTime::now();
  sensor.lag = header.stamp.isZero() ? 0.0 : ageOf(header);
  sensor.longest_lag = std::max(sensor.longest_lag, sensor.lag);
  return true;
}

/// Puts the current measurement of a sensor into the map, and the map into the scene.
void Sensors::use(const Sensor& sensor)
{
  memory_.require();
  const SensorOptions& options = sensor.options;
  const Message& message = sensor.current->message;
  const std_msgs::Header& header = headerOf(message);
  std::optional<PinholeCamera> camera;
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    camera = sensor.camera;
  }
  if (options.sendsImages() && !camera)
    throw Error("there is no message on " + options.camera_info_topic + " yet");
  if (const double age = ageOf(header); age < -kLargestAdvance)
    throw Error("the stamp is " + numberText(-age) + " s in the future; synchronise the clocks");
  const MeasuredAt measured = measuredAt(header, store_, find_frame_);
  SensorView view;
  view.sensor = measured.sensor;
  view.time = header.stamp.toSec();
  view.received = sensor.current->received.toSec();
  view.min_range = options.min_range;
  view.max_range = options.max_range;
  view.padding = options.padding;

  const std::lock_guard<std::mutex> lock(map_mutex_);
  const PlanningScene& scene = *measured.now.scene;
  followObjects(scene, measured.now.state);
  const auto add = [&](const auto& measurement)
  { return map_.add(measurement, view, scene, measured.state.data(), excluded_); };
  const auto* image = std::get_if<sensor_msgs::Image>(&message);
  const std::size_t without_room = image != nullptr
                                       ? add(depthImageOf(*image, *camera))
                                       : add(pointsOf(std::get<sensor_msgs::PointCloud2>(message), options.step));
  publish();
  if (without_room > 0)
    throw Error(std::to_string(without_room) +
                " voxels are not in the scene, the farthest from the sensor, because ~limits/voxels is reached; use "
                "larger voxels (~octomap_resolution), a shorter range or a region");
}

/// Objects that were attached since the last measurement lose their voxels, and ids of removed objects are not excluded
/// any more. map_mutex_ is held.
void Sensors::followObjects(const PlanningScene& scene, const std::vector<double>& state)
{
  const std::set<std::string> attached = attachedIds(scene);
  if (const std::set<std::string> added = difference(attached, attached_); !added.empty())
    map_.removeNear(added, largestPadding(), scene, state.data());
  attached_ = attached;
  for (const std::string& id : std::set<std::string>(excluded_))
    if (!isInWorld(scene, id) && attached.count(id) == 0)
      excluded_.erase(id);
}

double Sensors::largestPadding() const
{
  double padding = 0.0;
  for (const std::unique_ptr<Sensor>& sensor : sensors_)
    padding = std::max(padding, sensor->options.padding);
  return padding;
}

/// Puts the voxels into the scene. Returns the scene's revision. map_mutex_ is held.
std::uint64_t Sensors::publish()
{
  const Snapshot now = store_.snapshot();
  std::vector<PlacedShape> cubes = map_.cubes(*now.scene, now.state.data());
  hides_voxels_ = cubes.size() < map_.size();
  replaceObject(store_, kOctomapId, std::move(cubes));
  return store_.snapshot().scene->revision;
}

/// The robot may have left voxels that are hidden because it touched them, while no measurement comes.
void Sensors::republish()
{
  const std::lock_guard<std::mutex> lock(map_mutex_);
  if (!hides_voxels_)
    return;
  if (const std::string error = errorOf([this] { publish(); }); !error.empty())
    ROS_ERROR_STREAM_THROTTLE(10.0, "the octomap of the sensors stays as it is: " << error);
}

ExcludeFromSensors::Response Sensors::exclude(const ExcludeFromSensors::Request& request)
{
  return respond<ExcludeFromSensors::Response>(
      [&](ExcludeFromSensors::Response& response)
      {
        const std::set<std::string> objects(request.object_ids.begin(), request.object_ids.end());
        const std::lock_guard<std::mutex> lock(map_mutex_);
        const Snapshot now = store_.snapshot();
        const std::set<std::string> attached = attachedIds(*now.scene);
        for (const std::string& id : objects)
          if (!isInWorld(*now.scene, id) && attached.count(id) == 0)
            throw Error("the scene has no object '" + id + "'; add it first");
        map_.removeNear(difference(objects, attached), largestPadding(), *now.scene, now.state.data());
        response.scene_revision = publish();
        excluded_ = objects;
      });
}

Clear::Response Sensors::clear()
{
  return respond<Clear::Response>(
      [&](Clear::Response& response)
      {
        const std::lock_guard<std::mutex> lock(map_mutex_);
        map_.clear();
        response.scene_revision = publish();
      });
}

/// ERROR if the last measurement of a sensor was rejected, WARN if none was used for a second.
void Sensors::publishStatus()
{
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = ros::Time::now();
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    for (const std::unique_ptr<Sensor>& sensor : sensors_)
    {
      DiagnosticStatus& status = message.status.emplace_back();
      status.name = ros::this_node::getName().substr(1) + ": sensor " + sensor->options.topic;
      const double silent = (ros::SteadyTime::now() - sensor->used_at).toSec();
      status.level = DiagnosticStatus::OK;
      status.message = "measures";
      if (!sensor->fault.empty())
      {
        status.level = DiagnosticStatus::ERROR;
        status.message = "the octomap does not follow this sensor: " + sensor->fault;
      }
      else if (sensor->used_at.isZero() || silent > kLongestSilence)
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
      add("used", std::to_string(sensor->used));
      add("dropped", std::to_string(sensor->dropped));
      add("rejected", std::to_string(sensor->rejected));
      add("lag", std::to_string(sensor->lag));
      add("longest_lag", std::to_string(std::exchange(sensor->longest_lag, 0.0)));
    }
  }
  diagnostics_publisher_.publish(message);
}
}  // namespace gpu_planning_scene::core
