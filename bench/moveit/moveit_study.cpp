// Compares the detector for MoveIt with MoveIt's FCL detector, in one process:
//
//     moveit_study agreement ROBOT STATES [NODE]
//         verdicts and pairs of random states; each difference is explained and counted
//     moveit_study cost ROBOT
//         processor time of one state and of a change of the scene; memory of copied scenes
//
// ROBOT: panda, pr2 or ur5_robotiq. ROS_PACKAGE_PATH must contain MoveIt's test robots, and ../shared/robots. NODE: the
// full name of a running planning_scene_node with this robot and ~moveit_names. It gets each scene in MoveIt's message,
// and its verdicts are compared with those of the detector. bench/moveit/study.launch starts both.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <malloc.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

#include "moveit/study_node.h"
#include "moveit/study_scenes.h"

namespace gpu_planning_scene
{
namespace
{
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using collision_detection::DistanceRequest;
using collision_detection::DistanceRequestType;
using collision_detection::DistanceResult;
using moveit::core::RobotState;
using planning_scene::PlanningScene;
using planning_scene::PlanningScenePtr;

// Verdicts of pairs that are nearer to touching than this may differ: FCL rounds, and meshes of MoveIt are floats.
constexpr double kNearContact = 1e-6;  // metres

// The colliding pairs of each 20th state are compared, and those of all states whose verdicts differ. Pairs take a
// hundred times as long as verdicts.
constexpr int kStatesPerPairs = 20;

bool collides(const PlanningScene& scene, const RobotState& state, const CollisionRequest& request = CollisionRequest())
{
  CollisionResult result;
  scene.checkCollision(request, result, state);
  return result.collision;
}

using Pairs = CollisionResult::ContactMap;

Pairs pairsOf(const PlanningScene& scene, const RobotState& state)
{
  CollisionRequest request;
  request.contacts = true;
  request.max_contacts = 1000000;  // of all pairs
  CollisionResult result;
  scene.checkCollision(request, result, state);
  return result.contacts;
}

/// The distance of a pair with and without padding, by the detector of a scene; negative in penetration. NaN if
/// the detector gives none.
struct PairDistance
{
  double padded;
  double unpadded;
};

PairDistance distanceOf(const PlanningScene& scene, const RobotState& state,
                        const std::pair<std::string, std::string>& pair)
{
  const auto link_of = [&state](const std::string& body)
  {
    return state.hasAttachedBody(body) ? state.getAttachedBody(body)->getAttachedLink()
                                       : state.getRobotModel()->getLinkModel(body);
  };
  const bool world_first = scene.getWorld()->hasObject(pair.first);
  const bool self = !world_first && !scene.getWorld()->hasObject(pair.second);
  const std::set<const moveit::core::LinkModel*> links = {link_of(world_first ? pair.second : pair.first)};
  DistanceRequest request;
  request.type = DistanceRequestType::SINGLE;
  request.enable_signed_distance = true;  // without it, FCL's detector stops at the first collision
  request.acm = &scene.getAllowedCollisionMatrix();
  request.active_components_only = &links;
  const auto measured = [&](const collision_detection::CollisionEnv& environment)
  {
    DistanceResult result;
    if (self)
      environment.distanceSelf(request, result, state);
    else
      environment.distanceRobot(request, result, state);
    const auto found = result.distances.find(pair);
    return found == result.distances.end() ? std::nan("") : found->second.front().distance;
  };
  const double unpadded = measured(*scene.getCollisionEnvUnpadded());
  return {self ? unpadded : measured(*scene.getCollisionEnv()), unpadded};
}

/// The scenes of the comparison: ours, FCL's, and FCL's with meshes for the primitives of the world.
struct Scenes
{
  PlanningScenePtr ours;
  PlanningScenePtr fcl;
  PlanningScenePtr fcl_meshes;
};

/// Why the verdicts of a pair differ.
std::string reasonOf(const Scenes& scenes, const RobotState& state, const std::pair<std::string, std::string>& pair,
                     bool ours_collides, double padding)
{
  const double distance = distanceOf(*scenes.ours, state, pair).padded;
  if (std::abs(distance) <= kNearContact)
    return "within a micrometre of touching";
  if (padding > 0.0)
  {
    const double surfaces = distanceOf(*scenes.fcl, state, pair).unpadded;
    if (!std::isnan(surfaces) && (surfaces <= padding) == ours_collides)
      return "FCL's padding is not a distance";
  }
  if (!ours_collides)
    return "UNEXPLAINED: only FCL finds it";
  if (distanceOf(*scenes.fcl_meshes, state, pair).unpadded > kNearContact)
    return "one body inside the other";
  if (pairsOf(*scenes.fcl_meshes, state).count(pair) != 0)
    return "FCL misses a primitive, but not its mesh";
  return "UNEXPLAINED: only ours finds it";
}

/// The verdicts of the detector on random states.
struct Verdicts
{
  std::vector<double> rows;  ///< of the active variables
  std::vector<std::uint8_t> free;

  void add(const RobotState& state, bool is_free)
  {
    for (const std::string& variable : activeVariables(*state.getRobotModel()))
      rows.push_back(state.getVariablePosition(variable));
    free.push_back(is_free ? 1 : 0);
  }
};

/// Returns the number of states whose verdict by the node differs from that of the detector.
int differencesOfNode(const StudyNode& node, const PlanningScene& scene, const RobotState& state,
                      const Verdicts& verdicts)
{
  node.setScene(scene, state);
  const auto pairs = node.collidingPairs(*scene.getRobotModel(), verdicts.rows);
  int differences = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].first.empty() != (verdicts.free[i] != 0))
    {
      ++differences;
      std::fprintf(stderr, "state %zu: for the node alone, it is %s %s - %s\n", i,
                   pairs[i].first.empty() ? "free" : "in collision", pairs[i].first.c_str(), pairs[i].second.c_str());
    }
  return differences;
}

int agreement(const std::string& name, int states, const std::optional<StudyNode>& node)
{
  const moveit::core::RobotModelPtr robot = loadStudyRobot(name);
  struct Kind
  {
    const char* title;
    int objects;
    int cells;
    bool tool;
    double padding;
  };
  std::printf(
      "robot,scene,states,colliding,colliding pairs,states that differ,reason,pairs that differ,"
      "states that differ for the node\n");
  int unexplained = 0;
  for (const Kind& kind : {Kind{"20 objects", 20, 0, false, 0.0}, Kind{"20 objects and a tool", 20, 0, true, 0.0},
                           Kind{"octomap", 0, 3000, false, 0.0}, Kind{"octomap and a tool", 6, 3000, true, 0.0},
                           Kind{"20 objects, a tool and 2 cm of padding", 20, 0, true, 0.02}})
  {
    const Scenes scenes = {makeStudyScene(robot, true), makeStudyScene(robot, false), makeStudyScene(robot, false)};
    for (const PlanningScenePtr& scene : {scenes.ours, scenes.fcl, scenes.fcl_meshes})
    {
      addStudyObjects(*scene, kind.objects, 1, scene == scenes.fcl_meshes);
      if (kind.cells > 0)
        addStudyOctomap(*scene, kind.cells, 2);
      scene->getCollisionEnvNonConst()->setPadding(kind.padding);
    }
    RobotState state = scenes.ours->getCurrentState();
    if (kind.tool)
      attachStudyTool(state);
    random_numbers::RandomNumberGenerator random(7);
    int colliding = 0;
    int pairs = 0;
    int differences = 0;
    std::map<std::string, int> reasons;
    Verdicts verdicts;
    for (int i = 0; i < states / 5; ++i)
    {
      randomizeState(state, random);
      const bool verdict = collides(*scenes.ours, state);
      const bool differs = verdict != collides(*scenes.fcl, state);
      verdicts.add(state, !verdict);
      colliding += verdict ? 1 : 0;
      differences += differs ? 1 : 0;
      if (!differs && i % kStatesPerPairs != 0)
        continue;
      const Pairs ours = pairsOf(*scenes.ours, state);
      const Pairs fcl = pairsOf(*scenes.fcl, state);
      pairs += static_cast<int>(ours.size());
      const auto explain = [&](const Pairs& pairs_of_one, const Pairs& pairs_of_other, bool ours_collides)
      {
        for (const auto& [pair, contacts] : pairs_of_one)
        {
          if (pairs_of_other.count(pair) != 0)
            continue;
          const std::string reason = reasonOf(scenes, state, pair, ours_collides, kind.padding);
          ++reasons[reason];
          if (reason[0] != 'U')
            continue;
          ++unexplained;
          std::fprintf(stderr, "%s, %s, state %d: %s - %s: %s; distance %g\n", name.c_str(), kind.title, i,
                       pair.first.c_str(), pair.second.c_str(), reason.c_str(),
                       distanceOf(*scenes.ours, state, pair).padded);
        }
      };
      explain(ours, fcl, true);
      explain(fcl, ours, false);
    }
    if (reasons.empty())
      reasons["-"] = 0;
    std::string of_node = "-";
    if (node)
    {
      const int differ = differencesOfNode(*node, *scenes.ours, state, verdicts);
      unexplained += differ;
      of_node = std::to_string(differ);
    }
    for (const auto& [reason, count] : reasons)
      std::printf("%s,\"%s\",%d,%d,%d,%d,%s,%d,%s\n", name.c_str(), kind.title, states / 5, colliding, pairs,
                  differences, reason.c_str(), count, of_node.c_str());
    std::fflush(stdout);
  }
  return unexplained == 0 ? 0 : 1;
}

/// The processor time of this thread, in seconds. Unlike wall time, it does not count the time of other programs.
double processorSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double secondsOf(const std::function<void()>& work)
{
  const double start = processorSeconds();
  work();
  return processorSeconds() - start;
}

double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Times two variants of the same work in turns. Prints the medians, in microseconds for one of `count` parts.
void printCost(const std::string& title, std::size_t count, const std::array<std::function<void()>, 2>& work)
{
  constexpr int kRepeats = 9;
  std::array<std::vector<double>, 2> seconds;
  for (int i = 0; i < kRepeats; ++i)
    for (std::size_t k = 0; k < 2; ++k)
    {
      const double taken = secondsOf(work[k]);
      if (i > 0)  // the first run fills caches
        seconds[k].push_back(1e6 * taken / static_cast<double>(count));
    }
  std::printf("%s,%.2f,%.2f,%.2f\n", title.c_str(), median(seconds[0]), median(seconds[1]),
              median(seconds[0]) / median(seconds[1]));
  std::fflush(stdout);
}

/// Up to `count` random states that collide, or that do not.
std::vector<RobotState> statesWith(const PlanningScene& scene, bool colliding, std::size_t count)
{
  random_numbers::RandomNumberGenerator random(3);
  std::vector<RobotState> states;
  RobotState state = scene.getCurrentState();
  for (int tries = 0; states.size() < count && tries < 50000; ++tries)
  {
    randomizeState(state, random);
    if (collides(scene, state) == colliding)
      states.push_back(state);
  }
  return states;
}

void printStateCost(const std::string& title, const std::array<PlanningScenePtr, 2>& scenes, bool colliding,
                    const CollisionRequest& request, std::size_t count)
{
  const std::vector<RobotState> states = statesWith(*scenes[0], colliding, count);
  if (states.empty())
  {
    std::printf("%s,no states\n", title.c_str());
    return;
  }
  const auto check = [&](const PlanningScenePtr& scene)
  {
    return [&states, &request, scene]
    {
      for (const RobotState& state : states)
        collides(*scene, state, request);
    };
  };
  printCost(title, states.size(), {check(scenes[0]), check(scenes[1])});
}

void printChangeCost(const std::string& title, const std::array<PlanningScenePtr, 2>& scenes)
{
  constexpr int kChanges = 30;
  const RobotState state = scenes[0]->getCurrentState();
  const auto repeat = [](const PlanningScenePtr& scene, const std::function<void(PlanningScene&, int)>& change)
  {
    return [scene, change]
    {
      for (int i = 0; i < kChanges; ++i)
        change(*scene, i);
    };
  };
  const auto measure = [&](const std::string& what, const std::function<void(PlanningScene&, int)>& change) {
    printCost(title + what, kChanges, {repeat(scenes[0], change), repeat(scenes[1], change)});
  };
  measure("an object moved and a state checked",
          [&state](PlanningScene& scene, int i)
          {
            scene.getWorldNonConst()->moveObject(
                "object0", Eigen::Isometry3d(Eigen::Translation3d(i % 2 == 0 ? 0.01 : -0.01, 0, 0)));
            collides(scene, state);
          });
  const shapes::ShapeConstPtr box = std::make_shared<shapes::Box>(0.1, 0.1, 0.1);
  measure(
      "a box added and removed and a state checked",
      [&state](PlanningScene& scene, int)
      {
        scene.getWorldNonConst()->addToObject("new", Eigen::Isometry3d(Eigen::Translation3d(2, 0, 0)),
                                              std::make_shared<shapes::Box>(0.1, 0.1, 0.1),
                                              Eigen::Isometry3d::Identity());
        collides(scene, state);
        scene.getWorldNonConst()->removeObject("new");
      });
  measure("a difference of the scene made and a state checked",
          [&state](PlanningScene& scene, int) { collides(*scene.diff(), state); });
}

void printMemory(const std::string& title, const PlanningScenePtr& scene)
{
  const auto used = [] { return static_cast<double>(mallinfo2().uordblks) / 1e3; };
  const double before = used();
  std::vector<PlanningScenePtr> copies;
  for (int i = 0; i < 100; ++i)
    copies.push_back(PlanningScene::clone(scene));
  std::printf("%s,100 cloned scenes: %.0f kB\n", title.c_str(), used() - before);
}

int cost(const std::string& name)
{
  const moveit::core::RobotModelPtr robot = loadStudyRobot(name);
  std::printf("case,ours (us),FCL (us),ratio\n");
  for (const int objects : {1, 10, 100})
  {
    const std::array<PlanningScenePtr, 2> scenes = {makeStudyScene(robot, true), makeStudyScene(robot, false)};
    for (const PlanningScenePtr& scene : scenes)
      addStudyObjects(*scene, objects, 5);
    const std::string title = name + "; " + std::to_string(objects) + " objects; ";
    printStateCost(title + "free", scenes, false, CollisionRequest(), 60);
    printStateCost(title + "colliding", scenes, true, CollisionRequest(), 60);
    CollisionRequest contacts;
    contacts.contacts = true;
    printStateCost(title + "colliding, with a contact", scenes, true, contacts, 30);
    contacts.max_contacts = 100;
    contacts.max_contacts_per_pair = 5;
    printStateCost(title + "colliding, with up to 100 contacts", scenes, true, contacts, 30);
    CollisionRequest distance;
    distance.distance = true;
    printStateCost(title + "free, with the distance", scenes, false, distance, 10);
    printChangeCost(title, scenes);
    printMemory(title + "ours", scenes[0]);
    printMemory(title + "FCL", scenes[1]);
  }
  return 0;
}
}  // namespace
}  // namespace gpu_planning_scene

int main(int argc, char** argv)
{
  ros::init(argc, argv, "moveit_study", ros::init_options::NoRosout);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Error);
  try
  {
    if ((arguments.size() == 3 || arguments.size() == 4) && arguments[0] == "agreement")
    {
      std::optional<ros::NodeHandle> ros_is_up;
      std::optional<gpu_planning_scene::StudyNode> node;
      if (arguments.size() == 4)
      {
        ros_is_up.emplace();
        node.emplace(arguments[3]);
      }
      return gpu_planning_scene::agreement(arguments[1], std::stoi(arguments[2]), node);
    }
    if (arguments.size() == 2 && arguments[0] == "cost")
      return gpu_planning_scene::cost(arguments[1]);
    std::fprintf(stderr, "usage: moveit_study agreement ROBOT STATES [NODE] | moveit_study cost ROBOT\n");
    return 2;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "moveit_study: %s\n", error.what());
    return 1;
  }
}
