// The parameters of the planner for MoveIt, which it reads when MoveIt initialises it.

#include <chrono>
#include <mutex>

#include <gtest/gtest.h>
#include <moveit/planning_interface/planning_interface.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <pluginlib/class_loader.hpp>

#include "moveit/moveit_resources.h"
#include "node/moveit/moveit_client.h"

namespace gpu_planning_scene::pipeline
{
namespace
{
using Clock = std::chrono::steady_clock;

class PlannerParameters : public testing::Test
{
 public:
  static void SetUpTestSuite()
  {
    model = core::moveItPanda();
    useBuiltPlugins();
    loader = std::make_unique<Loader>("moveit_core", "planning_interface::PlannerManager");
  }
  static void TearDownTestSuite()
  {
    loader.reset();
    model.reset();
  }

  PlannerParameters()
  {
    log_ = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
        "/rosout", 1000, [this](const rosgraph_msgs::LogConstPtr& message) { take(*message); });
    // This program hears its own log.
    for (const auto end = Clock::now() + std::chrono::seconds(10); log_.getNumPublishers() == 0 && Clock::now() < end;)
      ros::WallDuration(0.02).sleep();
  }
  ~PlannerParameters() override { ros::param::del(kNamespace); }

  template <class Value>
  static bool initializesWith(const std::string& name, const Value& value)
  {
    ros::param::del(kNamespace);
    ros::param::set(std::string(kNamespace) + "/device", "cpu");
    ros::param::set(std::string(kNamespace) + "/" + name, value);
    return loader->createUniqueInstance("gpu_planning_scene/PlannerManager")->initialize(model, kNamespace);
  }

  /// Expects that the planner refuses the value, and that it logs one error, which names the parameter.
  template <class Value>
  void expectRefusal(const std::string& name, const Value& value)
  {
    EXPECT_FALSE(initializesWith(name, value)) << name;
    const auto is_there = [this] { return !errors().empty(); };
    for (const auto end = Clock::now() + std::chrono::seconds(10); !is_there() && Clock::now() < end;)
      ros::WallDuration(0.02).sleep();
    ASSERT_EQ(1U, errors().size()) << name;
    EXPECT_NE(std::string::npos, errors()[0].find(std::string(kNamespace) + "/" + name)) << errors()[0];
    EXPECT_EQ(std::string::npos, errors()[0].find('\n')) << errors()[0];
    const std::lock_guard<std::mutex> lock(mutex_);
    errors_.clear();
  }

  std::vector<std::string> errors()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return errors_;
  }

  using Loader = pluginlib::ClassLoader<planning_interface::PlannerManager>;
  static constexpr char kNamespace[] = "/planner_parameters";
  static moveit::core::RobotModelPtr model;
  static std::unique_ptr<Loader> loader;

 private:
  void take(const rosgraph_msgs::Log& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (message.level >= rosgraph_msgs::Log::ERROR && message.name == ros::this_node::getName())
      errors_.push_back(message.msg);
  }

  std::mutex mutex_;  // guards errors_
  std::vector<std::string> errors_;
  ros::Subscriber log_;
};
moveit::core::RobotModelPtr PlannerParameters::model;
std::unique_ptr<PlannerParameters::Loader> PlannerParameters::loader;

XmlRpc::XmlRpcValue mapWith(const std::string& key, const XmlRpc::XmlRpcValue& value)
{
  XmlRpc::XmlRpcValue map;
  map[key] = value;
  return map;
}

TEST_F(PlannerParameters, OfARightTypeAreTaken)
{
  EXPECT_TRUE(initializesWith("device", "cpu"));
  EXPECT_TRUE(initializesWith("waypoint_distance", 0.05));
  EXPECT_TRUE(initializesWith("waypoint_distance", 1));
  EXPECT_TRUE(initializesWith("waypoint_distance", 0));
  EXPECT_TRUE(initializesWith("known_paths", 0));
  EXPECT_TRUE(initializesWith("planner_configs", mapWith("Fast", mapWith("type", "geometric::RRTConnect"))));
}

TEST_F(PlannerParameters, OfAWrongTypeOrValueAreRefusedInOneLine)
{
  expectRefusal("device", 0.5);
  expectRefusal("device", true);
  expectRefusal("waypoint_distance", "near");
  expectRefusal("waypoint_distance", true);
  expectRefusal("known_paths", -1);
  expectRefusal("known_paths", 1001);
  expectRefusal("known_paths", 2.0);
  expectRefusal("waypoint_distance", -0.1);
  expectRefusal("waypoint_distance", 1e-6);
  expectRefusal("waypoint_distance", std::numeric_limits<double>::infinity());
  expectRefusal("planner_configs", 3);
  expectRefusal("planner_configs", mapWith("Fast", "geometric::RRTConnect"));
  expectRefusal("planner_configs", mapWith("Fast", mapWith("range", 0.5)));
  expectRefusal("panda_arm", "Fast");
  expectRefusal("panda_arm", mapWith("longest_valid_segment_fraction", "small"));
  expectRefusal("panda_arm", mapWith("planner_configs", "Fast"));
  expectRefusal("panda_arm", mapWith("default_planner_config", "Fast"));
}

TEST_F(PlannerParameters, ADeviceThatCannotBeOpenedIsRefusedBeforeTheFirstRequest)
{
  EXPECT_FALSE(initializesWith("device", "no such device"));
}
}  // namespace
}  // namespace gpu_planning_scene::pipeline
