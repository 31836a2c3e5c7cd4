#include "collision/contacts/inspected_group.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "collision/contacts/separation_search.h"

// The exact checker finds the colliding pairs of instances. They are grouped by their bodies, because a contact
// separates whole bodies. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// If several contact points of a pair are within this distance of each other, only the deepest is reported.
constexpr double kSamePoint = 1e-6;  // metres

/// Finds points that are nearer to each other than kSamePoint. Two such points are in the same cell of a grid or in
/// adjacent cells.
class NearPoints
{
 public:
  /// Adds the point unless another point is near. Returns whether it was added.
  bool add(const Eigen::Vector3d& point)
  {
    const Cell center = {{cellOf(point.x()), cellOf(point.y()), cellOf(point.z())}};
    for (int i = 0; i < 27; ++i)
    {
      const auto found = cells_.find({{center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1}});
      if (found == cells_.end())
        continue;
      for (const Eigen::Vector3d& other : found->second)
        if ((other - point).norm() < kSamePoint)
          return false;
    }
    cells_[center].push_back(point);
    return true;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  /// Coordinates beyond a bound share one cell, because the resolution of double is coarser than kSamePoint there.
  static std::int64_t cellOf(double coordinate)
  {
    constexpr double kFarthest = 1e18;
    return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / kSamePoint), -kFarthest, kFarthest));
  }

  std::map<Cell, std::vector<Eigen::Vector3d>> cells_;
};

bool isDeeper(const Contact& a, const Contact& b)
{
  return a.depth > b.depth;
}

/// At most `most` contacts, the deepest first. Of contacts at the same place only the deepest is kept.
std::vector<Contact> deepest(std::vector<Contact> contacts, std::size_t most)
{
  std::stable_sort(contacts.begin(), contacts.end(), isDeeper);
  NearPoints points;
  std::vector<Contact> kept;
  for (const Contact& contact : contacts)
  {
    if (kept.size() == most)
      break;
    if (points.add(contact.point))
      kept.push_back(contact);
  }
  return kept;
}
}  // namespace

InspectionTrees::Prepared InspectionTrees::prepare(const PlanningScene& scene, const std::string& group)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  Prepared made;
  made.problem = std::make_shared<const CollisionProblem>(maker_.make(scene, group, nullptr));
  made.exact = forests_.exactCheckerOf(made.problem);
  made.forest = forests_.forest();
  made.objects = forests_.objects();
  return made;
}

InspectedGroup::InspectedGroup(const PlanningScene& scene, const std::string& group, InspectionTrees& trees)
  : prepared_(trees.prepare(scene, group)),
    convex_(trees.convexity(), prepared_.forest, problem().tessellations.size()),
    clearance_(prepared_.problem, prepared_.forest, prepared_.objects, convex_),
    pairs_(problem()),
    first_half_space_(static_cast<std::uint32_t>(problem().robot.size() + problem().world.size()))
{
  for (const ShapeInstance& instance : problem().robot)
    links_[instance.body] = instance.link;
}

int InspectedGroup::linkOf(std::int32_t body) const
{
  const auto known = links_.find(body);
  return known == links_.end() ? -1 : known->second;
}

std::vector<CollidingPair> InspectedGroup::collidingPairs(const std::vector<Eigen::Isometry3d>& link_poses,
                                                          std::size_t most) const
{
  ExactChecker::Scratch scratch;
  std::map<BodyPair, std::vector<InstancePair>> by_bodies;
  for (const InstancePair& pair : prepared_.exact->collidingInstances(link_poses.data(), scratch))
    by_bodies[bodiesOf(problem(), pair)].push_back(pair);
  std::vector<CollidingPair> found;
  for (const auto& [bodies, instances] : by_bodies)
    found.push_back({bodies, instances, contactsOfBodies(bodies, instances, link_poses, most)});
  return found;
}

/// The index counts the instances of the robot, then those of the world.
ContactShape InspectedGroup::shapeOf(std::size_t instance, const std::vector<Eigen::Isometry3d>& link_poses) const
{
  const bool is_robot = instance < problem().robot.size();
  const ShapeInstance& shape =
      is_robot ? problem().robot[instance] : problem().world[instance - problem().robot.size()];
  const Eigen::Isometry3d pose = is_robot ? placed(shape, link_poses.data()) : shape.pose;
  return {&prepared_.forest->tree(shape.tree), pose, convex_.isConvex(shape.tree)};
}

/// From the robot to the half-space.
ShapeContact InspectedGroup::contactOfHalfSpace(const InstancePair& pair,
                                                const std::vector<Eigen::Isometry3d>& link_poses) const
{
  const WorldHalfSpace& half_space = problem().half_spaces[pair[1] - first_half_space_];
  return contactWithHalfSpace(shapeOf(pair[0], link_poses), {half_space.normal, half_space.offset},
                              requiredDistance(problem(), pair));
}

std::vector<ShapeContact> InspectedGroup::contactsOfShapes(const BodyPair& bodies,
                                                           const std::vector<InstancePair>& colliding,
                                                           const std::vector<Eigen::Isometry3d>& link_poses,
                                                           std::size_t most) const
{
  const CpuShapePair exact(prepared_.forest);
  CpuShapePair::Scratch scratch;
  double reach = 0.0;  // the diagonal of the first body
  for (const InstancePair& pair : colliding)
    reach += 2.0 * prepared_.forest->tree(problem().robot[pair[0]].tree).half.norm();
  while (true)
  {
    std::vector<ContactPair> pairs;
    std::vector<std::size_t> numbers;
    pairs_.visit(problem(), bodies,
                 [&](const InstancePair& pair)
                 {
                   ContactPair found = {shapeOf(pair[0], link_poses), shapeOf(pair[1], link_poses),
                                        requiredDistance(problem(), pair)};
                   const double distance =
                       boundsOf(*found.a.tree, found.a.pose).exteriorDistance(boundsOf(*found.b.tree, found.b.pose));
                   if (distance > reach + found.required)
                     return;
                   if (bodyOf(problem(), pair[0]) != bodies[0])
                     std::swap(found.a, found.b);
                   if (std::find(colliding.begin(), colliding.end(), pair) != colliding.end())
                     numbers.push_back(pairs.size());
                   pairs.push_back(found);
                 });
    std::vector<ShapeContact> contacts = contactsOf(pairs, numbers, exact, scratch, most);
    // Shapes that were left out are farther away than the translation.
    if (contacts.front().depth < reach || std::isinf(reach))
      return contacts;
    reach = std::numeric_limits<double>::infinity();
  }
}

std::vector<Contact> InspectedGroup::contactsOfBodies(const BodyPair& bodies,
                                                      const std::vector<InstancePair>& colliding,
                                                      const std::vector<Eigen::Isometry3d>& link_poses,
                                                      std::size_t most) const
{
  std::vector<Contact> contacts;
  std::vector<InstancePair> shapes;
  std::copy_if(colliding.begin(), colliding.end(), std::back_inserter(shapes),
               [this](const InstancePair& pair) { return pair[1] < first_half_space_; });
  if (!shapes.empty())
    for (const ShapeContact& found : contactsOfShapes(bodies, shapes, link_poses, most))
      contacts.push_back({bodies, found.point, found.normal, found.depth});
  for (const InstancePair& pair : colliding)
  {
    if (pair[1] < first_half_space_)
      continue;
    const ShapeContact found = contactOfHalfSpace(pair, link_poses);
    const bool swapped = problem().robot[pair[0]].body != bodies[0];
    contacts.push_back({bodies, found.point, swapped ? Eigen::Vector3d(-found.normal) : found.normal, found.depth});
  }
  return deepest(std::move(contacts), most);
}

double InspectedGroup::leastDepth(const CollidingPair& pair, const std::vector<Eigen::Isometry3d>& link_poses) const
{
  double depth = 0.0;
  for (const InstancePair& instances : pair.instances)
  {
    if (instances[1] >= first_half_space_)
    {
      depth = std::max(depth, contactOfHalfSpace(instances, link_poses).depth - kSeparationGap);
      continue;
    }
    const ContactPair shapes = {shapeOf(instances[0], link_poses), shapeOf(instances[1], link_poses),
                                requiredDistance(problem(), instances)};
    depth = std::max(depth, leastDepthOf(shapes, pair.contacts.front().point));
  }
  return depth;
}
}  // namespace gpu_planning_scene::core
