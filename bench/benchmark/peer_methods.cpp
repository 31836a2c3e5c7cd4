#include <atomic>
#include <thread>

#include "benchmark/pairwise_peer.h"
#include "collision/bounds/problem_maker.h"
#include "support/fcl_peer.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
/// Runs a peer on all cores, with one copy per thread. Each thread takes chunks of states until no state is left. Few
/// states stay on the calling thread.
class OnAllCores : public Method
{
 public:
  OnAllCores(std::shared_ptr<const RobotModel> robot, std::unique_ptr<Peer> peer) : robot_(std::move(robot))
  {
    peers_.push_back(std::move(peer));
    for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      peers_.push_back(peers_.front()->copy());
  }

  std::vector<std::uint8_t> check(const double* states, std::size_t count) override
  {
    std::vector<std::uint8_t> valid(count);
    std::atomic<std::size_t> next{0};
    const auto work = [&](Peer& peer)
    {
      std::vector<Eigen::Isometry3d> poses(robot_->links().size());
      for (std::size_t begin = next.fetch_add(kChunk); begin < count; begin = next.fetch_add(kChunk))
        for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i)
        {
          robot_->linkPoses(states + i * robot_->variables().size(), poses.data());
          valid[i] = peer.collides(poses.data()) ? 0 : 1;
        }
    };
    std::vector<std::thread> helpers;
    for (std::size_t i = 1; i < peers_.size() && i * kChunk < count; ++i)
      helpers.emplace_back(work, std::ref(*peers_[i]));
    work(*peers_.front());
    for (std::thread& helper : helpers)
      helper.join();
    return valid;
  }

 private:
  static constexpr std::size_t kChunk = 16;
  std::shared_ptr<const RobotModel> robot_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

class Fcl : public Peer
{
 public:
  Fcl(const std::shared_ptr<const CollisionProblem>& problem, FclTree tree, FclOrder order)
    : peer_(problem, tree, order)
  {
  }
  bool collides(const Eigen::Isometry3d* link_poses) override
  {
    peer_.setState(link_poses);
    return peer_.firstCollision().has_value();
  }
  std::unique_ptr<Peer> copy() const override { return std::make_unique<Fcl>(*this); }

 private:
  FclPeer peer_;
};

struct FclKind
{
  const char* name;
  const char* title;
  FclTree tree;
  bool paddable;
};
constexpr const char* kOrderedTitle = "FCL OBBRSS, learned order, broad phase";
constexpr std::array<FclKind, 5> kFclKinds = {{{"fcl_obbrss", "FCL, OBBRSS", FclTree::Obbrss, true},
                                               {"fcl_obb", "FCL, OBB", FclTree::Obb, false},
                                               {"fcl_kios", "FCL, kIOS", FclTree::Kios, true},
                                               {"fcl_aabb", "FCL, AABB", FclTree::Aabb, false},
                                               {"fcl_kdop24", "FCL, 24-DOP", FclTree::Kdop24, false}}};

PeerMaker fclMaker(FclTree tree, FclOrder order = FclOrder::Fixed)
{
  return [tree, order](const auto& problem) { return std::make_unique<Fcl>(problem, tree, order); };
}

using RobotPeerMaker =
    std::function<std::unique_ptr<Peer>(const std::shared_ptr<const CollisionProblem>&, const RobotModel&)>;

MethodInfo peerMethod(const std::string& name, const std::string& title, const std::string& family,
                      const RobotPeerMaker& make)
{
  MethodInfo info;
  info.name = name;
  info.title = title;
  info.family = family;
  info.make = [make](const auto& scene, const MethodOptions&)
  {
    const auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr));
    return std::make_unique<OnAllCores>(scene->robot, make(problem, *scene->robot));
  };
  return info;
}

std::unique_ptr<Peer> withDisabledPairs(std::unique_ptr<PairwisePeer> peer, const RobotModel& robot)
{
  peer->disableDefaultPairs(robot);
  return peer;
}
}  // namespace

std::vector<std::pair<std::string, PeerMaker>> meshPeers()
{
  std::vector<std::pair<std::string, PeerMaker>> peers;
  for (const FclKind& kind : kFclKinds)
    peers.emplace_back(kind.name, fclMaker(kind.tree));
  return peers;
}

std::vector<MethodInfo> peerMethods()
{
  std::vector<MethodInfo> methods;
  for (const FclKind& kind : kFclKinds)
  {
    methods.push_back(peerMethod(kind.name, kind.title, "FCL",
                                 [make = fclMaker(kind.tree)](const auto& problem, const RobotModel&)
                                 { return make(problem); }));
    methods.back().paddable = kind.paddable;
    methods.back().responsive = kind.tree == FclTree::Obbrss;
  }
  methods.insert(methods.begin() + 1,
                 peerMethod(kOrderedMethod, kOrderedTitle, "FCL",
                            [make = fclMaker(FclTree::Obbrss, FclOrder::Learned)](
                                const auto& problem, const RobotModel&) { return make(problem); }));
  methods[1].responsive = true;
  methods.push_back(peerMethod("bullet_hulls", "Bullet, hulls", "Bullet",
                               [](const auto& problem, const RobotModel& robot)
                               { return withDisabledPairs(makeBulletHulls(problem), robot); }));
  for (const std::size_t count : {4, 16, 64})
    methods.push_back(peerMethod("spheres_" + std::to_string(count), std::to_string(count) + " spheres a link",
                                 "spheres",
                                 [count](const auto& problem, const RobotModel& robot)
                                 { return withDisabledPairs(makeSpheres(problem, count), robot); }));
  return methods;
}

std::vector<MethodInfo> allMethods()
{
  std::vector<MethodInfo> methods = ourMethods();
  for (const auto& others : {peerMethods(), literatureMethods(), vampMethods()})
    methods.insert(methods.end(), others.begin(), others.end());
  return methods;
}
}  // namespace gpu_planning_scene::core::benchmark
