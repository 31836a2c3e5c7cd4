#include "gpu_planning_scene/mesh_pair_checker.h"
#include "literature/exact_pair.h"
#include "literature/method.h"

// The methods of this package. Domain: any mesh; a closed component is a solid, so containment is found.
namespace gpu_planning_scene::core::literature
{
namespace
{
/// The exact checker on one core, as the other methods on the CPU are measured.
class ExactCpu : public PosewiseMethod
{
 public:
  ExactCpu(const Shape& a, const Shape& b) : pair_(pairProblem(a, b)) {}

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override { return pair_.collides(b_in_a, scratch_); }

  ExactPair pair_;
  ExactChecker::Scratch scratch_;
};

/// The checker for two meshes on the device. The CPU decides the poses that the device leaves undecided.
class OnDevice : public Method
{
 public:
  OnDevice(const Shape& a, const Shape& b, Traversal traversal) : checker_(a, b, options(traversal)) {}

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<std::uint8_t> answers = checker_.collide(b_in_a);
    undecided_ += static_cast<double>(checker_.undecided());
    return answers;
  }
  WorkCounts work() const override { return {{"undecided", undecided_}}; }

 private:
  static BatchCheckerOptions options(Traversal traversal)
  {
    BatchCheckerOptions made;
    made.traversal = traversal;
    made.device_only = true;
    return made;
  }

  MeshPairChecker checker_;
  double undecided_ = 0.0;
};

MethodInfo onDevice(const char* name, const char* title, Traversal traversal)
{
  return {name,
          title,
          "this package",
          "ours",
          {true, true, true},
          [traversal](const auto& a, const auto& b) { return std::make_unique<OnDevice>(a, b, traversal); }};
}
}  // namespace

std::vector<MethodInfo> ourMethods()
{
  return {{"exact_cpu",
           "ours, exact checker",
           "this package",
           "ours",
           {true, true, true},
           [](const auto& a, const auto& b) { return std::make_unique<ExactCpu>(a, b); }},
          onDevice("ours_work_queue", "ours, work queues", Traversal::WorkQueue),
          onDevice("ours_breadth_first", "ours, breadth-first", Traversal::BreadthFirst)};
}
}  // namespace gpu_planning_scene::core::literature
