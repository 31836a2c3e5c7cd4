#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "node/endpoints/endpoints.h"
#include "node/messages/messages.h"
#include "node/sensors/sensed_map.h"
#include "node/sensors/sensor_options.h"
#include "node/sensors/sensor_record.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Keeps the octomap of the scene (kOctomapId) from the measurements of depth cameras and scanners. One thread takes
/// the newest measurement of each sensor in turn, beside the checks. A measurement that a newer one replaces before its
/// turn is dropped and counted. A measurement whose frame tf does not know yet waits, and the other sensors go on.
/// Publishes a status for each sensor on /diagnostics. While a sensor is silent for longer than
/// SensorOptions::max_silence, or measured voxels found no room, snapshots of the store say so
/// (Snapshot::octomap_fault). Thread-safe.
class Sensors
{
 public:
  /// Subscribes to the topics of the sensors, and reserves the octomap (SceneStore::reserveOctomap). `find_frame` must
  /// not wait: it throws NotKnownYet for a frame that may come. `frame_timeout`: seconds that a measurement waits for
  /// its frame. All arguments passed by reference must outlive this object. Throws Error if the scene already has an
  /// octomap.
  Sensors(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneStore& store, SceneStore::Lookup find_frame,
          double frame_timeout, const MemoryGuard& memory, Diagnostics& diagnostics, const SensorsOptions& options);
  /// Calls stop().
  ~Sensors();
  Sensors(const Sensors&) = delete;
  Sensors& operator=(const Sensors&) = delete;

  /// Both throw nothing: the response has the error.
  ExcludeFromSensors::Response exclude(const ExcludeFromSensors::Request& request);
  /// Forgets all voxels.
  Clear::Response clear();

  /// From now on, measurements are rejected.
  void close() { topics_.close(); }
  /// Calls close(), and finishes the current measurement.
  void stop();

 private:
  using Message = std::variant<sensor_msgs::Image, sensor_msgs::PointCloud2>;

  struct Measured
  {
    Message message;
    ros::SteadyTime received;
  };

  /// A sensor. waiting_mutex_ guards all but `current`, which belongs to the thread.
  struct Sensor
  {
    SensorOptions options;
    std::optional<PinholeCamera> camera;  // of images
    std::optional<Measured> waiting;
    std::optional<Measured> current;  // is used now, or waits for its frame
    ros::SteadyTime accepted;         // arrival of the newest measurement that max_rate lets through
    SensorRecord record;
  };

  void receive(Sensor& sensor, Message message);
  void run();
  bool take(Sensor& sensor);
  void use(Sensor& sensor);
  void noteLoss(Sensor& sensor, std::size_t voxels);
  void distrustAll();
  void publishStatus();
  std::string octomapFault();

  SceneStore& store_;
  const SceneStore::Lookup find_frame_;
  const double frame_timeout_;
  const MemoryGuard& memory_;

  SensedMap map_;

  std::mutex waiting_mutex_;
  std::condition_variable arrived_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::uint64_t distrusted_ = 0;  // calls of distrustAll()
  bool stopping_ = false;

  Endpoints topics_;
  ros::Publisher diagnostics_publisher_;
  ros::WallTimer diagnostics_timer_;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
