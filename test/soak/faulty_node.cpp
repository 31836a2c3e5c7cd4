// The unchanged node on a device that fails now and then, for the soak test.

#include <atomic>
#include <random>

#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/error.h"
#include "node/run_node.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A checker whose device is lost in about one of 100 calls.
class FaultyChecker : public StateChecker
{
 public:
  FaultyChecker(std::unique_ptr<StateChecker> checker, unsigned seed) : checker_(std::move(checker)), random_(seed) {}

  void setScene(std::shared_ptr<const PlanningScene> scene) override
  {
    fail();
    checker_->setScene(std::move(scene));
  }
  BatchResult check(const double* states, std::size_t count, const std::string& group,
                    const JointNeighbourhood* around) override
  {
    fail();
    BatchResult result = checker_->check(states, count, group, around);
    fail();
    return result;
  }
  SceneReport report(const std::string& group) override { return checker_->report(group); }
  std::string deviceName() const override { return checker_->deviceName(); }

 private:
  void fail()
  {
    constexpr unsigned kCalls = 100;
    if (random_() % kCalls == 0)
      throw DeviceLost("simulated loss of the device");
  }

  std::unique_ptr<StateChecker> checker_;
  std::mt19937 random_;
};

std::unique_ptr<StateChecker> openFaulty(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
{
  static std::atomic<unsigned> seed{0};
  return std::make_unique<FaultyChecker>(openChecker(std::move(scene), options), ++seed);
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  return gpu_planning_scene::core::runNode(argc, argv, gpu_planning_scene::core::openFaulty);
}
