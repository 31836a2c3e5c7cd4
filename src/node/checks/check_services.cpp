#include "node/checks/check_services.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <numeric>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

#include <ros/console.h>

#include "collision/bounds/reach.h"
#include "collision/checkers/scene_text.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/joint_limits.h"
#include "model/seconds_since.h"
#include "node/endpoints/respond.h"
#include "node/endpoints/topic_warnings.h"
#include "node/messages/from_messages.h"
#include "node/messages/requested_states.h"
#include "scene/matrix_entries.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kInspections = 2;                    // at the same time
constexpr std::chrono::milliseconds kPollInterval{100};    // interval in which a waiting request checks for shutdown
constexpr std::chrono::milliseconds kShutdownGrace{4000};  // longest wait for the checker during a shutdown

Error shuttingDown()
{
  return Error("shutting down: the request was not answered");
}

/// The matrix of a request; null if it has none. Adds a warning to `text` if the matrix has only default entries.
std::shared_ptr<const AllowedCollisionMatrix> requestedMatrix(const AllowedCollisionMatrixMessage& message,
                                                              const RobotModel& robot, const SceneLimits& limits,
                                                              std::string& text)
{
  if (message.entry_names.empty() && message.entry_values.empty() && message.default_entry_names.empty())
    return nullptr;
  auto matrix = std::make_shared<const AllowedCollisionMatrix>(matrixFrom(message, limits));
  addWarning(warningOfDefaultsAlone(robot, *matrix), text);
  return matrix;
}

/// The value of a field of the request: the largest step between two samples.
double requestedStep(const char* field, double value, const char* unit)
{
  if (std::isfinite(value) && value > 0.0)
    return value;
  std::ostringstream text;
  text << field << " is " << value << "; give the largest step between two samples: a finite number of " << unit
       << " above 0, for example 0.02";
  throw Error(text.str());
}

/// The options for a request's motions, and the number of samples of all motions. Throws Error for more samples than
/// `limits` allows. `starts`, `ends`: one full state per motion.
std::pair<MotionCheckerOptions, std::size_t> requestedMotions(const CheckMotions::Request& request,
                                                              const RobotModel& robot, MotionRule default_rule,
                                                              const std::vector<double>& starts,
                                                              const std::vector<double>& ends,
                                                              const CheckServicesOptions& limits)
{
  const std::size_t max_samples = limits.max_states;
  MotionCheckerOptions options;
  options.max_checks = limits.max_motion_checks;
  options.rule = request.motion_rule.empty() ? default_rule : motionRuleFromName(request.motion_rule);
  options.steps = {requestedStep("resolution", request.resolution, "radians"),
                   requestedStep("translation_resolution", request.translation_resolution, "metres")};
  if (options.rule == MotionRule::Samples)
    options.max_samples = max_samples;
  const std::size_t width = robot.variables().size();
  double all = 0.0;
  for (std::size_t row = 0; row < starts.size(); row += width)
  {
    const double samples = segmentCount(robot, &starts[row], &ends[row], options.steps) + 1.0;
    all += samples;
    const std::string motion = "motion " + std::to_string(row / width);
    if (samples > static_cast<double>(options.max_samples))
      throw Error(motion + " has more than " + std::to_string(options.max_samples) +
                  " samples; cut it into several motions, or take larger steps");
    if (all > static_cast<double>(max_samples))
      throw Error("the motions up to " + motion + " have more than " + std::to_string(max_samples) +
                  " samples in total"
                  " (limits/request_states); send fewer motions, or take larger steps");
  }
  return {options, static_cast<std::size_t>(all)};
}

/// A warning if a joint is beyond its limits in one of the states; otherwise empty. The rule "bound" proves no motion
/// there, even if the group does not move the joint. `states`: full states, the starts or the ends of the motions.
std::string beyondLimits(const RobotModel& robot, const std::vector<double>& states)
{
  const std::size_t width = robot.variables().size();
  const std::vector<VariableRange> ranges = limitRanges(robot);
  for (std::size_t row = 0; row < states.size(); row += width)
    if (const ValuesOutsideLimits outside = valuesOutside(ranges, robot, &states[row]); outside.count() != 0)
      return "motion " + std::to_string(row / width) + ": " + outside.text() +
             "; the motion rule \"bound\" proves no motion there";
  return "";
}

/// A warning if the limit of checks left motions undecided; otherwise empty.
std::string givenUp(const std::vector<MotionVerdict>& motions, std::size_t max_checks)
{
  const auto is_given_up = [](const MotionVerdict& motion) { return motion.given_up; };
  const auto first = std::find_if(motions.begin(), motions.end(), is_given_up);
  if (first == motions.end())
    return "";
  const auto count = std::count_if(first, motions.end(), is_given_up);
  return std::to_string(count) + " of " + std::to_string(motions.size()) + " motions are not proven free, because " +
         std::to_string(max_checks) + " checks (limits/motion_checks) did not suffice; the first is motion " +
         std::to_string(first - motions.begin()) + "; send fewer or shorter motions in one request";
}

/// The indices of all variables.
std::vector<int> allColumns(const RobotModel& robot)
{
  std::vector<int> columns(robot.variables().size());
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

std::uint32_t bodyType(const PlanningScene& scene, std::int32_t body)
{
  const std::size_t links = scene.robot->links().size();
  const auto index = static_cast<std::size_t>(body);
  if (index < links)
    return ContactInformation::ROBOT_LINK;
  return index < links + scene.objects.size() ? ContactInformation::WORLD_OBJECT : ContactInformation::ROBOT_ATTACHED;
}

ContactInformation messageOf(const Contact& contact, const PlanningScene& scene, std::size_t state)
{
  ContactInformation message;
  message.header.frame_id = scene.robot->planningFrame();
  message.position.x = contact.point.x();
  message.position.y = contact.point.y();
  message.position.z = contact.point.z();
  message.normal.x = contact.normal.x();
  message.normal.y = contact.normal.y();
  message.normal.z = contact.normal.z();
  message.depth = contact.depth;
  message.contact_body_1 = scene.bodyName(contact.bodies[0]);
  message.body_type_1 = bodyType(scene, contact.bodies[0]);
  message.contact_body_2 = scene.bodyName(contact.bodies[1]);
  message.body_type_2 = bodyType(scene, contact.bodies[1]);
  message.state = static_cast<std::uint32_t>(state);
  return message;
}

/// Writes the report of `answer`, which must have one, into the response.
void fillReport(const CheckAnswer& answer, GetReport::Response& response)
{
  const SceneReport& report = *answer.report;
  response.lines = describeScene(*answer.scene, report, answer.device);
  response.lines.emplace_back("not modelled: octomaps, object types, weights; padding between links");
  const auto add = [&response](const char* name, std::size_t value)
  {
    response.names.emplace_back(name);
    response.values.push_back(static_cast<double>(value));
  };
  add("self_pairs", report.self_pairs);
  add("world_pairs", report.world_pairs);
  add("allowed_self_pairs", report.allowed_self_pairs);
  add("allowed_world_pairs", report.allowed_world_pairs);
  add("touch_pairs", report.touch_pairs);
  add("pairs_outside_group", report.pairs_outside_group);
  add("links_without_shapes", report.links_without_shapes);
  add("unreachable_self_pairs", report.unreachable_self_pairs);
  add("unreachable_world_pairs", report.unreachable_world_pairs);
  add("unreachable_objects", report.unreachable_objects);
  add("rigid_pairs", report.rigid_pairs);
  add("always_colliding", report.always_colliding ? 1 : 0);
  add("colliding_in_samples", report.colliding_in_samples.size());
  add("triangles", report.triangles);
  add("trees", report.trees);
  add("shared_trees", report.shared_trees);
  add("objects", answer.scene->objects.size());
  add("attached_objects", answer.scene->attached.size());
  response.scene_revision = answer.result.revision;
}
}  // namespace

CheckServices::CheckServices(const SceneStore& store, CheckServer& server, const MemoryGuard& memory,
                             const CheckServicesOptions& options)
  : store_(store),
    server_(server),
    memory_(memory),
    options_(options),
    inspections_(kInspections, options.max_waiting_inspections)
{
}

void CheckServices::stop()
{
  stopping_ = true;
  inspections_.stop();
}

/// Waits for the answer. After the start of the shutdown, the wait is bounded, because the checker may hang.
CheckAnswer CheckServices::answerOf(CheckJob job) const
{
  std::future<CheckAnswer> answer = server_.submit(std::move(job));
  std::chrono::milliseconds waited{0};  // since the start of the shutdown
  while (answer.wait_for(kPollInterval) != std::future_status::ready)
  {
    waited += stopping_ ? kPollInterval : std::chrono::milliseconds{0};
    if (waited >= kShutdownGrace)
      throw shuttingDown();
  }
  return answer.get();
}

CheckStates::Response CheckServices::checkStates(const CheckStates::Request& request)
{
  return respond<CheckStates::Response>(
      [&](CheckStates::Response& response)
      {
        memory_.require();
        CheckJob job;
        const Snapshot now = store_.snapshot();
        const RobotModel& robot = *now.scene->robot;
        NamedRow rows{request.joint_names, request.positions};
        std::vector<int> set_by_request;
        const bool is_of_current_state =
            request.named_state.empty() && request.joint_names.empty() && request.positions.empty();
        if (is_of_current_state)
        {
          if (robot.variables().empty())
            throw Error(
                "the robot has no variables, so there is only one state; ~get_report tells whether it collides");
          job.columns = allColumns(robot);
          rows.values = fullStates(robot, {}, nullptr, 1, now.partialState());
        }
        if (!request.named_state.empty())
          rows = requestedNamedState(robot, {"named_state", request.named_state},
                                     request.joint_names.empty() && request.positions.empty());
        if (!is_of_current_state)
          set_by_request = job.columns = requestedColumns(
              robot, {"joint_names", rows.names}, {"positions", rows.values},
              [this](std::size_t count) { server_.requireStateCount(count); });
        job.states = std::move(rows.values);
        job.group = request.group;
        if (const auto outside =
                findValueOutsideLimits(robot, job.columns, job.states.data(), job.states.size() / job.columns.size()))
        {
          response.message = shortLine("state " + std::to_string(outside->row) + ": " + outside->text);
          static OccasionalWarning warning;
          warning.log("check_states: " + response.message);
        }
        job.matrix = requestedMatrix(request.allowed_collision_matrix, robot, store_.limits(), response.message);
        addWarning(now.assumedBase(set_by_request), response.message);
        job.keep_states = request.max_contacts != 0 || request.clearance;
        const bool inspects = job.keep_states;
        std::optional<Admission::Pass> pass;
        if (inspects)
          pass.emplace(inspections_);
        const CheckAnswer answer = answerOf(std::move(job));
        const BatchResult& result = answer.result;
        response.valid = result.valid;
        response.body_1.resize(result.valid.size());
        response.body_2.resize(result.valid.size());
        for (std::size_t i = 0; i < result.valid.size(); ++i)
        {
          if (result.valid[i])
            continue;
          response.body_1[i] = answer.scene->bodyName(result.colliding[i][0]);
          response.body_2[i] = answer.scene->bodyName(result.colliding[i][1]);
        }
        response.scene_revision = result.revision;
        response.seconds = result.seconds;
        if (inspects)
        {
          const auto start = std::chrono::steady_clock::now();
          inspect(request, answer, response);
          response.seconds += secondsSince(start);
        }
      });
}

/// A scene of its own needs an inspector of its own, which takes the trees of the newest inspector.
CheckStates::Response CheckServices::checkState(std::shared_ptr<const PlanningScene> scene,
                                                const std::vector<double>& state, const CheckStates::Request& request)
{
  return respond<CheckStates::Response>(
      [&](CheckStates::Response& response)
      {
        memory_.require();
        const Admission::Pass pass(inspections_);
        const std::shared_ptr<const StateInspector> previous = inspectorOf(store_.snapshot().scene);
        const StateInspector inspector(scene, previous.get());
        const auto max_contacts = std::clamp<std::size_t>(request.max_contacts, 1, options_.max_contacts);
        const std::vector<Contact> contacts =
            inspector.contacts(state.data(), request.group, max_contacts, request.max_contacts_per_pair);
        response.valid.push_back(contacts.empty() ? 1 : 0);
        response.body_1.push_back(contacts.empty() ? "" : scene->bodyName(contacts.front().bodies[0]));
        response.body_2.push_back(contacts.empty() ? "" : scene->bodyName(contacts.front().bodies[1]));
        if (request.max_contacts != 0)
          for (const Contact& contact : contacts)
            response.contacts.push_back(messageOf(contact, *scene, 0));
      });
}

void CheckServices::inspect(const CheckStates::Request& request, const CheckAnswer& answer,
                            CheckStates::Response& response)
{
  const std::vector<std::uint8_t>& valid = answer.result.valid;
  const auto colliding = static_cast<std::size_t>(std::count(valid.begin(), valid.end(), 0));
  const std::size_t inspected = request.clearance ? valid.size() : colliding;
  if (inspected > options_.max_inspected_states)
    throw Error("contacts or clearance requested for " + std::to_string(inspected) + " states; the limit is " +
                std::to_string(options_.max_inspected_states) +
                " (limits/inspected_states): send fewer states per request");
  if (inspected == 0)
    return;
  const std::shared_ptr<const StateInspector> inspector = inspectorOf(answer.scene);
  const std::size_t width = answer.scene->robot->variables().size();
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    if (stopping_)
      throw shuttingDown();
    const double* state = answer.states.data() + i * width;
    if (!valid[i] && request.max_contacts != 0)
    {
      // One contact above the limit shows that there are too many.
      const std::size_t max_contacts =
          std::min<std::size_t>(request.max_contacts, options_.max_contacts + 1 - response.contacts.size());
      for (const Contact& contact :
           inspector->contacts(state, request.group, max_contacts, request.max_contacts_per_pair))
        response.contacts.push_back(messageOf(contact, *answer.scene, i));
      if (response.contacts.size() > options_.max_contacts)
        throw Error("more than " + std::to_string(options_.max_contacts) +
                    " contacts (limits/contacts): request fewer per state (max_contacts), or send fewer states");
    }
  }
  constexpr std::size_t kStatesPerPart = 64;  // a part takes well below a second, so that the node can stop
  for (std::size_t i = 0; request.clearance && i < valid.size(); i += kStatesPerPart)
  {
    if (stopping_)
      throw shuttingDown();
    const std::size_t count = std::min(kStatesPerPart, valid.size() - i);
    for (const Clearance& clearance : inspector->clearances(answer.states.data() + i * width, count, request.group))
    {
      response.clearance_world.push_back(clearance.world);
      response.clearance_self.push_back(clearance.self);
    }
  }
}

/// The inspector is built without the lock, so that several can be built at the same time. The inspector of the newest
/// scene is kept.
std::shared_ptr<const StateInspector> CheckServices::inspectorOf(const std::shared_ptr<const PlanningScene>& scene)
{
  std::shared_ptr<const StateInspector> previous;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (inspected_ == scene)
      return inspector_;
    previous = inspector_;
  }
  auto inspector = std::make_shared<const StateInspector>(scene, previous.get());
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!inspected_ || inspected_->revision <= scene->revision)
  {
    inspected_ = scene;
    inspector_ = inspector;
  }
  return inspector;
}

CheckMotions::Response CheckServices::checkMotions(const CheckMotions::Request& request)
{
  return respond<CheckMotions::Response>(
      [&](CheckMotions::Response& response)
      {
        memory_.require();
        if (request.starts.size() != request.ends.size())
          throw Error(std::to_string(request.starts.size()) + " values in starts and " +
                      std::to_string(request.ends.size()) + " in ends; give one row of each per motion");
        const Snapshot now = store_.snapshot();
        const RobotModel& robot = *now.scene->robot;
        const auto require_count = [this](std::size_t count) { server_.requireStateCount(count); };
        CheckJob job;
        job.columns =
            requestedColumns(robot, {"joint_names", request.joint_names}, {"starts", request.starts}, require_count);
        requestedColumns(robot, {"joint_names", request.joint_names}, {"ends", request.ends}, require_count);
        requireWholeRotations(robot, job.columns);
        const PartialState current = now.partialState();
        const std::size_t count = request.starts.size() / job.columns.size();
        const std::vector<double> starts = fullStates(robot, job.columns, request.starts.data(), count, current);
        const std::vector<double> ends = fullStates(robot, job.columns, request.ends.data(), count, current);
        validateStates(robot, starts.data(), count);
        validateStates(robot, ends.data(), count);
        std::tie(job.motions, job.samples) =
            requestedMotions(request, robot, options_.motion_rule, starts, ends, options_);
        const MotionRule motion_rule = job.motions->rule;
        const std::string assumed_base = now.assumedBase(job.columns);
        // The full states above serve to count the samples. For the check, the variables that the request does not name
        // come from the checked snapshot, which may be newer than `now`.
        job.states = request.starts;
        job.states.insert(job.states.end(), request.ends.begin(), request.ends.end());
        job.group = request.group;
        std::string matrix_warning;
        job.matrix = requestedMatrix(request.allowed_collision_matrix, robot, store_.limits(), matrix_warning);
        const CheckAnswer answer = answerOf(std::move(job));
        for (const MotionVerdict& verdict : answer.motions)
        {
          response.valid.push_back(verdict.valid ? 1 : 0);
          response.last_valid_fraction.push_back(verdict.last_valid);
          response.first_invalid_fraction.push_back(verdict.first_invalid);
          response.given_up.push_back(verdict.given_up ? 1 : 0);
          const bool collides = verdict.colliding != kNoPair;
          response.body_1.push_back(collides ? answer.scene->bodyName(verdict.colliding[0]) : "");
          response.body_2.push_back(collides ? answer.scene->bodyName(verdict.colliding[1]) : "");
        }
        if (motion_rule == MotionRule::Bound)
        {
          response.message = beyondLimits(robot, starts);
          if (response.message.empty())
            response.message = beyondLimits(robot, ends);
        }
        addWarning(givenUp(answer.motions, options_.max_motion_checks), response.message);
        addWarning(matrix_warning, response.message);
        addWarning(assumed_base, response.message);
        response.states_checked = answer.states_checked;
        response.scene_revision = answer.result.revision;
        response.seconds = answer.result.seconds;
      });
}

GetReport::Response CheckServices::report(const GetReport::Request& request)
{
  return respond<GetReport::Response>(
      [&](GetReport::Response& response)
      {
        CheckJob job;
        job.group = request.group;
        job.report = true;
        const CheckAnswer answer = answerOf(std::move(job));
        fillReport(answer, response);
      });
}
}  // namespace gpu_planning_scene::core
