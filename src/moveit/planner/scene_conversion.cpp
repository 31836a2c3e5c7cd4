#include "moveit/planner/scene_conversion.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "moveit/planner/converted_shapes.h"
#include "moveit/planner/refusal.h"

// Where MoveIt's rules and those of this package differ, the converted scene has MoveIt's rule. MoveIt checks attached
// objects against their own link, so carriers hold them. MoveIt scales bodies only for the check with the world, so a
// scaled body has a second body, and the matrix splits the pairs between the two.
namespace gpu_planning_scene::pipeline
{
namespace
{
using collision_detection::AllowedCollisionMatrix;
using collision_detection::AllowedCollision::ALWAYS;
using moveit::core::AttachedBody;
using moveit::core::LinkModel;

std::vector<const AttachedBody*> attachedBodies(const moveit::core::RobotState& state)
{
  std::vector<const AttachedBody*> bodies;
  state.getAttachedBodies(bodies);
  return bodies;
}

/// Whether MoveIt checks some object against the link that carries it.
std::set<std::string> linksWithCarrier(const moveit::core::RobotState& start)
{
  std::set<std::string> links;
  for (const AttachedBody* body : attachedBodies(start))
    if (!body->getAttachedLink()->getShapes().empty() && body->getTouchLinks().count(body->getAttachedLinkName()) == 0)
      links.insert(body->getAttachedLinkName());
  return links;
}

/// The links whose scale is not 1.
std::map<std::string, double> scalesOf(const planning_scene::PlanningScene& scene)
{
  std::map<std::string, double> scales;
  for (const auto& [link, scale] : scene.getCollisionEnv()->getLinkScale())
    if (scale != 1.0 && scene.getRobotModel()->hasLinkModel(link))
      scales[link] = scale;
  return scales;
}

/// The mimic joints that need a variable of their own. Throws Refusal if the group moves their leader: they would jump.
std::map<std::string, double> ownValues(const moveit::core::RobotState& start,
                                        const moveit::core::JointModelGroup& group)
{
  std::map<std::string, double> values = ownMimicValues(start);
  for (const auto& [name, value] : values)
  {
    const moveit::core::JointModel* leader = start.getRobotModel()->getJointModel(name)->getMimic();
    if (group.hasJointModel(leader->getName()))
      throw Refusal(MoveItErrorCodes::INVALID_ROBOT_STATE,
                    "the start: joint '" + name + "' is " + std::to_string(value) + ", but it mimics '" +
                        leader->getName() + "', which group '" + group.getName() +
                        "' moves; set it to the value that it gets from there");
  }
  return values;
}

/// The bodies of a converted scene, with the names by which MoveIt's matrix knows them.
class SceneBuilder
{
 public:
  SceneBuilder(const planning_scene::PlanningScene& from, const moveit::core::RobotState& start,
               const RobotConversion& robot)
    : from_(from), start_(start), robot_(robot), scene_(std::make_shared<core::PlanningScene>(robot.robot()))
  {
  }

  std::shared_ptr<const core::PlanningScene> build()
  {
    scene_->name = from_.getName();
    scene_->current_state = robot_.row(start_);
    for (const core::Link& link : scene_->robot->links())
      names_.insert(link.name);
    for (const LinkModel* link : from_.getRobotModel()->getLinkModels())
      addLink(*link);
    addPadding();
    for (const auto& [id, object] : *from_.getWorld())
      addObject(*object);
    for (const AttachedBody* body : attachedBodies(start_))
      addAttached(*body);
    addMatrix(from_.getAllowedCollisionMatrix());
    return scene_;
  }

 private:
  /// Which pairs of a body are checked.
  enum class Pairs
  {
    All,
    WithRobot,  ///< of a body whose scaled copy is checked with the world
    WithWorld   ///< of a scaled copy
  };
  struct Body
  {
    std::string moveit_name;
    std::string name;
    bool in_world;
    Pairs pairs;
  };

  /// MoveIt allows an object to have the name of a link or of an attached object; this package does not.
  const std::string& addBody(const std::string& moveit_name, bool in_world, Pairs pairs = Pairs::All)
  {
    std::string name = moveit_name;
    while (!names_.insert(name).second)
      name += in_world ? " (object)" : " (attached)";
    bodies_.push_back({moveit_name, name, in_world, pairs});
    return bodies_.back().name;
  }

  void addLink(const LinkModel& link)
  {
    if (link.getShapes().empty())
      return;
    const auto scaled = robot_.scaledLink(link);
    bodies_.push_back({link.getName(), link.getName(), false, scaled ? Pairs::WithRobot : Pairs::All});
    if (scaled)
      bodies_.push_back(
          {link.getName(), scene_->robot->links()[static_cast<std::size_t>(*scaled)].name, false, Pairs::WithWorld});
  }

  void addPadding()
  {
    const collision_detection::CollisionEnv& env = *from_.getCollisionEnv();
    scene_->link_padding.assign(scene_->robot->links().size(), 0.0);
    for (const auto& [name, padding] : env.getLinkPadding())
    {
      const LinkModel* link =
          from_.getRobotModel()->hasLinkModel(name) ? from_.getRobotModel()->getLinkModel(name) : nullptr;
      if (!link)
        continue;
      // As in the collision detector of this package, a negative padding counts as 0.
      const double used = padding < 0.0 ? 0.0 : padding;
      scene_->link_padding[RobotConversion::link(*link)] = used;
      scene_->link_padding[robot_.carrier(*link)] = used;
      if (const auto scaled = robot_.scaledLink(*link))
        scene_->link_padding[*scaled] = used;
    }
  }

  void addObject(const collision_detection::World::Object& from)
  {
    core::WorldObject object;
    object.id = addBody(from.id_, true);
    object.pose = from.pose_;
    for (std::size_t i = 0; i < from.shapes_.size(); ++i)
      addShapes(from.shapes_[i], from.shape_poses_[i], 1.0, Carried::No, from.id_, object.shapes);
    scene_->objects.push_back(std::move(object));
  }

  void addAttached(const AttachedBody& from)
  {
    const auto scale = robot_.needs().scales.find(from.getAttachedLinkName());
    if (scale == robot_.needs().scales.end())
      return addAttached(from, 1.0, Pairs::All);
    addAttached(from, 1.0, Pairs::WithRobot);
    addAttached(from, scale->second, Pairs::WithWorld);
  }

  void addAttached(const AttachedBody& from, double scale, Pairs pairs)
  {
    core::AttachedObject attached;
    attached.object.id = addBody(from.getName(), false, pairs);
    attached.object.pose = from.getPose();
    attached.link = robot_.carrier(*from.getAttachedLink());
    for (std::size_t i = 0; i < from.getShapes().size(); ++i)
      addShapes(from.getShapes()[i], from.getShapePoses()[i], scale, Carried::Yes, from.getName(),
                attached.object.shapes);
    for (const std::string& link : from.getTouchLinks())
      if (const int index = scene_->robot->linkIndex(link); index >= 0)
        attached.touch_links.push_back(index);
    scene_->attached.push_back(std::move(attached));
  }

  /// The rules for entries and defaults are the same in MoveIt and here.
  void addMatrix(const AllowedCollisionMatrix& matrix)
  {
    core::AllowedCollisionMatrix& converted = scene_->allowed_collisions;
    converted = core::AllowedCollisionMatrix();
    scene_->matrix_source = core::MatrixSource::SceneFile;
    std::vector<const Body*> listed;
    for (const Body& body : bodies_)
    {
      collision_detection::AllowedCollision::Type type;
      if (matrix.getDefaultEntry(body.moveit_name, type))
        converted.setDefault(body.name, type == ALWAYS);
      if (!matrix.hasEntry(body.moveit_name))
        continue;
      for (const Body* other : listed)
        if (!(body.in_world && other->in_world) && matrix.getEntry(body.moveit_name, other->moveit_name, type))
          converted.setEntry(body.name, other->name, type == ALWAYS);
      listed.push_back(&body);
    }
    for (const Body& body : bodies_)
      for (const Body& other : bodies_)
        if (body.pairs != Pairs::All && &body != &other &&
            body.pairs != (other.in_world ? Pairs::WithWorld : Pairs::WithRobot))
          converted.setEntry(body.name, other.name, true);
  }

  const planning_scene::PlanningScene& from_;
  const moveit::core::RobotState& start_;
  const RobotConversion& robot_;
  std::shared_ptr<core::PlanningScene> scene_;
  std::set<std::string> names_;  // of the converted bodies
  std::vector<Body> bodies_;     // whose pairs the matrix decides
};
}  // namespace

std::shared_ptr<const RobotConversion> SceneConverter::robotFor(const moveit::core::RobotModelConstPtr& model,
                                                                const RobotNeeds& needs)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_ || !newest_->serves(model, needs))
    newest_ = std::make_shared<const RobotConversion>(model, needs);
  return newest_;
}

ConvertedScene SceneConverter::convert(const planning_scene::PlanningScene& scene,
                                       const moveit::core::RobotState& start,
                                       const moveit::core::JointModelGroup& group,
                                       const std::optional<Eigen::AlignedBox3d>& workspace)
{
  if (scene.getStateFeasibilityPredicate() || scene.getMotionFeasibilityPredicate())
    throw Refusal(MoveItErrorCodes::COLLISION_CHECKING_UNAVAILABLE,
                  "the scene has a feasibility predicate, which is not planned with; remove it");
  ConvertedScene converted;
  converted.robot =
      robotFor(scene.getRobotModel(), {ownValues(start, group), linksWithCarrier(start), scalesOf(scene), workspace});
  converted.scene = SceneBuilder(scene, start, *converted.robot).build();
  return converted;
}
}  // namespace gpu_planning_scene::pipeline
