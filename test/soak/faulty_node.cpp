// The unchanged node on a device that fails now and then, for the soak test.

#include <atomic>
#include <random>

#include "collision/batch/batch_device.h"
#include "collision/batch/device_parts.h"
#include "gpu_planning_scene/error.h"
#include "node/run_node.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A device that is lost in about one of 100 calls and parts.
class FaultyDevice : public BatchDevice
{
 public:
  FaultyDevice(std::unique_ptr<BatchDevice> device, unsigned seed) : device_(std::move(device)), random_(seed) {}

  void prepare(const DeviceTask& task) override
  {
    fail();
    device_->prepare(task);
  }
  void check(DeviceParts& parts) override
  {
    FaultyParts faulty(parts, *this);
    device_->check(faulty);
  }
  std::string name() const override { return device_->name(); }
  bool isSoftware() const override { return device_->isSoftware(); }
  std::string fault() const override { return device_->fault(); }

 private:
  class FaultyParts : public DeviceParts
  {
   public:
    FaultyParts(const DeviceParts& parts, FaultyDevice& device) : DeviceParts(parts), device_(device) {}
    StateRange take(std::size_t most) override
    {
      device_.fail();
      return DeviceParts::take(most);
    }

   private:
    FaultyDevice& device_;
  };

  void fail()
  {
    constexpr unsigned kCalls = 100;
    if (random_() % kCalls == 0)
      throw DeviceLost("simulated loss of the device");
  }

  std::unique_ptr<BatchDevice> device_;
  std::mt19937 random_;
};

std::unique_ptr<BatchDevice> openFaulty(const BatchCheckerOptions& options)
{
  static std::atomic<unsigned> seed{0};
  return std::make_unique<FaultyDevice>(openGpuDevice(options), ++seed);
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  return gpu_planning_scene::core::runNode(argc, argv, gpu_planning_scene::core::openFaulty);
}
