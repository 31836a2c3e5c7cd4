#include "moveit/queries/continuous_check.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collision/bounds/displacement_rounding.h"
#include "moveit/pairs/workspace.h"
#include "moveit/queries/collision_query.h"
#include "moveit/queries/motion_bound.h"
#include "moveit/shapes/log.h"

// Bisection: in the middle of an interval of the motion, the distance of a shape instance of the robot from all objects
// is compared with the bound of its displacement within half of the interval. If the distance is larger, the instance
// is free in the interval (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"). The other shape
// instances are checked again in both halves.
// MotionBatch (collision/motion) cannot serve here: it interpolates as this package does, and a StateChecker tells it
// only whether a state is free. MoveIt's interpolation differs, for example for planar joints that are not holonomic.
// Each call has a matrix and deciders of its own, and needs the contacts of the first collision.
namespace gpu_planning_scene::detector
{
namespace
{
using moveit::core::RobotState;

// An interval in which a shape instance moves by less is not divided further.
constexpr double kFinest = 1e-4;  // metres

bool samePoses(const EigenSTL::vector_Isometry3d& a, const EigenSTL::vector_Isometry3d& b)
{
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const Eigen::Isometry3d& x, const Eigen::Isometry3d& y) { return x.matrix() == y.matrix(); });
}

/// Whether each object has the same link, shapes and poses in both states, which carry objects of the same names. A
/// copied shape counts as another one.
bool carryTheSame(const RobotState& a, const RobotState& b)
{
  std::vector<const moveit::core::AttachedBody*> bodies;
  a.getAttachedBodies(bodies);
  return std::all_of(bodies.begin(), bodies.end(),
                     [&b](const moveit::core::AttachedBody* body)
                     {
                       const moveit::core::AttachedBody& other = *b.getAttachedBody(body->getName());
                       return body->getAttachedLinkName() == other.getAttachedLinkName() &&
                              body->getShapes() == other.getShapes() &&
                              body->getPose().matrix() == other.getPose().matrix() &&
                              samePoses(body->getShapePoses(), other.getShapePoses());
                     });
}

class MotionSearch
{
 public:
  MotionSearch(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
               const RobotState& from, const RobotState& to, const RobotGeometry& robot, const WorldGeometry& world,
               const PairFilter& filter, const std::set<const moveit::core::LinkModel*>* active)
    : request_(request),
      result_(result),
      from_(from),
      to_(to),
      robot_(robot),
      world_(world),
      filter_(filter),
      active_(active),
      state_(from)
  {
  }

  void run()
  {
    // The given states come first: interpolation sets mimic joints, which may have other values in them.
    if (!stateIsFree(from_, 0.0) || !stateIsFree(to_, 1.0))
      return;
    if (attachedNames(from_) != attachedNames(to_))
    {
      ROS_ERROR_NAMED(kLogName, "The two states of a motion carry different objects; the motion counts as a collision");
      result_.collision = true;
      return;
    }
    if (proveCarrying(from_) && !carryTheSame(from_, to_))
      proveCarrying(to_);
  }

 private:
  void place(double time)
  {
    from_.interpolate(to_, time, state_);
    state_.update();
    place(state_);
  }

  void place(const RobotState& state)
  {
    work_->instances.clear();
    work_->attached.clear();
    robot_.place(state, active_, work_->instances, work_->attached);
  }

  /// Proves the motion of the robot with the objects that a state carries, or sets the result to a collision and
  /// returns false.
  bool proveCarrying(const RobotState& carrying)
  {
    state_ = carrying;
    place(0.0);
    bounds_ = displacementBounds(from_, to_, state_, work_->instances);
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < work_->instances.size(); ++i)
      all.push_back(i);
    return sampleIsFree(0.0) && sampleIsFree(1.0) && prove(0.0, 1.0, all);
  }

  static std::set<std::string> attachedNames(const RobotState& state)
  {
    std::vector<const moveit::core::AttachedBody*> bodies;
    state.getAttachedBodies(bodies);
    std::set<std::string> names;
    for (const moveit::core::AttachedBody* body : bodies)
      names.insert(body->getName());
    return names;
  }

  bool sampleIsFree(double time)
  {
    place(time);
    return instancesAreFree(time);
  }

  bool stateIsFree(const RobotState& state, double time)
  {
    place(state);
    return instancesAreFree(time);
  }

  /// Checks the placed shape instances. If they collide, their contacts go into the result.
  bool instancesAreFree(double time)
  {
    collision_detection::CollisionResult found;
    CollisionQuery query(request_, found, filter_, work_->pair);
    for (const ShapeInstance& instance : work_->instances)
      if (world_.visitNear(instance.bounds, work_->nodes,
                           [&](const ShapeInstance& object) { return query.test(instance, object); }))
        break;
    if (found.collision)
      add(found, time);
    return !found.collision;
  }

  void add(const collision_detection::CollisionResult& found, double time)
  {
    result_.collision = true;
    result_.cost_sources.insert(found.cost_sources.begin(), found.cost_sources.end());
    for (const auto& [pair, contacts] : found.contacts)
    {
      for (collision_detection::Contact contact : contacts)
      {
        if (result_.contact_count >= request_.max_contacts)
          return;
        contact.percent_interpolation = time;
        result_.contacts[pair].push_back(contact);
        ++result_.contact_count;
      }
    }
  }

  /// Proves the interval for some shape instances, or sets the result to a collision and returns false.
  bool prove(double begin, double end, const std::vector<std::size_t>& instances)
  {
    const double middle = 0.5 * (begin + end);
    const double half = 0.5 * (end - begin);
    place(middle);
    std::vector<std::size_t> open;
    bool is_finest = false;
    for (const std::size_t number : instances)
    {
      const double travel = half * bounds_[number];
      if (isProven(work_->instances[number], travel))
        continue;
      open.push_back(number);
      is_finest = is_finest || !std::isfinite(travel) || travel <= kFinest;
    }
    if (open.empty())
      return true;
    if (!sampleIsFree(middle))
      return false;
    if (is_finest || middle <= begin || middle >= end)
    {
      addUnproven(middle);
      return false;
    }
    return prove(begin, middle, open) && prove(middle, end, open);
  }

  /// Whether a shape instance keeps a distance of more than `travel` from all objects with which it may not collide.
  bool isProven(const ShapeInstance& instance, double travel)
  {
    if (travel == 0.0)
      return true;  // the shape instance stays where sampleIsFree has checked it
    const double margin = core::withRounding(travel);
    if (!(margin <= core::kLargestLength) || instance.shape->kind() == ShapeKind::Faulty)
      return world_.empty();
    Eigen::AlignedBox3d bounds(instance.bounds.min().array() - margin, instance.bounds.max().array() + margin);
    const bool is_near = world_.visitNear(
        bounds, work_->nodes,
        [&](const ShapeInstance& object)
        {
          if (filter_.rule(instance.body, object.body) == PairFilter::Rule::Skip ||
              !collide(instance, object, work_->pair, margin))
            return false;
          near_ = {*instance.body.name, instance.body.type, *object.body.name, instance.bounds.center()};
          return true;
        });
    return !is_near;
  }

  void addUnproven(double time)
  {
    result_.collision = true;
    if (request_.verbose)
      ROS_INFO_STREAM_NAMED(kLogName, "The motion of '" << near_.body << "' past '" << near_.object << "' at "
                                                        << 100.0 * time << " % of the motion is not proven free");
    if (!request_.contacts || result_.contact_count >= request_.max_contacts)
      return;
    collision_detection::Contact contact;
    contact.pos = near_.place;
    contact.normal = Eigen::Vector3d::UnitZ();
    contact.depth = 0.0;
    contact.body_name_1 = near_.body;
    contact.body_type_1 = near_.type;
    contact.body_name_2 = near_.object;
    contact.body_type_2 = collision_detection::BodyTypes::WORLD_OBJECT;
    contact.percent_interpolation = time;
    contact.nearest_points[0] = contact.nearest_points[1] = contact.pos;
    if (near_.object < near_.body)
    {
      std::swap(contact.body_name_1, contact.body_name_2);
      std::swap(contact.body_type_1, contact.body_type_2);
    }
    result_.contacts[std::minmax(near_.body, near_.object)].push_back(contact);
    ++result_.contact_count;
  }

  struct Near
  {
    std::string body;
    collision_detection::BodyType type;
    std::string object;
    Eigen::Vector3d place;
  };

  const collision_detection::CollisionRequest& request_;
  collision_detection::CollisionResult& result_;
  const RobotState& from_;
  const RobotState& to_;
  const RobotGeometry& robot_;
  const WorldGeometry& world_;
  const PairFilter& filter_;
  const std::set<const moveit::core::LinkModel*>* active_;
  RobotState state_;
  Workspace work_;
  std::vector<double> bounds_;
  Near near_{"", collision_detection::BodyTypes::ROBOT_LINK, "", Eigen::Vector3d::Zero()};
};
}  // namespace

void checkMotion(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                 const RobotState& from, const RobotState& to, const RobotGeometry& robot, const WorldGeometry& world,
                 const PairFilter& filter, const std::set<const moveit::core::LinkModel*>* active)
{
  static LogLimit limit;
  if (request.distance && limit.allows())
    ROS_WARN_NAMED(kLogName, "The distance along a motion is not computed; it stays as it was");
  if (!world.empty())
    MotionSearch(request, result, from, to, robot, world, filter, active).run();
}
}  // namespace gpu_planning_scene::detector
