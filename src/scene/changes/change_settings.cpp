#include <algorithm>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "scene/changes/matrix_entries.h"
#include "scene/changes/newly_allowed.h"
#include "scene/changes/scene_changer.h"

// Names, fixed frames, the allowed collision matrix, padding, scale, colours.
namespace gpu_planning_scene::core
{
void SceneChanger::changeNames(const SceneChange& change)
{
  PlanningScene& scene = result_.scene;
  if (!change.robot_model_name.empty() && change.robot_model_name != scene.robot->name())
    throw Error("the scene is for robot '" + change.robot_model_name + "', the robot here is '" + scene.robot->name() +
                "'; correct robot_model_name, or leave it empty");
  if (!change.name.empty())
    count_.requireName(change.name, "scene");
  if (!change.is_diff || !change.name.empty())
    scene.name = change.name;
}

/// MoveIt lists the planning frame among the fixed frames. It is accepted but not stored.
void SceneChanger::changeFixedFrames(const SceneChange& change)
{
  PlanningScene& scene = result_.scene;
  if (change.is_diff && change.fixed_frames.empty())
    return;
  scene.fixed_frames.clear();
  for (const auto& [name, pose] : change.fixed_frames)
  {
    const std::string where = "fixed frame '" + name + "'";
    count_.requireName(name, "fixed frame");
    requirePose(pose, where);
    const bool is_planning_frame = name == scene.robot->planningFrame();
    if (is_planning_frame && !pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12))
      throw Error(where + " is the planning frame; its transform must be the identity");
    if (!is_planning_frame && scene.robot->linkIndex(name) >= 0)
      throw Error(where + " has the name of a link; give it another name");
    if (!is_planning_frame)
      scene.fixed_frames[name] = pose;
  }
}

void SceneChanger::changeMatrix(const SceneChange& change)
{
  PlanningScene& scene = result_.scene;
  if (change.matrix)
  {
    count_.requireMatrix(*change.matrix);
    scene.allowed_collisions = *change.matrix;
    scene.matrix_source = MatrixSource::SceneFile;
    for (std::string& warning : warningsOfMatrix(*scene.robot, scene.allowed_collisions))
      result_.warnings.push_back(std::move(warning));
  }
  else if (!change.is_diff)
  {
    const PlanningScene fresh(scene.robot);
    scene.allowed_collisions = fresh.allowed_collisions;
    scene.matrix_source = fresh.matrix_source;
  }
  keeps_matrix_ = true;
}

/// Warns of a full scene without a matrix if fewer pairs are checked than with the matrix of the previous scene. A
/// scene with a matrix gives no warning.
void SceneChanger::warnOfMatrixReset(const SceneChange& change, const AllowedCollisionMatrix& before)
{
  if (change.is_diff || change.matrix)
    return;
  const NewlyAllowed found = findNewlyAllowed(result_.scene, before);
  if (found.pairs == 0)
    return;
  const std::string pair = "'" + found.body_1 + "' and '" + found.body_2 + "'";
  result_.warnings.push_back(
      (found.pairs == 1 ? pair + " are no longer checked against each other"
                        : std::to_string(found.pairs) + " pairs of bodies are no longer checked, for example " + pair) +
      ": the scene is not a diff and has no allowed_collision_matrix, so the robot's own matrix applies again");
}

/// Warns of links that become smaller because a full scene does not name them. Then fewer states collide.
void SceneChanger::warnOfReset(const char* what, const std::vector<double>& before, const std::vector<double>& after,
                               const std::map<std::string, double>& named)
{
  for (std::size_t link = 0; link < std::min(before.size(), after.size()); ++link)
    if (const std::string& name = result_.scene.robot->links()[link].name;
        after[link] < before[link] && named.count(name) == 0)
      result_.warnings.push_back("the " + std::string(what) + " of link '" + name + "' is " +
                                 std::to_string(after[link]) + " again instead of " + std::to_string(before[link]) +
                                 ", because the scene is not a diff and does not name it");
}

void SceneChanger::changePadding(const SceneChange& change)
{
  std::vector<double> padding = change.is_diff ? result_.scene.link_padding : defaults_.link_padding;
  padding.resize(result_.scene.robot->links().size(), 0.0);
  for (const auto& [link, metres] : change.link_padding)
  {
    if (!(metres >= 0.0) || metres > kLargestLength)
      throw Error("link '" + link + "': the padding is " + std::to_string(metres) +
                  "; it must not be negative, nor above 1000 km");
    padding[static_cast<std::size_t>(linkIndex(link, "link_padding"))] = metres;
  }
  warnOfReset("padding", result_.scene.link_padding, padding, change.link_padding);
  const bool is_padded = std::any_of(padding.begin(), padding.end(), [](double metres) { return metres != 0.0; });
  result_.scene.link_padding = is_padded ? padding : std::vector<double>();
}

void SceneChanger::changeScale(const SceneChange& change)
{
  std::vector<double> scale = change.is_diff ? result_.scene.robot->linkScale() : defaults_.link_scale;
  scale.resize(result_.scene.robot->links().size(), 1.0);
  for (const auto& [link, factor] : change.link_scale)
    scale[static_cast<std::size_t>(linkIndex(link, "link_scale"))] = factor;
  warnOfReset("scale", result_.scene.robot->linkScale(), scale, change.link_scale);
  result_.scene.setLinkScale(scale);
}

void SceneChanger::changeColors(const SceneChange& change)
{
  if (!change.is_diff)
    result_.scene.colors.clear();
  for (const auto& [id, color] : change.colors)
  {
    count_.requireName(id, "object color");
    for (const float part : {color.r, color.g, color.b, color.a})
      if (!(part >= 0.0F && part <= 1.0F))
        throw Error("the color of '" + id + "' has a component of " + std::to_string(part) +
                    "; each must be from 0 to 1");
    result_.scene.colors[id] = color;
  }
}
}  // namespace gpu_planning_scene::core
