// Whether the octomap is known to have what a sensor measures.

#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "node/sensors/sensor_record.h"

namespace gpu_planning_scene::core
{
namespace
{
bool hasFault(const SensorRecord& record, const std::string& text, double seconds = 60.0)
{
  const std::string fault = record.octomapFault("/camera", seconds);
  return text.empty() ? fault.empty() : fault.find(text) != std::string::npos;
}

TEST(SensorRecord, HasAFaultUntilAMeasurementIsUsedAndWhenItIsTooOld)
{
  SensorRecord record;
  EXPECT_TRUE(hasFault(record, "no measurement of sensor /camera was used yet"));
  EXPECT_TRUE(hasFault(record, "", 0.0)) << "the sensor may be silent";
  record.use(0.1);
  EXPECT_TRUE(hasFault(record, ""));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(hasFault(record, "was used for ", 0.01));
  record.reject("it is blind");
  EXPECT_TRUE(hasFault(record, "the last one was rejected: it is blind", 0.01));
}

TEST(SensorRecord, HasAFaultFromALossUntilTheOctomapIsCleared)
{
  SensorRecord record;
  record.use(0.1);
  record.lose("5 voxels found no room");
  record.use(0.1);
  EXPECT_TRUE(hasFault(record, "sensor /camera: 5 voxels found no room"));
  EXPECT_TRUE(hasFault(record, "5 voxels found no room", 0.0));
  record.distrust();
  EXPECT_TRUE(hasFault(record, "5 voxels found no room"));
  record.forget();
  EXPECT_TRUE(hasFault(record, "was used since the octomap was cleared"));
  record.use(0.1);
  EXPECT_TRUE(hasFault(record, ""));
}
}  // namespace
}  // namespace gpu_planning_scene::core
