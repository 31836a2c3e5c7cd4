#include "volumes/methods.h"

#include <array>

#include "volumes/dop.h"
#include "volumes/traversal.h"

namespace gpu_planning_scene::core::volumes
{
namespace
{
struct Scheme
{
  const char* name;
  DescentRule descent_rule;
  bool breadth_first;
};

constexpr std::array<Scheme, 5> kSchemes = {{{"depth first, larger", DescentRule::Larger, false},
                                             {"depth first, shallower", DescentRule::Shallower, false},
                                             {"depth first, both", DescentRule::Both, false},
                                             {"breadth-first, larger", DescentRule::Larger, true},
                                             {"breadth-first, both", DescentRule::Both, true}}};

template <class Volume>
class MethodOf : public Method
{
 public:
  using Volumes = std::vector<std::vector<Volume>>;

  MethodOf(const std::string& name, const Scheme& scheme, const PlacedPairs& placed,
           std::shared_ptr<const Volumes> volumes)
    : Method(name, scheme.name, Volume::kBytes),
      breadth_first_(scheme.breadth_first),
      volumes_(std::move(volumes)),
      traversal_(placed, *volumes_, scheme.descent_rule)
  {
  }

  std::vector<int> check(const std::vector<std::size_t>& states, WorkCount& count) override
  {
    std::vector<int> found;
    for (const std::size_t state : states)
      found.push_back(answer(state, count));
    return found;
  }

  std::size_t run(const std::vector<std::size_t>& states) override
  {
    NoCount count;
    std::size_t colliding = 0;
    for (const std::size_t state : states)
      colliding += answer(state, count) >= 0 ? 1 : 0;
    return colliding;
  }

  bool reportsPair() const override { return !breadth_first_; }

 private:
  template <class Count>
  int answer(std::size_t state, Count& count)
  {
    if (!breadth_first_)
      return traversal_.depthFirst(state, count);
    return traversal_.breadthFirst(state, count) ? 0 : -1;
  }

  bool breadth_first_;
  std::shared_ptr<const Volumes> volumes_;
  Traversal<Volume> traversal_;
};

template <class Volume>
void addMethods(const std::string& name, const PlacedPairs& placed, std::vector<std::unique_ptr<Method>>& methods)
{
  const auto volumes = std::make_shared<const std::vector<std::vector<Volume>>>(fitVolumes<Volume>(placed));
  for (const Scheme& scheme : kSchemes)
    methods.push_back(std::make_unique<MethodOf<Volume>>(name, scheme, placed, volumes));
}
}  // namespace

std::vector<std::unique_ptr<Method>> makeMethods(const PlacedPairs& placed)
{
  std::vector<std::unique_ptr<Method>> methods;
  addMethods<AxisBoxByAllAxes>("AABB, 15 axes", placed, methods);
  addMethods<AxisBoxByFaces<true>>("AABB, 6 axes", placed, methods);
  addMethods<AxisBoxByFaces<false>>("AABB around b's, 3 axes", placed, methods);
  addMethods<Sphere>("sphere", placed, methods);
  addMethods<FittedBox>("OBB as fitted", placed, methods);
  addMethods<RefinedOrientedBox>("OBB, 15 axes", placed, methods);
  addMethods<AxisBoxOrientedLeaf>("AABB, OBB at leaves", placed, methods);
  addMethods<Dop<14, false>>("14-DOP, slabs of a", placed, methods);
  addMethods<Dop<14, true>>("14-DOP, slabs of both", placed, methods);
  addMethods<Dop<18, false>>("18-DOP, slabs of a", placed, methods);
  addMethods<Dop<18, true>>("18-DOP, slabs of both", placed, methods);
  addMethods<Dop<26, false>>("26-DOP, slabs of a", placed, methods);
  addMethods<Dop<26, true>>("26-DOP, slabs of both", placed, methods);
  return methods;
}
}  // namespace gpu_planning_scene::core::volumes
