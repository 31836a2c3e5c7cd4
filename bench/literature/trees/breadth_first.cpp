#include "literature/trees/breadth_first.h"

#include <ctime>

#include "literature/descent.h"

// The traversal of A. Gress, G. Zachmann, "Object-Space Interference Detection on Programmable Graphics Hardware"
// (2003) on one core of the CPU, as a measure for the one on the device: breadth-first over lists of pairs of nodes. A
// step tests all pairs of the list; the next step makes the list of the children of all overlapping pairs. Two leaves
// are a pair of triangles. The authors find all pairs of triangles (Search::All); with Search::First, the traversal
// ends after the first level with a hit. The authors report the times of both steps, see timesOfParts. The trees are
// those of oriented_boxes.cpp. Domain: any mesh, surfaces only.
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

class BreadthFirst : public TreeMethod
{
 public:
  BreadthFirst(OrientedBoxTreePtr a, OrientedBoxTreePtr b, Search search)
    : TreeMethod(a->triangles(), b->triangles(), search),
      a_(std::move(a)),
      b_(std::move(b)),
      boxes_a_(placedBoxes(*a_)),
      boxes_b_(placedBoxes(*b_))
  {
  }

  WorkCounts timesOfParts(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    test_seconds_ = list_seconds_ = 0.0;
    clocks_ = true;
    collide(b_in_a);
    clocks_ = false;
    return {{"us in tests", 1e6 * test_seconds_}, {"us in lists", 1e6 * list_seconds_}};
  }

 private:
  struct Pair
  {
    std::uint32_t a;
    std::uint32_t b;
  };

  bool traverse() override
  {
    list_.assign(1, {0, 0});
    bool ended = false;
    while (!list_.empty() && !ended)
    {
      const double start = now();
      ended = testAll();
      const double tested = now();
      openAll();
      test_seconds_ += tested - start;
      list_seconds_ += now() - tested;
    }
    return ended;
  }

  double now() const { return clocks_ ? threadSeconds() : 0.0; }

  /// Sets overlaps_ for each pair of the list. Returns whether the query ends.
  bool testAll()
  {
    bool ends = false;
    overlaps_.resize(list_.size());
    for (std::size_t i = 0; i < list_.size(); ++i)
    {
      const OrientedBoxTree::Node& a = a_->nodes()[list_[i].a];
      const OrientedBoxTree::Node& b = b_->nodes()[list_[i].b];
      const PlacedBox& box_a = boxes_a_[list_[i].a];
      const PlacedBox& box_b = boxes_b_[list_[i].b];
      countVolumeTest();
      const Matrix3d rotation = box_a.rotation.transpose() * (pose().linear() * box_b.rotation);
      const Vector3d translation = box_a.rotation.transpose() * (pose() * box_b.center - box_a.center);
      overlaps_[i] = boxesApart(rotation, translation, a.half, b.half, kRapidEpsilon) ? 0 : 1;
      if (overlaps_[i] == 0 || a.child != 0 || b.child != 0)
        continue;
      overlaps_[i] = 0;
      ends = ends || testLeaves(a.triangle, b.triangle);
    }
    return ends;
  }

  /// Replaces the list by the children of all overlapping pairs.
  void openAll()
  {
    next_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i)
    {
      if (overlaps_[i] == 0)
        continue;
      const Children of_a = childrenOrSelf(a_->nodes(), list_[i].a);
      const Children of_b = childrenOrSelf(b_->nodes(), list_[i].b);
      for (std::uint32_t k = 0; k < of_a.count; ++k)
        for (std::uint32_t l = 0; l < of_b.count; ++l)
          next_.push_back({of_a.first + k, of_b.first + l});
    }
    list_.swap(next_);
  }

  OrientedBoxTreePtr a_;
  OrientedBoxTreePtr b_;
  std::vector<PlacedBox> boxes_a_;
  std::vector<PlacedBox> boxes_b_;
  std::vector<Pair> list_;
  std::vector<Pair> next_;
  std::vector<std::uint8_t> overlaps_;
  bool clocks_ = false;
  double test_seconds_ = 0.0;
  double list_seconds_ = 0.0;
};
}  // namespace

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

std::unique_ptr<Method> makeBreadthFirst(const MeshPtr& a, const MeshPtr& b, Search search)
{
  return std::make_unique<BreadthFirst>(orientedBoxTree(a), orientedBoxTree(b), search);
}
}  // namespace gpu_planning_scene::core::literature
