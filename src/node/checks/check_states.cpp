#include <algorithm>
#include <chrono>
#include <numeric>

#include "base/seconds_since.h"
#include "base/text/number_text.h"
#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "model/joint_limits.h"
#include "node/checks/check_services.h"
#include "node/checks/requested_scene.h"
#include "node/endpoints/respond.h"
#include "node/endpoints/topic_warnings.h"
#include "node/messages/contact_messages.h"
#include "node/messages/pose_messages.h"
#include "node/messages/requested_states.h"
#include "service/service_errors.h"

// The service ~check_states, with contacts and clearance.
namespace gpu_planning_scene::core
{
namespace
{
/// The indices of all variables.
std::vector<int> allColumns(const RobotModel& robot)
{
  std::vector<int> columns(robot.variables().size());
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

bool hasDistances(const CheckStates::Request& request)
{
  return request.clearance || request.nearest || request.distances != CheckStates::Request::NO_DISTANCES;
}

void requireDistances(const CheckStates::Request& request)
{
  if (request.distances > CheckStates::Request::ALL_PAIRS)
    throw Error("distances is " + std::to_string(request.distances) +
                "; it must be NO_DISTANCES, NEAREST_OF_EACH_BODY or ALL_PAIRS");
  if (request.distances == CheckStates::Request::NO_DISTANCES && request.distance_range != 0.0)
    throw Error("distance_range is set, but distances is NO_DISTANCES: set distances, or leave both out");
  if (!(request.distance_range >= 0.0))
    throw Error("distance_range is " + numberText(request.distance_range) + " m; it must be at least 0");
}

DistanceQuery queryOf(const CheckStates::Request& request)
{
  DistanceQuery query;
  if (request.distance_range > 0.0)
    query.range = request.distance_range;
  query.nearest_of_each_body = request.distances == CheckStates::Request::NEAREST_OF_EACH_BODY;
  return query;
}
}  // namespace

CheckStates::Response CheckServices::checkStates(const CheckStates::Request& request)
{
  return respond<CheckStates::Response>(
      [&](CheckStates::Response& response)
      {
        memory_.require();
        CheckJob job;
        const std::optional<Snapshot> wanted = wantedScene(request.scene_revision);
        const RequestedScene scene =
            requestedScene(store_, others_.pose, request.scene_diff, request.allowed_collision_matrix, {}, wanted);
        const Snapshot& now = scene.now;
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
                                     !request.joint_names.empty() ? "joint_names"
                                     : !request.positions.empty() ? "positions"
                                                                  : nullptr);
        if (!is_of_current_state)
          set_by_request = job.columns = requestedColumns(
              robot, {"joint_names", rows.names}, {"positions", rows.values},
              [this](std::size_t count) { server_.requireStateCount(count); });
        job.states = std::move(rows.values);
        job.group = request.group;
        if (!is_of_current_state)
          requireVariableOfGroup(robot, request.group, job.columns);
        const std::size_t count = job.states.size() / job.columns.size();
        // The yaw of a current state may come from odometry, so it may be any number of turns.
        const auto find = is_of_current_state ? findValueOutsideLimits : findDoubtfulValue;
        if (const auto outside = find(robot, job.columns, job.states.data(), count))
          response.message = shortLine("state " + std::to_string(outside->row) + ": " + outside->text);
        else if (const std::string other = otherValueOutsideLimits(robot, job.columns, now.state.data());
                 !other.empty())
          response.message = shortLine("the current state: " + other);
        if (!response.message.empty())
        {
          static OccasionalWarning warning;
          warning.log("check_states: " + response.message);
        }
        addWarnings(scene.warnings, response.message);
        addWarning(now.assumedBase(scene.depends_on_state ? std::vector<int>() : set_by_request), response.message);
        job.matrix = scene.matrix;
        if (scene.is_changed || is_of_current_state || wanted)
          job.scene = scene.now;
        requireDistances(request);
        const std::vector<int> gradient_variables = request.joint_names.empty() ? allColumns(robot) : job.columns;
        job.keep_states = request.max_contacts != 0 || hasDistances(request);
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
          inspect(request, answer, gradient_variables, response);
          response.seconds += secondsSince(start);
        }
      });
}

void CheckServices::inspect(const CheckStates::Request& request, const CheckAnswer& answer,
                            const std::vector<int>& gradient_variables, CheckStates::Response& response)
{
  const std::vector<std::uint8_t>& valid = answer.result.valid;
  const auto colliding = static_cast<std::size_t>(std::count(valid.begin(), valid.end(), 0));
  const bool has_distances = hasDistances(request);
  const std::size_t inspected = has_distances ? valid.size() : colliding;
  if (inspected > options_.max_inspected_states)
    throw Error("contacts, clearance or distances requested for " + std::to_string(inspected) +
                " states; the limit is " + std::to_string(options_.max_inspected_states) +
                " (limits/inspected_states): send fewer states per request");
  if (inspected == 0)
    return;
  const std::shared_ptr<const StateInspector> inspector = inspectorOf(answer.scene);
  const std::size_t width = answer.scene->robot->variables().size();
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    if (stopping_)
      throw ShuttingDown();
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
  // The parts grow as long as they take well below a second, so that the node can stop.
  constexpr std::size_t kMostOfPart = 64;
  constexpr double kSecondsOfPart = 0.1;
  std::size_t part = 1;
  for (std::size_t i = 0; has_distances && i < valid.size();)
  {
    if (stopping_)
      throw ShuttingDown();
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t count = std::min(part, valid.size() - i);
    measure(request, answer, *inspector, {i, count}, gradient_variables, response);
    i += count;
    if (secondsSince(begin) < kSecondsOfPart)
      part = std::min(2 * part, kMostOfPart);
  }
  if (request.distances != CheckStates::Request::NO_DISTANCES)
    for (const int variable : gradient_variables)
      response.gradient_names.push_back(answer.scene->robot->variables()[static_cast<std::size_t>(variable)].name);
}

void CheckServices::measure(const CheckStates::Request& request, const CheckAnswer& answer,
                            const StateInspector& inspector, const StateRange& part,
                            const std::vector<int>& gradient_variables, CheckStates::Response& response) const
{
  const double* states = answer.states.data() + part.begin * answer.scene->robot->variables().size();
  if (request.clearance)
    for (const Clearance& clearance : inspector.clearances(states, part.count, request.group))
    {
      response.clearance_world.push_back(clearance.world);
      response.clearance_self.push_back(clearance.self);
    }
  if (request.nearest)
    for (const NearestPairs& pairs : inspector.nearestPairs(states, part.count, request.group))
    {
      response.nearest_world.push_back(messageOf(pairs.world, *answer.scene));
      response.nearest_self.push_back(messageOf(pairs.self, *answer.scene));
    }
  if (request.distances == CheckStates::Request::NO_DISTANCES)
    return;
  const BodyDistances distances = inspector.distances(states, part.count, request.group, queryOf(request));
  if (response.distances.size() + distances.pairs.size() > options_.max_contacts)
    throw Error("more than " + std::to_string(options_.max_contacts) +
                " distances (limits/contacts): request a shorter distance_range, the nearest pairs, or fewer states");
  for (std::size_t state = 0; state < part.count; ++state)
    for (std::size_t pair = distances.first[state]; pair < distances.first[state + 1]; ++pair)
      response.distances.push_back(messageOf(distances, pair, gradient_variables, *answer.scene, part.begin + state));
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
}  // namespace gpu_planning_scene::core
