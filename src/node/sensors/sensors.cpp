#include "node/sensors/sensors.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/this_node.h>

#include "gpu_planning_scene/octomap.h"
#include "node/endpoints/respond.h"
#include "node/sensors/measured_at.h"
#include "node/sensors/sensed_object.h"

namespace gpu_planning_scene::core
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

constexpr double kLongestSilence = 1.0;  // seconds
constexpr std::chrono::milliseconds kRepublished{100};

bool isInWorld(const PlanningScene& scene, const std::string& id)
{
  return std::any_of(
      scene.objects.begin(), scene.objects.end(), [&id](const WorldObject& object) { return object.id == id; });
}

/// Throws Error unless the world has this object or a link carries it.
void requireObject(const PlanningScene& scene, const std::string& id)
{
  if (!isInWorld(scene, id) && std::none_of(scene.attached.begin(), scene.attached.end(),
                                            [&id](const AttachedObject& attached) { return attached.object.id == id; }))
    throw Error("the scene has no object '" + id + "'; add it first");
}

const std_msgs::Header& headerOf(const std::variant<sensor_msgs::Image, sensor_msgs::PointCloud2>& message)
{
  return std::visit([](const auto& any) -> const std_msgs::Header& { return any.header; }, message);
}
}  // namespace

Sensors::Sensors(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneStore& store, SceneStore::Lookup lookup,
                 const MemoryGuard& memory, Diagnostics& diagnostics, const SensorsOptions& options)
  : store_(store),
    lookup_(std::move(lookup)),
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
      ros::WallDuration(1.0),
      [this](const ros::WallTimerEvent&)
      {
        diagnostic_msgs::DiagnosticArray message;
        message.header.stamp = ros::Time::now();
        message.status = statuses();
        diagnostics_publisher_.publish(message);
      });
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
  const ros::Time stamp = headerOf(message).stamp;
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    sensor.received = ros::WallTime::now();
    // A tenth of the period is left for sensors whose own rate is the largest rate. Time may jump back.
    if (sensor.options.max_rate > 0.0 && stamp >= sensor.newest &&
        (stamp - sensor.newest).toSec() < 0.9 / sensor.options.max_rate)
      return;
    sensor.newest = stamp;
    sensor.dropped += sensor.waiting ? 1 : 0;
    sensor.waiting = std::move(message);
  }
  arrived_.notify_one();
}

/// The method of the thread: takes the sensors in turn.
void Sensors::run()
{
  std::size_t last = 0;
  std::unique_lock<std::mutex> lock(waiting_mutex_);
  while (true)
  {
    Sensor* sensor = nullptr;
    const auto find = [&]
    {
      for (std::size_t i = 1; i <= sensors_.size() && sensor == nullptr; ++i)
        if (const std::size_t next = (last + i) % sensors_.size(); sensors_[next]->waiting)
        {
          last = next;
          sensor = sensors_[next].get();
        }
      return stopping_ || sensor != nullptr;
    };
    const bool has_arrived = arrived_.wait_for(lock, kRepublished, find);
    if (stopping_)
      return;
    if (!has_arrived)
    {
      lock.unlock();
      republish();
      lock.lock();
      continue;
    }
    const Message message = *std::exchange(sensor->waiting, std::nullopt);
    const std::optional<PinholeCamera> camera = sensor->camera;
    lock.unlock();
    const Fault fault = faultOf([&] { use(sensor->options, camera, message); });
    if (fault)
      topics_.refuse(sensor->options.topic, fault.message);
    const double lag = (ros::Time::now() - headerOf(message).stamp).toSec();
    lock.lock();
    if (fault)
    {
      ++sensor->refused;
      continue;
    }
    ++sensor->used;
    sensor->lag = lag;
    sensor->longest_lag = std::max(sensor->longest_lag, lag);
  }
}

/// Takes a measurement, and changes the scene.
void Sensors::use(const SensorOptions& options, const std::optional<PinholeCamera>& camera, const Message& message)
{
  memory_.require();
  if (options.sendsImages() && !camera)
    throw Error("there is no message on " + options.camera_info_topic + " yet");
  const MeasuredAt measured = measuredAt(headerOf(message), store_, lookup_);
  SensorView view;
  view.sensor = measured.sensor;
  view.time = headerOf(message).stamp.toSec();
  view.min_range = options.min_range;
  view.max_range = options.max_range;
  view.padding = options.padding;
  const std::lock_guard<std::mutex> lock(map_mutex_);
  const auto add = [&](const auto& measurement)
  { map_.add(measurement, view, *measured.now.scene, measured.state.data(), excluded_); };
  if (const auto* image = std::get_if<sensor_msgs::Image>(&message))
    add(depthImageOf(*image, *camera));
  else
    add(pointsOf(std::get<sensor_msgs::PointCloud2>(message), options.step));
  publish();
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
        const Snapshot now = store_.snapshot();
        const std::set<std::string> objects(request.object_ids.begin(), request.object_ids.end());
        for (const std::string& id : objects)
          requireObject(*now.scene, id);
        double padding = 0.0;
        for (const std::unique_ptr<Sensor>& sensor : sensors_)
          padding = std::max(padding, sensor->options.padding);
        const std::lock_guard<std::mutex> lock(map_mutex_);
        map_.removeNear(objects, padding, *now.scene, now.state.data());
        excluded_ = objects;
        response.scene_revision = publish();
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

std::vector<DiagnosticStatus> Sensors::statuses()
{
  std::vector<DiagnosticStatus> all;
  const std::lock_guard<std::mutex> lock(waiting_mutex_);
  for (const std::unique_ptr<Sensor>& sensor : sensors_)
  {
    DiagnosticStatus& status = all.emplace_back();
    status.name = ros::this_node::getName().substr(1) + ": sensor " + sensor->options.topic;
    const bool is_silent =
        sensor->received.isZero() || (ros::WallTime::now() - sensor->received).toSec() > kLongestSilence;
    status.level = is_silent ? DiagnosticStatus::WARN : DiagnosticStatus::OK;
    status.message = is_silent ? "no measurement for more than a second" : "measures";
    const auto add = [&status](const std::string& key, const std::string& value)
    {
      status.values.emplace_back();
      status.values.back().key = key;
      status.values.back().value = value;
    };
    add("used", std::to_string(sensor->used));
    add("dropped", std::to_string(sensor->dropped));
    add("refused", std::to_string(sensor->refused));
    add("lag", std::to_string(sensor->lag));
    add("longest_lag", std::to_string(std::exchange(sensor->longest_lag, 0.0)));
  }
  return all;
}
}  // namespace gpu_planning_scene::core
