#include "node/moveit/followed_scene.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "model/text/name_list.h"
#include "node/endpoints/respond.h"
#include "node/moveit/mimic_joints.h"

namespace gpu_planning_scene::core
{
namespace
{
const ros::WallDuration kPollInterval(0.05);       // between two looks at the connections
constexpr std::chrono::milliseconds kRetry{500};   // between two fetches while the scene is not known
constexpr std::chrono::milliseconds kSettle{500};  // from the first fetch to the next: see fetch()
constexpr double kWatchPeriod = 0.1;               // seconds: between two looks at a fetch that takes too long
// A fetch that takes longer is noticed if messages wait. MoveIt's own publisher collects changes for as long.
constexpr std::chrono::milliseconds kLongFetch{500};
// All bits of PlanningSceneComponents. Some servers leave parts out if the request is 0.
constexpr std::uint32_t kAllComponents = 1023;
constexpr double kLongestPeriod = 1e8;                // seconds; a longer period would overflow the clock
constexpr std::chrono::milliseconds kLongLoss{1000};  // after this time, a loss of the scene is logged

std::string listed(const std::set<std::string>& parts)
{
  return nameList({parts.begin(), parts.end()});
}

template <class Objects>
bool hasObject(const Objects& objects, const std::string& id)
{
  return std::any_of(
      objects.begin(), objects.end(), [&id](const auto& object) { return object.id == id; });
}

bool isAttached(const PlanningScene& scene, const std::string& id)
{
  return std::any_of(
      scene.attached.begin(), scene.attached.end(),
      [&id](const AttachedObject& attached) { return attached.object.id == id; });
}

/// Drops removals of objects that the scene does not have. After a fetch, a message can arrive that is older than the
/// fetched scene.
void dropRemovalsOfMissing(const PlanningScene& scene, SceneChange& change)
{
  const auto is_void = [&scene](const ObjectChange& object)
  {
    return object.operation == Operation::Remove && !object.id.empty() && !hasObject(scene.objects, object.id) &&
           !isAttached(scene, object.id);
  };
  const auto is_void_detach = [&scene](const AttachedChange& attached)
  {
    return attached.object.operation == Operation::Remove && !attached.object.id.empty() &&
           !isAttached(scene, attached.object.id);
  };
  change.objects.erase(std::remove_if(change.objects.begin(), change.objects.end(), is_void), change.objects.end());
  std::vector<AttachedChange>& attached = change.state.attached;
  attached.erase(std::remove_if(attached.begin(), attached.end(), is_void_detach), attached.end());
}
}  // namespace

std::set<std::string> partsOf(const SceneChange& change)
{
  std::set<std::string> parts;
  const auto add = [&parts](const char* what, const std::string& name) { parts.insert(what + (" '" + name + "'")); };
  if (!change.name.empty())
    parts.insert("the name");
  if (!change.fixed_frames.empty())
    parts.insert("the fixed frames");
  if (change.matrix)
    parts.insert("the allowed collision matrix");
  for (const AttachedChange& attached : change.state.attached)
    add("object", attached.object.id);
  for (const auto& [link, padding] : change.link_padding)
    add("the padding of", link);
  for (const auto& [link, scale] : change.link_scale)
    add("the scale of", link);
  for (const auto& [id, color] : change.colors)
    add("the colour of", id);
  for (const ObjectChange& object : change.objects)
    add("object", object.id);
  return parts;
}

FollowedScene::FollowedScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const MonitorOptions& options,
                             SceneStore& store, SceneServices& changes, SceneStore::Lookup lookup)
  : options_(options), store_(store), changes_(changes), lookup_(std::move(lookup)), node_(node)
{
  lose("it has not arrived yet; call again later");
  node_.setCallbackQueue(&queue_);
  // Without a bound, because roscpp drops messages silently. The thread takes them at once, except during a fetch,
  // which has a timeout.
  subscriber_ = node_.subscribe<Message, const Event&>(
      options_.topic(), 0,
      boost::function<void(const Event&)>([this](const Event& event) { messages_.push_back(event); }));
  timer_ = timers.createWallTimer(
      ros::WallDuration(kWatchPeriod), [this](const ros::WallTimerEvent&) { endLongCall(); });
  thread_ = std::thread([this] { run(); });
}

FollowedScene::~FollowedScene()
{
  stop();
}

/// Drops the connection of a running fetch, which ends the fetch. Repeats it, because the fetch may be about to
/// connect.
void FollowedScene::stop()
{
  stopping_ = true;
  timer_.stop();
  while (thread_.joinable() && !ended_)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      client_.shutdown();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (thread_.joinable())
    thread_.join();
}

std::string FollowedScene::fault() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (fault_.empty() && is_calling_ && Clock::now() - call_began_ > std::chrono::duration<double>(options_.timeout))
    return unknown(options_.service + " does not answer");
  // While the thread fetches, messages wait.
  if (fault_.empty() && is_fetching_ && Clock::now() - call_began_ > kLongFetch && !queue_.isEmpty())
    return unknown("it changes while it is being fetched, which takes long");
  return fault_;
}

void FollowedScene::run()
{
  while (!stopping_)
  {
    queue_.callAvailable(kPollInterval);
    const std::string error = errorOf([this] { step(); });
    if (!error.empty())
      lose(error);
    logLongLoss();
  }
  ended_ = true;
}

void FollowedScene::step()
{
  if (!hasPublisher())
  {
    messages_.clear();
    return;
  }
  if (is_current_)
    applyMessages();
  if (Clock::now() < next_fetch_)
    return;
  // The fetched scene is newer than all messages that have arrived before the request.
  queue_.callAvailable();
  if (is_current_)
    applyMessages();
  messages_.clear();
  fetch();
}

bool FollowedScene::hasPublisher()
{
  const std::uint32_t publishers = subscriber_.getNumPublishers();
  if (publishers == 0)
    lose("no node publishes " + options_.topic());
  else if (publishers > 1)
    lose("several nodes publish " + options_.topic());
  else if (is_current_ && !isConnected())
    lose("the connection to " + options_.service + " was lost");
  return publishers == 1;
}

/// The connection to the service stays open, so that the end of its node is noticed.
bool FollowedScene::isConnected() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return client_.isValid();
}

void FollowedScene::applyMessages()
{
  std::vector<Event> messages;
  messages.swap(messages_);
  for (const Event& event : messages)
  {
    if (event.getConnectionHeaderPtr() != header_)
    {
      const bool is_first = header_ == nullptr;
      header_ = event.getConnectionHeaderPtr();
      if (!is_first)
      {
        lose("the connection to the publisher of " + options_.topic() + " was made anew");
        return;
      }
    }
    const std::string error = errorOf([&] { apply(event); });
    if (error.empty())
      continue;
    lose("a message on " + options_.topic() + " cannot be applied: " + error);
    return;
  }
}

void FollowedScene::apply(const Event& event)
{
  const Message& message = *event.getConstMessage();
  if (!message.fault.empty())
    throw Error(message.fault);
  SceneChange change = changeOf(message.message.ours);
  if (change.is_diff)
    for (const std::string& part : partsOf(change))
      unconfirmed_.erase(part);
  else
    unconfirmed_.clear();
  dropMeasured(change);
  if (change.is_diff)
    dropRemovalsOfMissing(*store_.snapshot().scene, change);
  changes_.make(change, lookup_);
}

SceneChange FollowedScene::changeOf(const PlanningSceneMessage& message)
{
  const Snapshot now = store_.snapshot();
  const RobotModel& robot = *now.scene->robot;
  if (const std::string fault = mimicFault(message, robot, now.state); !fault.empty())
    mimic_warning_.log(options_.topic() + ": " + fault);
  SceneChange change = changes_.changeOf(withoutMimicJoints(message, robot));
  // An empty matrix of a whole scene allows nothing in MoveIt. Elsewhere in this package, it means that of the SRDF.
  if (!change.is_diff && !change.matrix)
    change.matrix = AllowedCollisionMatrix();
  return change;
}

void FollowedScene::dropMeasured(SceneChange& change) const
{
  const Snapshot now = store_.snapshot();
  std::map<std::string, double>& variables = change.state.variables;
  for (auto variable = variables.begin(); variable != variables.end();)
  {
    const int index = now.scene->robot->variableIndex(variable->first);
    const bool is_measured = index >= 0 && now.measured[static_cast<std::size_t>(index)];
    variable = is_measured ? variables.erase(variable) : std::next(variable);
  }
}

std::string FollowedScene::unknown(const std::string& reason) const
{
  return "the scene of " + options_.monitor + " is not known: " + reason;
}

/// From now on, requests are refused with this reason.
void FollowedScene::lose(const std::string& reason)
{
  if (is_current_)
    next_fetch_ = lost_at_ = Clock::now();
  is_current_ = false;
  const std::lock_guard<std::mutex> lock(mutex_);
  fault_ = unknown(reason);
}

void FollowedScene::logLongLoss()
{
  const std::string reason = fault();
  if (is_current_ || Clock::now() - lost_at_ < kLongLoss || reason == logged_)
    return;
  ROS_WARN_STREAM(reason << "; checks, plans and changes are refused");
  logged_ = reason;
}

void FollowedScene::fetch()
{
  MoveItGetScene::Request request;
  request.ours.components.components = kAllComponents;
  Bounded<MoveItGetScene::Response> response;
  const bool was_answered = call(request, response);
  next_fetch_ = Clock::now() + kRetry;
  std::string error;
  if (!was_answered)
    error = options_.service + " does not answer";
  else if (!response.fault.empty())
    error = "the answer of " + options_.service + " cannot be read: " + response.fault;
  else
    error = errorOf([&] { takeOver(response.message.ours); });
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_fetching_ = false;
  }
  if (error.empty())
  {
    // A publisher needs a moment to send its messages to a new subscriber. So the first fetch is soon followed by
    // another one.
    const std::chrono::duration<double> period(std::min(options_.period, kLongestPeriod));
    const bool is_settled = is_current_;
    next_fetch_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     is_settled ? period : std::min<std::chrono::duration<double>>(period, kSettle));
    is_current_ = true;
    was_current_ = true;
    logged_.clear();
    const std::lock_guard<std::mutex> lock(mutex_);
    fault_.clear();
    return;
  }
  lose(error);
}

bool FollowedScene::call(MoveItGetScene::Request& request, Bounded<MoveItGetScene::Response>& response)
{
  ros::ServiceClient client;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    client = client_;
    is_calling_ = is_fetching_ = true;
    call_began_ = Clock::now();
  }
  if (!client.isValid())
  {
    // It connects at once, which can take long. So it is made without the lock.
    ros::ServiceClientOptions service(options_.service, ros::service_traits::md5sum<MoveItGetScene>(), true, {});
    client = node_.serviceClient(service);
    const std::lock_guard<std::mutex> lock(mutex_);
    client_ = client;
  }
  const bool was_answered =
      client.isValid() && client.call(request, response, ros::service_traits::md5sum<MoveItGetScene>());
  const std::lock_guard<std::mutex> lock(mutex_);
  is_calling_ = false;
  return was_answered;
}

/// Makes the differences between the node's scene and the whole one, so that equal parts keep their trees.
void FollowedScene::takeOver(const PlanningSceneMessage& whole)
{
  if (whole.is_diff)
    throw Error("the answer is not a whole scene (is_diff is true)");
  if (whole.robot_model_name.empty())
    throw Error("the answer names no robot (robot_model_name is empty)");
  SceneChange full = changeOf(whole);
  dropMeasured(full);
  const Snapshot now = store_.snapshot();
  const SceneStore::Preview wanted = store_.preview({full}, lookup_);
  SceneChange change = diffOf(*now.scene, *wanted.snapshot.scene);
  change.state.variables.clear();
  for (const auto& [name, value] : full.state.variables)
  {
    const auto variable = static_cast<std::size_t>(now.scene->robot->variableIndex(name));
    if (!now.known[variable] || now.state[variable] != value)
      change.state.variables[name] = value;
  }
  const std::set<std::string> differences = partsOf(change);
  if (!change.is_diff || !differences.empty() || !change.state.variables.empty())
    changes_.make(change, lookup_);
  report(differences);
}

void FollowedScene::report(const std::set<std::string>& differences)
{
  const std::string differed = differences.empty() ? "; it did not differ" : "; it differed in " + listed(differences);
  if (!was_current_)
  {
    const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
    ROS_INFO_STREAM("following the scene of " << options_.monitor << ": " << scene->objects.size() << " objects, "
                                              << scene->attached.size() << " attached objects");
  }
  else if (!is_current_)
    ROS_WARN_STREAM(fault() << "; it was fetched anew" << differed);
  else if (!unconfirmed_.empty())
    ROS_WARN_STREAM("a message of " << options_.topic() << " was missed: none has named " << listed(unconfirmed_)
                                    << "; the whole scene was fetched anew");
  // Messages that are on their way will name these parts.
  unconfirmed_ = is_current_ ? differences : std::set<std::string>();
}

void FollowedScene::endLongCall()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_calling_ && Clock::now() - call_began_ > std::chrono::duration<double>(options_.timeout))
    client_.shutdown();
}
}  // namespace gpu_planning_scene::core
