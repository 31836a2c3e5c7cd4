#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "node/endpoints/bounded_message.h"
#include "node/moveit/moveit_messages.h"
#include "node/moveit/moveit_options.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// The parts of a scene that a change names, in words, for example "object 'box'". The values of joints are left out.
std::set<std::string> partsOf(const SceneChange& change);

/// Keeps the node's scene equal to the scene of a running move_group. It fetches the whole scene with MoveIt's service
/// get_planning_scene, and then applies the messages of monitored_planning_scene. MoveIt numbers neither messages nor
/// scenes. So the whole scene is fetched anew if the publisher or the connection to it changes, if a message cannot be
/// applied, and periodically. If a periodic fetch brings a change that no message brings until the next fetch, a
/// message was missed, and there is a warning. Values of joints that the topic joint_states has brought are kept.
class FollowedScene
{
 public:
  /// `timers`: the node handle for a timer. All arguments passed by reference must outlive this object.
  FollowedScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const MonitorOptions& options, SceneStore& store,
                SceneServices& changes, SceneStore::Lookup lookup);
  /// Calls stop().
  ~FollowedScene();

  /// The reason why the followed scene is not known now; empty if it is known. Thread-safe.
  std::string fault() const;
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  using Message = Bounded<MoveItScene>;
  using Event = ros::MessageEvent<const Message>;

  void run();
  void step();
  bool hasPublisher();
  bool isConnected() const;
  void applyMessages();
  void apply(const Event& event);
  std::string unknown(const std::string& reason) const;
  void lose(const std::string& reason);
  void logLongLoss();
  void fetch();
  bool call(MoveItGetScene::Request& request, Bounded<MoveItGetScene::Response>& response);
  void takeOver(const PlanningSceneMessage& whole);
  void report(const std::set<std::string>& differences);
  SceneChange changeOf(const PlanningSceneMessage& message);
  void dropMeasured(SceneChange& change) const;
  void endLongCall();

  const MonitorOptions options_;
  SceneStore& store_;
  SceneServices& changes_;
  const SceneStore::Lookup lookup_;
  mutable ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;

  // Used by the thread only.
  std::vector<Event> messages_;              // received and not applied yet
  boost::shared_ptr<ros::M_string> header_;  // of the connection of the last message
  bool is_current_ = false;
  bool was_current_ = false;
  Clock::time_point next_fetch_ = Clock::now();
  Clock::time_point lost_at_ = Clock::now();
  std::set<std::string> unconfirmed_;  // parts that the last fetch changed, and that no message has named since
  std::string logged_;                 // the last reason in the log
  OccasionalWarning mimic_warning_;

  mutable std::mutex mutex_;  // guards the members below
  std::string fault_;
  ros::ServiceClient client_;
  bool is_calling_ = false;
  bool is_fetching_ = false;
  Clock::time_point call_began_;

  std::atomic<bool> stopping_{false};
  std::atomic<bool> ended_{false};
  ros::WallTimer timer_;
  std::thread thread_;  // last member: the thread uses all members above
};
}  // namespace gpu_planning_scene::core
