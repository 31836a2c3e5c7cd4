// replicas [REPEATS]: times a request of 65,536 random states, sent to the leader of replicas.launch directly and
// through a ShardedChecker with one node, and with the leader and its replicas. Prints the medians. Start it with
// replicas.launch of this folder.

#include <cstdio>
#include <cstdlib>
#include <random>

#include <gpu_planning_scene/GetPlanningScene.h>
#include <ros/ros.h>

#include "benchmark/statistics.h"
#include "gpu_planning_scene/client/sharded_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kLeader[] = "/planning_scene";
constexpr std::size_t kStates = 65536;

/// Random values for the variables of the robot.
CheckStates::Request randomRequest()
{
  gpu_planning_scene::GetPlanningScene scene;
  if (!ros::service::waitForService(std::string(kLeader) + "/check_states", ros::Duration(60.0)) ||
      !ros::service::call(std::string(kLeader) + "/get_planning_scene", scene) || !scene.response.success)
    throw std::runtime_error("the leader does not answer");
  CheckStates::Request request;
  request.joint_names = scene.response.scene.robot_state.joint_state.name;
  if (request.joint_names.empty())
    throw std::runtime_error("the scene has no joint values; give a scene file with a robot_state");
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(-1.5, 1.5);
  for (std::size_t i = 0; i < kStates * request.joint_names.size(); ++i)
    request.positions.push_back(value(random));
  return request;
}

template <class Check>
void run(std::size_t repeats, const std::vector<std::pair<std::string, Check>>& ways)
{
  std::vector<std::vector<double>> seconds(ways.size());
  for (std::size_t i = 0; i < repeats; ++i)
    for (std::size_t way = 0; way < ways.size(); ++way)
      seconds[way].push_back(benchmark::secondsOf(ways[way].second));
  for (std::size_t way = 0; way < ways.size(); ++way)
  {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < repeats; ++i)
      ratios.push_back(seconds[way][i] / seconds[0][i]);
    std::printf("%-36s %8.1f ms   %5.3f of the first\n", ways[way].first.c_str(), 1e3 * benchmark::median(seconds[way]),
                benchmark::median(ratios));
  }
}

void measure(std::size_t repeats)
{
  const CheckStates::Request request = randomRequest();
  const auto replicas = static_cast<int>(ros::param::param("~replicas", 3));
  std::vector<std::string> nodes = {kLeader};
  for (int i = 1; i <= replicas; ++i)
    nodes.push_back(kLeader + ("_" + std::to_string(i)));
  ros::ServiceClient direct =
      ros::NodeHandle().serviceClient<CheckStates>(std::string(kLeader) + "/check_states", true);
  ShardedChecker one({kLeader});
  ShardedChecker all(nodes);
  CheckStates call;
  call.request = request;
  const auto require = [](bool is_right)
  {
    if (!is_right)
      throw std::runtime_error("an answer is missing or differs");
  };
  const auto ask_directly = [&] { require(direct.call(call) && call.response.success); };
  for (int i = 0; i < 20; ++i)  // until the proofs of the robot are made
  {
    ask_directly();
    require(all.check(request).valid == call.response.valid);
  }
  run<std::function<void()>>(repeats,
                             {{"one node, directly", ask_directly},
                              {"ShardedChecker with this node", [&] { require(one.check(request).success != 0); }},
                              {"ShardedChecker with " + std::to_string(nodes.size()) + " nodes",
                               [&] { require(all.check(request).success != 0); }}});
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  ros::init(argc, argv, "replicas");
  const ros::NodeHandle node;  // keeps roscpp running
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 30;
  if (repeats <= 0)
  {
    std::fprintf(stderr, "usage: replicas [REPEATS]\n");
    return 2;
  }
  try
  {
    gpu_planning_scene::core::measure(static_cast<std::size_t>(repeats));
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "replicas: %s\n", error.what());
    return 1;
  }
}
