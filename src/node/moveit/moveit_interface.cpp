#include "node/moveit/moveit_interface.h"

#include <optional>

#include "node/moveit/followed_scene.h"
#include "node/moveit/layouts.h"
#include "node/moveit/moveit_names.h"
#include "node/moveit/moveit_options.h"
#include "node/moveit/state_validity.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kValidityThreads = 16;
}  // namespace

struct MoveItInterface::Impl
{
  explicit Impl(const Node& node)
    : options((requireMoveItLayouts(), moveItOptionsFromParameters(node.node, node.own))),
      look_up([&lookup = node.lookup](const StampedFrame& frame) { return lookup(frame, lookup.deadline()); }),
      validity(node.store, node.changes, node.checks, node.options.max_contacts),
      kinematics(node.store, node.kinematics),
      requests(node.node, node.own, kValidityThreads, node.diagnostics,
               [this, require_scene_of_node = node.require_scene]
               {
                 require_scene_of_node();
                 requireScene();
               })
  {
    if (!options.monitor.node.empty())
    {
      followed.emplace(node.node, node.own, options.monitor, node.store, node.changes, look_up);
      node.diagnostics.watchScene([this] { return followed->fault(); });
    }
    if (options.names)
      names.emplace(node.node, node.store, node.changes, node.clear_octomap, validity, kinematics, node.lookup,
                    node.diagnostics, node.options.max_waiting_changes, node.options.message_size);
    requests.advertise<MoveItStateValidity>(
        "check_state_validity", [this](const MoveItStateValidity::Request& r) { return validity.answer(r.ours); });
  }

  void requireScene() const
  {
    if (followed)
      followed->requireScene();
  }

  const MoveItOptions options;
  const SceneStore::Lookup look_up;
  const StateValidity validity;
  const MoveItKinematics kinematics;
  std::optional<FollowedScene> followed;
  std::optional<MoveItNames> names;
  Endpoints requests;
};

MoveItInterface::MoveItInterface(const Node& node) : impl_(std::make_unique<Impl>(node)) {}

MoveItInterface::~MoveItInterface() = default;

void MoveItInterface::requireScene() const
{
  impl_->requireScene();
}

std::string MoveItInterface::changeFault() const
{
  const std::string& monitor = impl_->options.monitor.node;
  return monitor.empty() ? "" : "the node follows the scene of " + monitor + " (~monitor); change the scene there";
}

void MoveItInterface::close()
{
  impl_->requests.close();
  if (impl_->names)
    impl_->names->close();
}

void MoveItInterface::stop()
{
  if (impl_->followed)
    impl_->followed->stop();
  impl_->requests.stop();
  if (impl_->names)
    impl_->names->stop();
}

bool MoveItInterface::refuseWaiting()
{
  const bool has_answered = impl_->requests.refuseWaiting();
  return (impl_->names && impl_->names->refuseWaiting()) || has_answered;
}
}  // namespace gpu_planning_scene::core
