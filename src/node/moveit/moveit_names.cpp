#include "node/moveit/moveit_names.h"

#include "gpu_planning_scene/error.h"
#include "node/messages/to_messages.h"
#include "node/moveit/mimic_joints.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kStatePeriod = 0.5;  // seconds, as in MoveIt
constexpr std::size_t kSceneThreads = 4;
constexpr std::size_t kCheckThreads = 16;
constexpr char kApplyScene[] = "apply_planning_scene";
constexpr char kGetScene[] = "get_planning_scene";
constexpr char kClearOctomap[] = "clear_octomap";
constexpr char kStateValidity[] = "check_state_validity";
constexpr char kIk[] = "compute_ik";
constexpr char kFk[] = "compute_fk";
constexpr char kLines[] = "compute_cartesian_path";

/// ROS would let the node take the service away from the other node silently.
void requireFreeServices(const ros::NodeHandle& node)
{
  for (const char* name : {kApplyScene, kGetScene, kClearOctomap, kStateValidity, kIk, kFk, kLines})
    if (const std::string service = node.resolveName(name); ros::service::exists(service, false))
      throw Error("parameter ~moveit_names is true, but another node has the service " + service +
                  " already; to follow a running move_group, give its name in ~monitor instead");
}

MoveItScene asMoveIt(PlanningSceneMessage message)
{
  return {std::move(message)};
}
}  // namespace

MoveItScenePublisher::MoveItScenePublisher(ros::NodeHandle& node, SceneStore& store) : store_(store)
{
  publisher_ = node.advertise<MoveItScene>(
      "move_group/monitored_planning_scene", 100,
      boost::function<void(const ros::SingleSubscriberPublisher&)>(
          [this](const ros::SingleSubscriberPublisher& subscriber) { publishFull(subscriber); }));
  store_.setListener(
      this, [this](const auto& before, const auto& after) { changed(before, after); });
  timer_ =
      node.createWallTimer(ros::WallDuration(kStatePeriod), [this](const ros::WallTimerEvent&) { publishState(); });
}

MoveItScenePublisher::~MoveItScenePublisher()
{
  timer_.stop();
  store_.setListener(this, {});
}

/// Must not throw: the change has already been made.
void MoveItScenePublisher::changed(const std::shared_ptr<const PlanningScene>& before,
                                   const std::shared_ptr<const PlanningScene>& after)
{
  if (publisher_.getNumSubscribers() == 0)
    return;
  const std::string error = errorOf(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const Snapshot now = store_.snapshot();
        SceneChange change = diffOf(*before, *after);
        dropUnknown(now, change);
        // A full scene of a change leaves out the robot's own matrix, which MoveIt would take as an empty one.
        publisher_.publish(asMoveIt(change.is_diff ? messageOf(change, *after->robot)
                                                   : messageOf(*now.scene, 0, now.state, now.known)));
      });
  if (!error.empty())
    ROS_ERROR_STREAM("the scene was changed, but the change was not published for MoveIt: " << error);
}

void MoveItScenePublisher::publishFull(const ros::SingleSubscriberPublisher& subscriber)
{
  const std::string error = errorOf(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const Snapshot now = store_.snapshot();
        subscriber.publish(asMoveIt(messageOf(*now.scene, 0, now.state, now.known)));
      });
  if (!error.empty())
    ROS_ERROR_STREAM("the scene was not published for MoveIt: " << error);
}

void MoveItScenePublisher::publishState()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const Snapshot now = store_.snapshot();
  if (publisher_.getNumSubscribers() == 0 || now.state == published_state_)
    return;
  SceneChange change;
  change.is_diff = true;
  for (std::size_t i = 0; i < now.state.size(); ++i)
    if (now.known[i])
      change.state.variables[now.scene->robot->variables()[i].name] = now.state[i];
  publisher_.publish(asMoveIt(messageOf(change, *now.scene->robot)));
  published_state_ = now.state;
}

MoveItNames::MoveItNames(ros::NodeHandle& node, SceneStore& store, SceneServices& changes,
                         const ClearOctomap& clear_octomap, const StateValidity& validity,
                         const MoveItKinematics& kinematics, const FrameLookup& lookup, Diagnostics& diagnostics,
                         std::size_t max_changes, std::size_t max_bytes)
  : publisher_((requireFreeServices(node), node), store),
    scenes_(node, node, kSceneThreads, diagnostics),
    checks_(node, node, kCheckThreads, diagnostics),
    topics_(node, node, changes, lookup, diagnostics, max_changes, max_bytes)
{
  const auto without_mimic_joints = [this, &store](const PlanningSceneMessage& scene)
  {
    const Snapshot now = store.snapshot();
    if (const std::string fault = mimicFault(scene, *now.scene->robot, now.state); !fault.empty())
      mimic_warning_.log("the planning scene: " + fault);
    return withoutMimicJoints(scene, *now.scene->robot);
  };
  topics_.subscribe<MoveItScene>(
      "planning_scene", [&changes, without_mimic_joints](const MoveItScene& m)
      { return changes.changeOf(without_mimic_joints(m.ours)); });
  topics_.subscribe<MoveItWorld>(
      "planning_scene_world", [&changes](const MoveItWorld& m) { return changes.changeOf(m.ours); });
  topics_.subscribe<MoveItObject>(
      "collision_object", [&changes](const MoveItObject& m) { return changes.changeOf(m.ours); });
  topics_.subscribe<MoveItAttachedObject>(
      "attached_collision_object", [&changes](const MoveItAttachedObject& m) { return changes.changeOf(m.ours); });
  checks_.advertise<MoveItStateValidity>(
      kStateValidity, [&validity](const MoveItStateValidity::Request& r) { return validity.answer(r.ours); });
  checks_.advertise<moveit_msgs::GetPositionIK>(
      kIk, [&kinematics](const moveit_msgs::GetPositionIK::Request& r) { return kinematics.ik(r); });
  checks_.advertise<moveit_msgs::GetPositionFK>(
      kFk, [&kinematics](const moveit_msgs::GetPositionFK::Request& r) { return kinematics.fk(r); });
  checks_.advertise<moveit_msgs::GetCartesianPath>(
      kLines, [&kinematics](const moveit_msgs::GetCartesianPath::Request& r) { return kinematics.lines(r); });
  scenes_.advertise<MoveItGetScene>(kGetScene, [&changes](const MoveItGetScene::Request& r)
                                    { return MoveItGetScene::Response{changes.get(r.ours).scene}; });
  scenes_.advertise<MoveItApplyScene>(kApplyScene,
                                      [&changes, without_mimic_joints](const MoveItApplyScene::Request& r)
                                      {
                                        ApplyPlanningScene::Request request;
                                        request.scene = without_mimic_joints(r.ours);
                                        const ApplyPlanningScene::Response applied = changes.apply(request);
                                        if (!applied.success)
                                          throw Error(applied.message);
                                        if (!applied.message.empty())
                                          warnOfMessage({applied.message});
                                        return MoveItApplyScene::Response();
                                      });
  scenes_.advertise<MoveItEmpty>(kClearOctomap,
                                 [clear_octomap](const MoveItEmpty::Request&)
                                 {
                                   if (const Clear::Response cleared = clear_octomap(); !cleared.success)
                                     throw Error(cleared.message);
                                   return MoveItEmpty::Response();
                                 });
}

void MoveItNames::close()
{
  scenes_.close();
  checks_.close();
  topics_.close();
}

void MoveItNames::stop()
{
  topics_.stop();
  scenes_.stop();
  checks_.stop();
}

bool MoveItNames::refuseWaiting()
{
  const bool has_answered = scenes_.refuseWaiting();
  return checks_.refuseWaiting() || has_answered;
}
}  // namespace gpu_planning_scene::core
