// The unchanged node on a device that fails now and then, for the soak test.

#include <atomic>
#include <csignal>
#include <iostream>
#include <random>

#include <ros/ros.h>

#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/error.h"
#include "node/serve.h"

namespace gpu_planning_scene::core
{
namespace
{
volatile std::sig_atomic_t stop_requested = 0;

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
  using namespace gpu_planning_scene::core;
  ros::init(argc, argv, "planning_scene", ros::init_options::NoSigintHandler);
  const auto stop = [](int) { stop_requested = 1; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  ros::NodeHandle node;
  ros::NodeHandle own("~");
  try
  {
    serve(node, own, openFaulty, [] { return stop_requested != 0; });
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
