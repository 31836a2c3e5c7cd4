#include <algorithm>
#include <array>
#include <cstring>

#include <epoxy/gl.h>

#include "benchmark/statistics.h"
#include "gpu/gl_thread.h"
#include "gpu/program.h"
#include "gpu_planning_scene/error.h"
#include "literature/device/traversal_shaders.h"
#include "literature/method.h"
#include "literature/trees/breadth_first.h"

// A. Gress, G. Zachmann, "Object-Space Interference Detection on Programmable Graphics Hardware" (2003), as the authors
// measured it: the device traverses two trees breadth-first, finds all pairs of triangles that collide, and the pairs
// are read back. A level takes two passes: all pairs of nodes of the list are tested, then the list of their children
// is written. Compute shaders and an atomic counter take the place of the paper's fragment programs. The tests are in
// float32 without error bounds, as in 2003. The trees and the order are those of breadth_first.cpp, so the two methods
// do the same work. Several poses share the lists. Domain: any mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
using benchmark::Stopwatch;
using Eigen::Isometry3d;

constexpr std::size_t kEntryWords = 3;           // pose, node of a, node of b
constexpr std::size_t kMostEntries = 1U << 23U;  // of a list: 100 MB
constexpr std::size_t kMostFound = 1U << 22U;
constexpr std::size_t kMostPoses = 256;  // at once
constexpr std::size_t kGroupSize = 64;

std::uint32_t bits(double value)
{
  const auto rounded = static_cast<float>(value);
  std::uint32_t word = 0;
  std::memcpy(&word, &rounded, sizeof word);
  return word;
}

std::vector<std::uint32_t> nodeWords(const OrientedBoxTree& tree)
{
  const std::vector<PlacedBox> boxes = placedBoxes(tree);
  std::vector<std::uint32_t> words;
  const auto add = [&](const Eigen::Vector3d& v, std::uint32_t last) {
    words.insert(words.end(), {bits(v.x()), bits(v.y()), bits(v.z()), last});
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    add(boxes[i].center, tree.nodes()[i].child);
    add(tree.nodes()[i].half, tree.nodes()[i].triangle);
    add(boxes[i].rotation.col(0), 0);
    add(boxes[i].rotation.col(1), 0);
  }
  return words;
}

std::vector<float> cornersOf(const OrientedBoxTree& tree)
{
  std::vector<float> numbers;
  for (const Triangle& t : tree.triangles())
    for (const Eigen::Vector3d& corner : t)
      for (int axis = 0; axis < 3; ++axis)
        numbers.push_back(static_cast<float>(corner[axis]));
  return numbers;
}

Program compiled(const char* name, const char* text)
{
  return Program::fromText(shaderFolder(), name, std::string(kTraversalDeclarations) + text);
}

/// Everything that lives on the context's thread.
class Traversal
{
 public:
  Traversal(const OrientedBoxTree& a, const OrientedBoxTree& b)
    : test_(compiled("test of all pairs", kTestShader)), list_(compiled("list of all pairs", kListShader))
  {
    upload(nodeWords(a), nodes_a_);
    upload(nodeWords(b), nodes_b_);
    upload(cornersOf(a), triangles_a_);
    upload(cornersOf(b), triangles_b_);
    counters_.reserve(2 * sizeof(std::uint32_t));
    found_.reserve(kMostFound * kEntryWords * sizeof(std::uint32_t));
  }

  /// Appends the found pairs: pose, triangle of a, triangle of b. Returns false if the lists are too small for so many
  /// poses. `clocks`: measures the passes, which then wait for each other.
  bool find(const Isometry3d* poses, std::size_t count, bool clocks, std::vector<std::uint32_t>& pairs)
  {
    uploadPoses(poses, count);
    std::vector<std::uint32_t> roots;
    for (std::uint32_t pose = 0; pose < count; ++pose)
      roots.insert(roots.end(), {pose, 0, 0});
    upload(roots, lists_[0]);
    std::array<std::uint32_t, 2> counts = {0, 0};  // of the next list, and of the found pairs
    counters_.write(counts.data(), sizeof counts);
    std::size_t entries = count;
    for (std::size_t level = 0; entries > 0; ++level)
    {
      const std::size_t capacity = std::min(4 * entries, kMostEntries);
      marks_.reserve(entries * sizeof(std::uint32_t));
      Buffer& next = lists_[1 - level % 2];
      next.reserve(capacity * kEntryWords * sizeof(std::uint32_t));
      testAll(lists_[level % 2], entries, clocks);
      openAll(lists_[level % 2], entries, next, capacity, clocks);
      volume_tests += static_cast<double>(entries);
      counters_.read(counts.data(), sizeof counts);
      if (counts[0] > capacity || counts[1] > kMostFound)
        return false;  // the pairs beyond the capacity were not written
      entries = counts[0];
      counters_.clear(0, sizeof(std::uint32_t));
    }
    pairs.resize(std::size_t{counts[1]} * kEntryWords);
    if (!pairs.empty())
      found_.read(pairs.data(), pairs.size() * sizeof(std::uint32_t));
    return true;
  }

  double volume_tests = 0.0;
  double test_seconds = 0.0;
  double list_seconds = 0.0;

 private:
  template <class T>
  static void upload(const std::vector<T>& data, Buffer& buffer)
  {
    buffer.reserve(data.size() * sizeof(T));
    buffer.write(data);
  }

  void uploadPoses(const Isometry3d* poses, std::size_t count)
  {
    std::vector<float> rows;
    for (std::size_t i = 0; i < count; ++i)
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
          rows.push_back(static_cast<float>(poses[i].matrix()(row, column)));
    upload(rows, poses_);
  }

  void testAll(const Buffer& list, std::size_t entries, bool clocks)
  {
    nodes_a_.bindStorage(kNodesABinding);
    nodes_b_.bindStorage(kNodesBBinding);
    list.bindStorage(kListBinding);
    marks_.bindStorage(kMarksBinding);
    triangles_a_.bindStorage(kTrianglesABinding);
    triangles_b_.bindStorage(kTrianglesBBinding);
    poses_.bindStorage(kPosesBinding);
    test_.set(kCountLocation, static_cast<std::uint32_t>(entries));
    run(test_, entries, clocks, test_seconds);
  }

  void openAll(const Buffer& list, std::size_t entries, const Buffer& next, std::size_t capacity, bool clocks)
  {
    list.bindStorage(kListBinding);
    next.bindStorage(kNextBinding);
    found_.bindStorage(kFoundBinding);
    counters_.bindStorage(kCountersBinding);
    list_.set(kCountLocation, static_cast<std::uint32_t>(entries));
    list_.set(kNextCapacityLocation, static_cast<std::uint32_t>(capacity));
    list_.set(kFoundCapacityLocation, static_cast<std::uint32_t>(kMostFound));
    run(list_, entries, clocks, list_seconds);
  }

  static void run(const Program& program, std::size_t entries, bool clocks, double& seconds)
  {
    const Stopwatch watch;
    program.dispatch((entries + kGroupSize - 1) / kGroupSize);
    if (!clocks)
      return;
    glFinish();
    seconds += watch.seconds();
  }

  Program test_;
  Program list_;
  Buffer nodes_a_;
  Buffer nodes_b_;
  Buffer triangles_a_;
  Buffer triangles_b_;
  Buffer poses_;
  std::array<Buffer, 2> lists_;
  Buffer marks_;
  Buffer found_;
  Buffer counters_;
};

class AllPairsOnDevice : public Method
{
 public:
  AllPairsOnDevice(const OrientedBoxTree& a, const OrientedBoxTree& b) : thread_("auto")
  {
    thread_.run([&] { traversal_ = std::make_unique<Traversal>(a, b); });
  }
  ~AllPairsOnDevice() override
  {
    thread_.run([this] { traversal_.reset(); });
  }
  AllPairsOnDevice(const AllPairsOnDevice&) = delete;
  AllPairsOnDevice& operator=(const AllPairsOnDevice&) = delete;

  std::vector<std::uint8_t> collide(const std::vector<Isometry3d>& b_in_a) override { return find(b_in_a, false); }

  WorkCounts work() const override
  {
    return {{"volume tests", traversal_->volume_tests}, {"pairs of triangles", pairs_found_}};
  }

  WorkCounts timesOfParts(const std::vector<Isometry3d>& b_in_a) override
  {
    traversal_->test_seconds = traversal_->list_seconds = 0.0;
    find(b_in_a, true);
    return {{"us in tests", 1e6 * traversal_->test_seconds}, {"us in lists", 1e6 * traversal_->list_seconds}};
  }

 private:
  std::vector<std::uint8_t> find(const std::vector<Isometry3d>& b_in_a, bool clocks)
  {
    std::vector<std::uint8_t> answers(b_in_a.size(), 0);
    thread_.run(
        [&]
        {
          for (std::size_t begin = 0; begin < b_in_a.size(); begin += kMostPoses)
            findPart(b_in_a, begin, std::min(b_in_a.size(), begin + kMostPoses), clocks, answers);
        });
    return answers;
  }

  void findPart(const std::vector<Isometry3d>& b_in_a, std::size_t begin, std::size_t end, bool clocks,
                std::vector<std::uint8_t>& answers)
  {
    std::vector<std::uint32_t> pairs;
    if (traversal_->find(&b_in_a[begin], end - begin, clocks, pairs))
    {
      pairs_found_ += static_cast<double>(pairs.size() / kEntryWords);
      for (std::size_t i = 0; i < pairs.size(); i += kEntryWords)
        answers[begin + pairs[i]] = 1;
      return;
    }
    if (end - begin == 1)
      throw Error("a pose has more than " + std::to_string(kMostEntries) +
                  " pairs of boxes in one level; use smaller meshes");
    const std::size_t middle = begin + (end - begin) / 2;
    findPart(b_in_a, begin, middle, clocks, answers);
    findPart(b_in_a, middle, end, clocks, answers);
  }

  GlThread thread_;
  std::unique_ptr<Traversal> traversal_;
  double pairs_found_ = 0.0;
};
}  // namespace

std::vector<MethodInfo> deviceMethods()
{
  return {{"gress_zachmann",
           "breadth-first, device, all pairs",
           "Gress, Zachmann 2003",
           "paper",
           {},
           [](const auto& a, const auto& b)
           { return std::make_unique<AllPairsOnDevice>(*orientedBoxTree(a), *orientedBoxTree(b)); }}};
}
}  // namespace gpu_planning_scene::core::literature
