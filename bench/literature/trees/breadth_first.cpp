#include "literature/trees/breadth_first.h"

#include <ctime>

#include "literature/trees/oriented_boxes.h"

// The traversal of A. Gress, G. Zachmann, "Object-Space Interference Detection on Programmable Graphics Hardware"
// (2003) on one core of the CPU, as a measure for the one on the device: breadth-first over lists of pairs of nodes. A
// step tests all pairs of the list; the next step makes the list of the children of all overlapping pairs. Two leaves
// are a pair of triangles. The traversal ends after the first level with a hit. Both steps are timed, because the
// authors report them apart. The trees are those of oriented_boxes.cpp. Domain: any mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// CPU time of this thread, which other programs do not disturb.
double threadSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A node's box in the frame of its mesh.
struct PlacedBox
{
  Matrix3d rotation;
  Vector3d center;
};

std::vector<PlacedBox> placedBoxes(const OrientedBoxTree& tree)
{
  std::vector<PlacedBox> boxes(tree.nodes().size());
  boxes[0] = {tree.nodes()[0].rotation, tree.nodes()[0].center};
  // Children come after their parents.
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::uint32_t k = 0; tree.nodes()[i].child != 0 && k < 2; ++k)
    {
      const std::uint32_t child = tree.nodes()[i].child + k;
      const OrientedBoxTree::Node& node = tree.nodes()[child];
      boxes[child] = {boxes[i].rotation * node.rotation, boxes[i].rotation * node.center + boxes[i].center};
    }
  return boxes;
}

class BreadthFirst : public Method
{
 public:
  BreadthFirst(const Mesh& a, const Mesh& b) : a_(a), b_(b), boxes_a_(placedBoxes(a_)), boxes_b_(placedBoxes(b_)) {}

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<std::uint8_t> answers;
    for (const Eigen::Isometry3d& pose : b_in_a)
      answers.push_back(collides(pose) ? 1 : 0);
    return answers;
  }

  WorkCounts work() const override
  {
    return {{"volume tests", volume_tests_},
            {"triangle tests", triangle_tests_},
            {"us in tests", 1e6 * test_seconds_},
            {"us in lists", 1e6 * list_seconds_}};
  }

 private:
  struct Pair
  {
    std::uint32_t a;
    std::uint32_t b;
  };

  bool collides(const Eigen::Isometry3d& pose)
  {
    list_.assign(1, {0, 0});
    bool hit = false;
    while (!list_.empty() && !hit)
    {
      const double start = threadSeconds();
      hit = testAll(pose);
      const double tested = threadSeconds();
      openAll();
      test_seconds_ += tested - start;
      list_seconds_ += threadSeconds() - tested;
    }
    return hit;
  }

  /// Sets overlaps_ for each pair of the list. Returns whether two triangles collide.
  bool testAll(const Eigen::Isometry3d& pose)
  {
    bool hit = false;
    overlaps_.resize(list_.size());
    for (std::size_t i = 0; i < list_.size(); ++i)
    {
      const OrientedBoxTree::Node& a = a_.nodes()[list_[i].a];
      const OrientedBoxTree::Node& b = b_.nodes()[list_[i].b];
      const PlacedBox& box_a = boxes_a_[list_[i].a];
      const PlacedBox& box_b = boxes_b_[list_[i].b];
      ++volume_tests_;
      const Matrix3d rotation = box_a.rotation.transpose() * (pose.linear() * box_b.rotation);
      const Vector3d translation = box_a.rotation.transpose() * (pose * box_b.center - box_a.center);
      overlaps_[i] = boxesApart(rotation, translation, a.half, b.half, kRapidEpsilon) ? 0 : 1;
      if (overlaps_[i] == 0 || a.child != 0 || b.child != 0)
        continue;
      overlaps_[i] = 0;
      if (hit)
        continue;
      ++triangle_tests_;
      hit = trianglesOverlap(a_.triangles()[a.triangle],
                             moved(b_.triangles()[b.triangle], pose.linear(), pose.translation()));
    }
    return hit;
  }

  /// Replaces the list by the children of all overlapping pairs.
  void openAll()
  {
    next_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i)
    {
      if (overlaps_[i] == 0)
        continue;
      const std::uint32_t child_a = a_.nodes()[list_[i].a].child;
      const std::uint32_t child_b = b_.nodes()[list_[i].b].child;
      for (std::uint32_t k = 0; k < (child_a == 0 ? 1U : 2U); ++k)
        for (std::uint32_t l = 0; l < (child_b == 0 ? 1U : 2U); ++l)
          next_.push_back({child_a == 0 ? list_[i].a : child_a + k, child_b == 0 ? list_[i].b : child_b + l});
    }
    list_.swap(next_);
  }

  OrientedBoxTree a_;
  OrientedBoxTree b_;
  std::vector<PlacedBox> boxes_a_;
  std::vector<PlacedBox> boxes_b_;
  std::vector<Pair> list_;
  std::vector<Pair> next_;
  std::vector<std::uint8_t> overlaps_;
  double volume_tests_ = 0.0;
  double triangle_tests_ = 0.0;
  double test_seconds_ = 0.0;
  double list_seconds_ = 0.0;
};
}  // namespace

std::unique_ptr<Method> makeBreadthFirst(const Mesh& a, const Mesh& b)
{
  return std::make_unique<BreadthFirst>(a, b);
}
}  // namespace gpu_planning_scene::core::literature
