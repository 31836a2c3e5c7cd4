// contacts: whether contacts keep the promises of ContactInformation.msg for each pair of kinds of bodies; see --help.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <mutex>

#include "base/parallel_for.h"
#include "base/seconds_since.h"
#include "collision/contacts/colliding_shapes.h"
#include "collision/contacts/held_shape.h"
#include "command_line/command_line.h"

using namespace gpu_planning_scene::core;

namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOnBody = 1e-6;  // metres: see ContactInformation.msg
constexpr std::size_t kPosesOfScene = 100;
constexpr std::size_t kMostPoints = 20;

/// A kind of objects in the world.
struct ObjectKind
{
  std::string name;
  std::function<std::vector<PlacedShape>(Random&)> make;
};

/// Cells of 5 cm, as an octomap has them.
std::vector<PlacedShape> cells(Random& random)
{
  std::vector<PlacedShape> shapes;
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -1; z <= 1; ++z)
        if (between(random, 0.0, 1.0) < 0.3)
          shapes.push_back({Box{{0.05, 0.05, 0.05}}, at(0.05 * x, 0.05 * y, 0.05 * z)});
  shapes.push_back({Box{{0.05, 0.05, 0.05}}, at(0.0, 0.0, 0.1)});
  return shapes;
}

/// The kinds of kinds() from number `first`, and the kinds that only an object can have.
std::vector<ObjectKind> objectKinds(std::size_t first)
{
  std::vector<ObjectKind> objects;
  for (std::size_t k = first; k < kinds().size(); ++k)
    objects.push_back({kinds()[k].name,
                       [kind = kinds()[k]](Random& random) {
                         return std::vector<PlacedShape>{{kind.make(random), randomPose(random, 1.0)}};
                       }});
  objects.push_back(
      {"half-space", [](Random& random) { return std::vector<PlacedShape>{{halfSpaces().make(random)}}; }});
  objects.push_back({"cells of an octomap", cells});
  return objects;
}

struct Counts
{
  std::size_t poses = 0;
  std::size_t none = 0;       // poses without a contact
  std::size_t colliding = 0;  // after the move, by the oracle or the exact checker
  std::size_t off = 0;        // points that are not on both bodies
  double farthest = 0.0;      // metres, of a point from a body
  double least_depth = std::numeric_limits<double>::infinity();
  double seconds = 0.0;  // of the contacts

  void add(const Counts& other)
  {
    poses += other.poses;
    none += other.none;
    colliding += other.colliding;
    off += other.off;
    farthest = std::max(farthest, other.farthest);
    least_depth = std::min(least_depth, other.least_depth);
    seconds += other.seconds;
  }

  std::size_t wrong() const { return none + colliding + off + (least_depth > 0.0 ? 0 : 1); }
};

/// One shape in one object, in several poses.
Counts inspectScene(const Kind& held_kind, const ObjectKind& object_kind, std::size_t poses, double padding,
                    std::uint64_t seed)
{
  Random random(seed);
  const Shape held = held_kind.make(random);
  const std::vector<PlacedShape> object = object_kind.make(random);
  const StateInspector inspector = HeldShape::inOneObject(held, object, padding).inspector();
  const oracle::PreparedShape prepared_held(held);
  std::vector<std::unique_ptr<const oracle::PreparedShape>> prepared;
  for (const PlacedShape& shape : object)
    prepared.push_back(std::make_unique<const oracle::PreparedShape>(shape.shape));
  CollidingPoses colliding(held, object, padding, seed);
  Counts counts;
  for (std::size_t i = 0; i < 4 * poses && counts.poses < poses; ++i)
  {
    const auto pose = colliding.next();
    if (!pose)
      continue;
    ++counts.poses;
    const auto start = std::chrono::steady_clock::now();
    const auto contacts = inspector.contacts(HeldShape::state(*pose).data(), "", kMostPoints, 0);
    counts.seconds += secondsSince(start);
    if (contacts.empty())
    {
      ++counts.none;
      continue;
    }
    // Bodies that only miss their padding have no common point.
    double gap = padding > 0.0 ? padding : 0.0;
    for (std::size_t k = 0; k < object.size() && padding > 0.0; ++k)
      gap =
          std::min(gap, oracle::distance(*prepared[k], motionOf(object[k].pose), prepared_held, motionOf(*pose), gap));
    const bool is_half_space = std::holds_alternative<HalfSpace>(object.front().shape);
    for (const Contact& contact : contacts)
    {
      double from_object = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < object.size(); ++k)
        from_object = std::min(from_object, distanceTo(*prepared[k], object[k].pose, contact.point));
      const double from_held = distanceTo(prepared_held, *pose, contact.point);
      const double farthest =
          std::max(from_object - (is_half_space ? gap : 0.5 * gap), from_held - (is_half_space ? 0.0 : 0.5 * gap));
      counts.off += farthest > kOnBody ? 1 : 0;
      counts.farthest = std::max(counts.farthest, farthest);
      counts.least_depth = std::min(counts.least_depth, contact.depth);
    }
    Isometry3d moved = *pose;
    moved.pretranslate(contacts.front().depth * contacts.front().normal);
    bool collides = !inspector.contacts(HeldShape::state(moved).data(), "", 1, 0).empty();
    for (std::size_t k = 0; k < object.size() && !collides; ++k)
      collides = oracle::verdict(*prepared[k], motionOf(object[k].pose), prepared_held, motionOf(moved), padding) !=
                 oracle::Verdict::Free;
    counts.colliding += collides ? 1 : 0;
  }
  return counts;
}

void run(const CommandLine& arguments)
{
  const std::size_t poses = arguments.count("--poses", 10000, 1, 1'000'000'000);
  const std::size_t seed = arguments.count("--seed", 1, 0, 1'000'000'000);
  const double padding = arguments.number("--padding", 0.0, 0.0, 1.0);
  const std::string only = arguments.value("--kind", "");
  std::printf(
      "seed %zu, padding %g m\n\n"
      "| held | object | poses | without a contact | stay colliding | points off a body | farthest point, m | "
      "least depth, m | a call, us |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      seed, padding);
  std::size_t wrong = 0;
  std::size_t all = 0;
  for (std::size_t h = 0; h < kinds().size(); ++h)
    for (const ObjectKind& object : objectKinds(h))
    {
      const Kind held = kinds()[h];
      if (!only.empty() && held.name != only && object.name != only)
        continue;
      const std::size_t scenes = (poses + kPosesOfScene - 1) / kPosesOfScene;
      Counts counts;
      std::mutex mutex;
      parallelFor(scenes, 1,
                  [&](std::size_t i, std::size_t)
                  {
                    const Counts some = inspectScene(held, object, std::min(kPosesOfScene, poses), padding, seed + i);
                    const std::lock_guard<std::mutex> lock(mutex);
                    counts.add(some);
                  });
      std::printf("| %s | %s | %zu | %zu | %zu | %zu | %.1e | %.1e | %.0f |\n", held.name.c_str(), object.name.c_str(),
                  counts.poses, counts.none, counts.colliding, counts.off, counts.farthest, counts.least_depth,
                  1e6 * counts.seconds / static_cast<double>(std::max<std::size_t>(1, counts.poses)));
      std::fflush(stdout);
      wrong += counts.wrong();
      all += counts.poses;
    }
  std::printf("\n%zu poses, %zu promises broken\n", all, wrong);
  if (wrong > 0)
    throw Error("contacts break the promises of ContactInformation.msg");
}
}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{
      "contacts",
      "[--poses N] [--kind NAME] [--padding METRES] [--seed S]",
      "Computes the contacts of random colliding bodies of each pair of kinds. Moves the held body by the depth along\n"
      "the normal. Then checks with the oracle of the tests and with the exact checker that the collision has ended,\n"
      "that the points belong to both bodies, up to 1e-6 m, and that each depth is above 0. Prints a Markdown table.\n"
      "Exit code: 0 all promises are kept, 1 one is not, or another error, 2 bad usage.",
      {{"--poses", "N", "poses for each pair of kinds (default 10000)"},
       {"--kind", "NAME", "only pairs with this kind, for example \"box\""},
       {"--padding", "METRES", "padding of the object (default 0)"},
       {"--seed", "S", "seed of the random bodies and poses (default 1)"}},
      run};
  return runTool(tool, argc, argv);
}
