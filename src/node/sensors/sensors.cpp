#include "node/sensors/sensors.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>

#include "base/finally.h"
#include "base/text/number_text.h"
#include "node/endpoints/respond.h"
#include "node/messages/sensor_messages.h"
#include "node/sensors/measured_at.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLargestAdvance = 1.0;               // seconds of a stamp before the node's clock
constexpr double kLargestAge = 2.0;                   // seconds of a stamp behind it; as between two sensors
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

/// Throws Error for an image that shows nothing beyond `min_range` (metres), neither a thing nor the empty space up to
/// the range: it says nothing about the world.
SensedMap::Measurement measuredOf(const sensor_msgs::Image& message, const PinholeCamera& camera, double min_range)
{
  DepthImage image = depthImageOf(message, camera);
  if (std::none_of(image.depths.begin(), image.depths.end(),
                   [=](double depth) { return depth > 0.0 && depth >= min_range; }))
    throw Error(
        "no pixel has a depth beyond the minimum range; is the lens covered, or is everything beyond the sensor's "
        "range?");
  return image;
}

/// The same for a cloud. One without any points may come from a scanner whose rays meet nothing.
SensedMap::Measurement measuredOf(const sensor_msgs::PointCloud2& message, std::size_t step, double min_range)
{
  std::vector<Eigen::Vector3f> points = pointsOf(message, step);
  const auto is_measured = [=](const Eigen::Vector3f& point)
  {
    const double distance = point.cast<double>().norm();
    return std::isfinite(distance) && distance > 0.0 && distance >= min_range;
  };
  if (!points.empty() && std::none_of(points.begin(), points.end(), is_measured))
    throw Error("no point of the cloud is finite and beyond the minimum range; is the sensor covered?");
  return points;
}

double largestPadding(const std::vector<SensorOptions>& sensors)
{
  double padding = 0.0;
  for (const SensorOptions& sensor : sensors)
    padding = std::max(padding, sensor.padding);
  return padding;
}
}  // namespace

Sensors::Sensors(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneStore& store,
                 SceneStore::Lookup find_frame, double frame_timeout, const MemoryGuard& memory,
                 Diagnostics& diagnostics, const SensorsOptions& options)
  : store_(store),
    find_frame_(std::move(find_frame)),
    frame_timeout_(frame_timeout),
    memory_(memory),
    map_(store, options.map, largestPadding(options.sensors)),
    topics_(node, own, 1, diagnostics)  // one thread: it only copies the messages
{
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
          std::optional<PinholeCamera> camera;
          const Finally take(
              [&]
              {
                const std::lock_guard<std::mutex> lock(waiting_mutex_);
                sensor.camera = camera;  // none after an error: images do not fit an older message
              });
          camera = cameraOf(info);
        });
    topics_.subscribe<sensor_msgs::Image>(sensor_options.topic, 1,
                                          [this, &sensor](const sensor_msgs::Image& image) { receive(sensor, image); });
  }
  ros::NodeHandle root = node;
  diagnostics_publisher_ = root.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  diagnostics_timer_ = root.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publishStatus(); });
  store_.setOctomapFault([this] { return octomapFault(); });
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
  store_.setOctomapFault({});
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
    sensor.record.dropped += sensor.waiting ? 1 : 0;
    sensor.waiting = Measured{std::move(message), now};
  }
  arrived_.notify_one();
}

/// The method of the thread: takes the sensors in turn.
void Sensors::run()
{
  ros::SteadyTime republished = ros::SteadyTime::now();
  while (true)
  {
    bool all_wait = true;
    for (const std::unique_ptr<Sensor>& sensor : sensors_)
      all_wait = !take(*sensor) && all_wait;
    if (const ros::SteadyTime now = ros::SteadyTime::now(); (now - republished).toSec() >= kRepublish.count() * 1e-3)
    {
      map_.republish();
      republished = now;
    }
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
  std::uint64_t distrusted = 0;
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    if (!sensor.current)
      sensor.current = std::exchange(sensor.waiting, std::nullopt);
    distrusted = distrusted_;
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
  if (fault)
    sensor.record.reject(fault.message);
  else
    sensor.record.use(header.stamp.isZero() ? 0.0 : ageOf(header));
  if (distrusted != distrusted_)  // the measurement may be among what was cleared
    sensor.record.distrust();
  return true;
}

/// Puts the current measurement of a sensor into the map, and the map into the scene.
void Sensors::use(Sensor& sensor)
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
    throw Error("there is no valid message on " + options.camera_info_topic + " yet");
  // When it came: a measurement that waits for tf grows older.
  const double waited = (ros::SteadyTime::now() - sensor.current->received).toSec();
  if (const double age = header.stamp.isZero() ? 0.0 : ageOf(header) - waited; age < -kLargestAdvance)
    throw Error("the stamp is " + numberText(-age) + " s in the future; synchronise the clocks");
  else if (age > kLargestAge)
    throw Error("the stamp is " + numberText(age) +
                " s old; synchronise the clocks, and play recorded data with the "
                "simulated clock (rosbag play --clock, use_sim_time)");
  const MeasuredAt measured = measuredAt(header, store_, find_frame_);
  SensorView view;
  view.sensor = measured.sensor;
  view.time = header.stamp.isZero() ? ros::Time::now().toSec() - waited : header.stamp.toSec();
  view.received = sensor.current->received.toSec();
  view.min_range = options.min_range;
  view.max_range = options.max_range;
  view.padding = options.padding;

  const auto* image = std::get_if<sensor_msgs::Image>(&message);
  map_.add(image != nullptr ? measuredOf(*image, *camera, options.min_range)
                            : measuredOf(std::get<sensor_msgs::PointCloud2>(message), options.step, options.min_range),
           view, measured.state, [&](std::size_t lost) { noteLoss(sensor, lost); });
}

/// Called before the scene is published without these voxels, so that nobody takes their places for free.
void Sensors::noteLoss(Sensor& sensor, std::size_t voxels)
{
  const std::string loss =
      std::to_string(voxels) +
      " voxels found no room in the scene, the farthest from the robot, because ~limits/voxels is reached; use larger "
      "voxels (~octomap_resolution), a shorter range or a region, and then call ~clear_octomap";
  topics_.refuse(sensor.options.topic, loss);
  const std::lock_guard<std::mutex> lock(waiting_mutex_);
  sensor.record.lose(loss);
}

ExcludeFromSensors::Response Sensors::exclude(const ExcludeFromSensors::Request& request)
{
  return respond<ExcludeFromSensors::Response>(
      [&](ExcludeFromSensors::Response& response) {
        response.scene_revision = map_.exclude({request.object_ids.begin(), request.object_ids.end()});
      });
}

Clear::Response Sensors::clear()
{
  return respond<Clear::Response>(
      [&](Clear::Response& response)
      {
        // Nobody may take an empty map for a free world, also not if a measurement came before the map was cleared.
        distrustAll();
        response.scene_revision = map_.clear(
            [this]
            {
              const std::lock_guard<std::mutex> lock(waiting_mutex_);
              for (const std::unique_ptr<Sensor>& sensor : sensors_)
                sensor->record.forget();
            });
        distrustAll();
      });
}

void Sensors::distrustAll()
{
  const std::lock_guard<std::mutex> lock(waiting_mutex_);
  ++distrusted_;
  for (const std::unique_ptr<Sensor>& sensor : sensors_)
    sensor->record.distrust();
}

/// The first fault of a sensor. Empty: there is none.
std::string Sensors::octomapFault()
{
  const std::lock_guard<std::mutex> lock(waiting_mutex_);
  for (const std::unique_ptr<Sensor>& sensor : sensors_)
    if (std::string fault = sensor->record.octomapFault(sensor->options.topic, sensor->options.max_silence);
        !fault.empty())
      return fault;
  return "";
}

void Sensors::publishStatus()
{
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = ros::Time::now();
  std::vector<std::string> silences;
  {
    const std::lock_guard<std::mutex> lock(waiting_mutex_);
    for (const std::unique_ptr<Sensor>& sensor : sensors_)
    {
      message.status.push_back(sensor->record.status(sensor->options.topic));
      silences.push_back(sensor->record.silence(sensor->options.topic));
    }
  }
  for (const std::string& silence : silences)
    if (!silence.empty())
      ROS_WARN_STREAM(silence);
  diagnostics_publisher_.publish(message);
}
}  // namespace gpu_planning_scene::core
