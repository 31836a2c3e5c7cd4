#include "support/fcl_agreement.h"

#include <ostream>

#include "collision/bounds/problem_maker.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kMicrometre = 1e-6;

std::string describe(const PlanningScene& scene, std::size_t state, const BodyPair& pair, const std::string& what)
{
  return "state " + std::to_string(state) + ", " + scene.bodyName(pair[0]) + " and " + scene.bodyName(pair[1]) + ": " +
         what;
}

/// Judges a state that the checker finds free and FCL finds in collision.
void judgeFree(const PlanningScene& scene, const FclPeer& peer, std::size_t state, FclAgreement& agreement)
{
  for (const auto& pair : peer.allCollisions())
  {
    if (!peer.freeWhenMovedApart(pair))
    {
      agreement.failures.push_back(describe(scene, state, pair, "called free, FCL hits"));
      return;
    }
  }
  ++agreement.barely_touching;
}

/// Judges a state that the checker finds in collision by `pair`, while FCL finds `pair` free.
void judgeHit(const PlanningScene& scene, const FclPeer& peer, std::size_t state, const BodyPair& pair,
              FclAgreement& agreement)
{
  if (peer.within(pair, kMicrometre))
    ++agreement.within_micrometre;
  else if (peer.oneInsideTheOther(pair))
    ++agreement.contained;
  else
    agreement.failures.push_back(describe(scene, state, pair, "called colliding, free by FCL"));
}
}  // namespace

FclAgreement compareWithFcl(FclPeer& peer, const PlanningScene& scene, const std::vector<double>& states,
                            const BatchResult& result)
{
  const RobotModel& robot = *scene.robot;
  const auto first_object = static_cast<std::int32_t>(robot.links().size());
  const auto first_attached = first_object + static_cast<std::int32_t>(scene.objects.size());
  FclAgreement agreement;
  agreement.states = result.valid.size();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  for (std::size_t i = 0; i < agreement.states; ++i)
  {
    robot.linkPoses(states.data() + i * robot.variables().size(), poses.data());
    peer.setState(poses.data());
    const auto hit = peer.firstCollision();
    agreement.free += hit ? 0 : 1;
    agreement.world_hits += hit && (*hit)[1] >= first_object && (*hit)[1] < first_attached ? 1 : 0;
    if (result.valid[i] != 0)
      hit ? judgeFree(scene, peer, i, agreement) : void(++agreement.agreed);
    else if (hit && peer.collides(result.colliding[i]))
      ++agreement.agreed;
    else
      judgeHit(scene, peer, i, result.colliding[i], agreement);
  }
  return agreement;
}

FclAgreement compareWithFcl(const PlanningScene& scene, const std::vector<double>& states, const BatchResult& result)
{
  FclPeer peer(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr)));
  return compareWithFcl(peer, scene, states, result);
}

std::ostream& operator<<(std::ostream& out, const FclAgreement& agreement)
{
  out << agreement.states << " states, by FCL " << agreement.free << " free and " << agreement.world_hits
      << " hitting the world; " << agreement.agreed << " agreed, " << agreement.barely_touching
      << " free that barely touch by FCL, " << agreement.within_micrometre << " hits within a micrometre by FCL, "
      << agreement.contained << " hits by containment, " << agreement.failures.size() << " failures";
  for (const std::string& failure : agreement.failures)
    out << "\n  " << failure;
  return out;
}
}  // namespace gpu_planning_scene::core
