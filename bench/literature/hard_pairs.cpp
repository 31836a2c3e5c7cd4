#include "literature/hard_pairs.h"

#include <cmath>
#include <random>

#include "literature/contacts.h"
#include "literature/poses.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Levels = std::vector<double>;

constexpr double kRemote = 5e5;  // metres; kLargestLength is twice as much

const Levels kFineLevels = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, -1e-6, -1e-5, -1e-4, -1e-3, -1e-2};
const Levels kCoarseLevels = {1e-2, 1e-3, 1e-5, -1e-5, -1e-3, -1e-2};
const Levels kThinLevels = {1e-2, 1e-3, 1e-5, -1e-5, -5e-5};  // a needle is 1e-4 thick
const Levels kGrainLevels = {0.3, 0.1, 0.01, -0.01, -0.1, -0.3};

void addLevels(const std::string& family, const std::vector<Contact>& contacts, const Levels& levels, double size,
               HardPair& pair)
{
  for (const double level : levels)
    for (const Contact& contact : contacts)
    {
      Isometry3d pose = contact.apart;
      pose.pretranslate(level * size * contact.direction);
      pair.poses.push_back({family, level, pose});
    }
}

HardPair nearContact(const std::string& family, const MeshPtr& a, const MeshPtr& b, const Levels& levels, double size,
                     std::size_t count, std::uint64_t seed)
{
  HardPair pair;
  pair.a = a;
  pair.b = b;
  addLevels(family, contacts(a, b, true, count, seed), levels, size, pair);
  return pair;
}

/// The same pair in other coordinates: `world` moves the vertices of both, after they are scaled.
HardPair inOtherCoordinates(const std::string& family, HardPair pair, const Isometry3d& world, double scale)
{
  const bool same = pair.a == pair.b;
  pair.a = moved(pair.a, world, scale);
  pair.b = same ? pair.a : moved(pair.b, world, scale);
  for (HardPose& pose : pair.poses)
  {
    pose.family = family;
    pose.b_in_a.translation() *= scale;
    pose.b_in_a = world * pose.b_in_a * world.inverse();
  }
  return pair;
}

void addClearances(std::size_t count, std::uint64_t seed, std::vector<HardPair>& pairs)
{
  for (const char* name : {"box", "sphere", "torus", "lump"})
  {
    HardPair pair;
    pair.a = name == std::string("box") ? boxMesh({1.0, 0.7, 0.4}) : modelMesh(name);
    pair.b = pair.a;
    pair.convex = name == std::string("box") || name == std::string("sphere");
    const std::string kind = pair.convex ? "convex" : "concave";
    addLevels(kind + ", along the axes", contacts(pair.a, pair.b, false, count, seed), kFineLevels, 1.0, pair);
    addLevels(kind + ", turned", contacts(pair.a, pair.b, true, count, seed), kFineLevels, 1.0, pair);
    pairs.push_back(pair);
  }
}

void addCoordinates(std::size_t count, std::uint64_t seed, std::vector<HardPair>& pairs)
{
  const MeshPtr torus = modelMesh("torus");
  HardPair aligned;
  aligned.a = aligned.b = torus;
  addLevels("", contacts(torus, torus, false, count, seed), kCoarseLevels, 1.0, aligned);
  for (const double degrees : {1.0, 45.0})
  {
    const Isometry3d turn(Eigen::AngleAxisd(degrees * M_PI / 180.0, Vector3d(1.0, 0.7, 0.4).normalized()));
    pairs.push_back(inOtherCoordinates("world turned by " + std::to_string(static_cast<int>(degrees)) + " degrees",
                                       aligned, turn, 1.0));
  }
  const HardPair turned = nearContact("", torus, torus, kCoarseLevels, 1.0, count, seed);
  pairs.push_back(inOtherCoordinates("units of 1e-6", turned, Isometry3d::Identity(), 1e-6));
  pairs.push_back(inOtherCoordinates("units of 5e5", turned, Isometry3d::Identity(), kRemote));
  pairs.back().remote = true;
  pairs.push_back(inOtherCoordinates("5e5 m from the origin", turned,
                                     Isometry3d(Eigen::Translation3d(kRemote * Vector3d(1.0, -0.8, 0.6))), 1.0));
  pairs.back().remote = true;
}

void addSurfaces(std::size_t count, std::uint64_t seed, std::vector<HardPair>& pairs)
{
  const MeshPtr lump = modelMesh("lump");
  const auto add = [&](const char* family, Damage damage, bool open)
  {
    const MeshPtr broken = damaged(lump, damage, seed);
    pairs.push_back(nearContact(family, broken, broken, kCoarseLevels, 1.0, count, seed));
    pairs.back().open = open;
  };
  add("a tenth of the faces removed", Damage::Removed, true);
  add("a tenth of the faces flipped", Damage::Flipped, true);
  add("a tenth of the faces doubled", Damage::Doubled, true);
  pairs.push_back(
      nearContact("sizes 1 : 1000", lump, scaled(modelMesh("sphere"), 1e-3), kCoarseLevels, 1e-3, count, seed));
}

/// Cases that lie between the pixels. The boxes around the shapes are hundreds of times as wide as the parts that meet,
/// so a view of the whole box gives these parts less than a pixel.
void addThinShapes(std::size_t count, std::uint64_t seed, std::vector<HardPair>& pairs)
{
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double lower, double upper)
  { return std::uniform_real_distribution<double>(lower, upper)(generator); };

  // Two needles cross each other. Level: as a share of their length.
  HardPair needles;
  needles.a = needles.b = needle();
  needles.convex = true;
  std::vector<Path> paths;
  while (paths.size() < count)
  {
    const Vector3d across =
        Vector3d(uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)).cross(kNeedleAxis).normalized();
    Isometry3d start(Eigen::AngleAxisd(uniform(0.4, M_PI - 0.4), across));
    const Vector3d axis = start.linear() * kNeedleAxis;
    if (axis.cwiseAbs().minCoeff() < 0.2)  // along a face of its bounding box
      continue;
    start.translation() = uniform(-0.3, 0.3) * kNeedleAxis - uniform(-0.3, 0.3) * axis;
    paths.push_back({start, across, 0.1});
  }
  addLevels("needles", contactsOn(paths, needles.a, needles.b), kThinLevels, 1.0, needles);
  pairs.push_back(needles);

  // An upright edge of a plate meets the face of another plate. A view from above, along the shortest side of their
  // boxes, shows both plates from the edge. None of them lies along a side of its box.
  HardPair plates;
  plates.a = plates.b = plate();
  plates.convex = true;
  paths.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    Isometry3d start(Eigen::AngleAxisd(uniform(1.3, 2.1), Vector3d::UnitZ()));
    start.translation().z() = uniform(-0.02, 0.02);
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double along = uniform(0.2, 0.3);
    start.translation() += side * along * (start.linear() * kPlateAxis) + uniform(-0.2, 0.2) * kPlateAxis;
    paths.push_back({start, side * (start.linear() * kPlateAxis), 1.0});
  }
  addLevels("plates from the edge", contactsOn(paths, plates.a, plates.b), kFineLevels, 1.0, plates);
  pairs.push_back(plates);

  // Level: as a share of the size of a grain.
  HardPair tiny;
  tiny.a = grains(seed);
  tiny.b = grains(seed, Eigen::AngleAxisd(1.0, Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix());
  paths.clear();
  for (const Isometry3d& pose : posesAt(1.0, count, seed))
    paths.push_back({Isometry3d::Identity(), pose.translation().normalized(), 10.0 * kGrainSize});
  addLevels("triangles below a pixel", contactsOn(paths, tiny.a, tiny.b), kGrainLevels, kGrainSize, tiny);
  pairs.push_back(tiny);
}

void addPlaces(std::size_t count, std::uint64_t seed, std::vector<HardPair>& pairs)
{
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double lower, double upper)
  { return std::uniform_real_distribution<double>(lower, upper)(generator); };

  // Level: the size of the inner mesh, divided by that of the outer one.
  for (const double level : {0.5, 0.1, 1e-3})
  {
    HardPair inside;
    inside.a = modelMesh("sphere");
    inside.b = scaled(modelMesh("lump"), level);
    inside.contained = true;
    for (const Isometry3d& pose : posesAt(0.15, count, seed))
      inside.poses.push_back({"containment", level, pose});
    pairs.push_back(inside);
  }
  // Level: the largest turn out of the middle of the hole, in radians.
  HardPair linked;
  linked.a = linked.b = modelMesh("torus");
  for (const double level : {0.0, 0.1, 0.2})
    for (std::size_t i = 0; i < count; ++i)
    {
      Isometry3d pose(Eigen::Translation3d(0.35, 0.0, 0.0));
      pose.rotate(Eigen::AngleAxisd(0.5 * M_PI + uniform(-level, level), Vector3d::UnitX()));
      pose.rotate(Eigen::AngleAxisd(uniform(-M_PI, M_PI), Vector3d::UnitZ()));
      linked.poses.push_back({"linked tori", level, pose});
    }
  pairs.push_back(linked);
  // Level 0: exact contact, if the coordinates of the poses have no rounding.
  HardPair touching;
  touching.a = touching.b = boxMesh({1.0, 0.5, 0.25});
  touching.convex = true;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double shift = static_cast<double>(i) / 64.0;
    touching.poses.push_back({"faces in one plane", 0.0, Isometry3d(Eigen::Translation3d(shift, 0.125, 0.25))});
    touching.poses.push_back({"edge on edge", 0.0, Isometry3d(Eigen::Translation3d(shift, 0.5, 0.25))});
    touching.poses.push_back({"vertex on vertex", 0.0, Isometry3d(Eigen::Translation3d(1.0, 0.5, -0.25))});
  }
  pairs.push_back(touching);
  HardPair dense;
  dense.a = pile(seed);
  dense.b = pile(seed + 1);
  // Level: the distance of the centres, in metres.
  for (const double level : {0.5, 0.9, 1.1})
    for (const Isometry3d& pose : posesAt(level, count, seed))
      dense.poses.push_back({"dense piles", level, pose});
  pairs.push_back(dense);
}
}  // namespace

std::vector<HardPair> hardPairs(std::size_t count, std::uint64_t seed)
{
  std::vector<HardPair> pairs;
  addClearances(count, seed, pairs);
  addCoordinates(count, seed, pairs);
  addSurfaces(count, seed, pairs);
  addThinShapes(count, seed, pairs);
  addPlaces(count, seed, pairs);
  return pairs;
}
}  // namespace gpu_planning_scene::core::literature
