#include "collision/gpu/proofs/proof_texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "collision/gpu/proofs/proof_names.h"
#include "gpu_planning_scene/error.h"

// Only the form changes: numbers and thresholds are those of the lane scene, which was made with the rounding errors of
// the device.
namespace gpu_planning_scene::core
{
namespace
{
static_assert(static_cast<int>(Proof::Apart) == TABLE_APART && static_cast<int>(Proof::Colliding) == TABLE_COLLIDING &&
                  static_cast<int>(Proof::None) == TABLE_NONE,
              "the verdicts of the shaders");
static_assert(TABLE_CELLS_A_WORD * TABLE_CELL_BITS == 32, "a word of cells");
static_assert(static_cast<unsigned>(lanes::ObjectKind::Box) == OBJECT_BOX &&
                  static_cast<unsigned>(lanes::ObjectKind::Sphere) == OBJECT_SPHERE &&
                  static_cast<unsigned>(lanes::ObjectKind::Cylinder) == OBJECT_CYLINDER &&
                  static_cast<unsigned>(lanes::ObjectKind::Cone) == OBJECT_CONE &&
                  static_cast<unsigned>(lanes::ObjectKind::HalfSpace) == OBJECT_HALF_SPACE &&
                  static_cast<unsigned>(lanes::ObjectKind::BoundingBox) == OBJECT_BOUNDING_BOX,
              "the kinds of the shaders");
static_assert(lanes::kLevelBegin[1] == COVER_COARSE_BALLS && lanes::kBalls == COVER_BALLS, "the balls of the shaders");

std::uint32_t bits(float value)
{
  std::uint32_t word = 0;
  std::memcpy(&word, &value, sizeof(word));
  return word;
}

ProofTexel numbers(float x, float y, float z, float w)
{
  return {bits(x), bits(y), bits(z), bits(w)};
}

constexpr std::size_t kCellsATexel = std::size_t{TABLE_CELLS_A_WORD} * TEXEL_WORDS;

std::size_t cellsOf(const lanes::Table& table)
{
  std::size_t count = 1;
  for (int k = 0; k < table.variables; ++k)
    count *= static_cast<std::size_t>(table.variable[k].cells);
  return count;
}

/// The texels, and what is known about them while they grow.
class Writer
{
 public:
  explicit Writer(const LaneScene& scene) : scene_(scene), model_(scene.model()) { texels_.resize(RECORDS_HEADER); }

  std::vector<ProofTexel> write()
  {
    for (std::size_t t = 0; t < model_.tables.count; ++t)
      addCells(model_.tables[t]);
    const std::uint32_t centers = addCenters();
    const std::uint32_t frames = begin();
    for (std::size_t f = 0; f < model_.frames.count; ++f)
      texels_.push_back({centers_begin_[f], centers_begin_[f + 1], 0, 0});
    const std::uint32_t self_pairs = addSelfPairs();
    const std::uint32_t self_groups = addSelfGroups();
    const std::uint32_t world_pairs = addWorldPairs();
    const std::uint32_t world_boxes = addWorldBoxes();
    const std::uint32_t world_groups = addWorldGroups();
    const std::uint32_t world_instances = addWorldInstances();
    const std::uint32_t objects = addObjects();
    const std::uint32_t instances = addInstances();
    texels_[0] = {frames, centers, firstAttached(), self_groups};
    texels_[1] = {self_groups_, model_.self_groups.count + 1, self_pairs, world_instances};
    texels_[2] = {world_groups, world_boxes, world_pairs, objects};
    texels_[3] = {instances, model_.self_pairs.count, 0, 0};
    return std::move(texels_);
  }

 private:
  /// The first texel of the records that are added next.
  std::uint32_t begin() const { return static_cast<std::uint32_t>(texels_.size()); }

  /// The packed pair, see packPair of the shaders.
  std::uint32_t packed(std::uint32_t pair) const
  {
    const auto [a, b] = scene_.instancesOf(pair);
    return std::uint32_t{a} << PAIR_OTHER_BITS | b;
  }

  void addCells(const lanes::Table& table)
  {
    const std::size_t first = texels_.size();
    texels_.resize(first + texelsOfCells(table));
    for (std::size_t i = 0; i < cellsOf(table); ++i)
      texels_[first + i / kCellsATexel][i / TABLE_CELLS_A_WORD % TEXEL_WORDS] |=
          static_cast<std::uint32_t>(table.cells[i]) << TABLE_CELL_BITS * (i % TABLE_CELLS_A_WORD);
  }

  /// The instances of attached objects follow those of the links. The shader relies on it.
  std::uint32_t firstAttached() const
  {
    const std::vector<std::uint32_t>& centers = scene_.linkCenters();
    const auto end = std::lower_bound(centers.begin(), centers.end(), model_.instances.count);
    const auto count = static_cast<std::uint32_t>(end - centers.begin());
    if (count > 0 && *(end - 1) != count - 1)
      throw Error("a shape of a link follows one of an attached object");
    return count;
  }

  /// The centres that the robot's shader does not place, sorted by their frames.
  std::uint32_t addCenters()
  {
    const std::uint32_t first = begin();
    const std::vector<std::uint32_t>& placed = scene_.linkCenters();
    for (std::uint32_t f = 0; f < model_.frames.count; ++f)
    {
      centers_begin_.push_back(begin() - first);
      for (std::uint32_t c = 0; c < model_.instances.count + model_.clusters.count; ++c)
        if (frameOf(model_, c) == static_cast<int>(f) && std::find(placed.begin(), placed.end(), c) == placed.end())
        {
          const std::array<float, 3> origin = {};
          const float* place = c < model_.instances.count ? model_.instances[c].center : origin.data();
          texels_.push_back({bits(place[0]), bits(place[1]), bits(place[2]), c});
        }
    }
    centers_begin_.push_back(begin() - first);
    return first;
  }

  std::uint32_t addSelfPairs()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t p = 0; p < model_.self_pairs.count; ++p)
    {
      const lanes::SelfPair& pair = model_.self_pairs[p];
      texels_.push_back(
          {packed(p), bits(enclosingSum(model_, pair)), bits(pair.thresholds.cover), bits(pair.thresholds.inner)});
      texels_.push_back(numbers(pair.boxes.growth, pair.boxes.parallel, 0.0F, 0.0F));
    }
    return first;
  }

  /// First the groups that the robot's shader does not test. The last group has the pairs with tables.
  std::uint32_t addSelfGroups()
  {
    const std::uint32_t first = begin();
    for (const bool of_links : {false, true})
    {
      for (std::uint32_t g = 0; g < model_.self_groups.count; ++g)
        if (const lanes::SelfGroup& group = model_.self_groups[g]; scene_.isOfLinks(group) == of_links)
          texels_.push_back({group.centers[0] | group.centers[1] << 16U, bits(group.reach), group.first, group.end});
      if (!of_links)
        self_groups_ = begin() - first;
    }
    texels_.push_back({0, 0, 0, model_.tables.count});
    return first;
  }

  std::uint32_t addWorldPairs()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t w = 0; w < model_.world_pairs.count; ++w)
    {
      const lanes::Thresholds& thresholds = model_.world_pairs[w].thresholds;
      texels_.push_back({packed(model_.self_pairs.count + w), bits(thresholds.cover), bits(thresholds.inner), 0});
    }
    return first;
  }

  std::uint32_t addWorldBoxes()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t g = 0; g < model_.world_groups.count; ++g)
      for (std::uint32_t w = model_.world_groups[g].first; w < model_.world_groups[g].end; ++w)
        texels_.push_back(stepsIn(model_.world_groups[g], scene_.worldBounds()[w]));
    return first;
  }

  /// The ends of a box along each axis in steps of the box of its group, rounded outwards.
  static ProofTexel stepsIn(const lanes::WorldGroup& group, const Eigen::AlignedBox3d& box)
  {
    // Half a step more covers the rounding of the shader.
    const auto step = [&group](double place, std::size_t axis)
    {
      return (place - static_cast<double>(group.box.center[axis])) / static_cast<double>(group.box.half[axis]) *
                 BOX_STEPS +
             BOX_STEPS;
    };
    ProofTexel texel = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const auto k = static_cast<Eigen::Index>(axis);
      const double low = std::floor(step(box.min()[k], axis) - 0.5);
      const double high = std::ceil(step(box.max()[k], axis) + 0.5);
      texel[axis] = static_cast<std::uint32_t>(std::max(low, 0.0)) |
                    static_cast<std::uint32_t>(std::min(high, 2.0 * BOX_STEPS)) << 16U;
    }
    return texel;
  }

  std::uint32_t addWorldGroups()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t g = 0; g < model_.world_groups.count; ++g)
    {
      const lanes::WorldGroup& group = model_.world_groups[g];
      texels_.push_back({bits(group.box.center[0]), bits(group.box.center[1]), bits(group.box.center[2]), group.first});
      texels_.push_back({bits(group.box.half[0]), bits(group.box.half[1]), bits(group.box.half[2]), group.end});
    }
    return first;
  }

  /// The groups of an instance follow each other.
  std::uint32_t addWorldInstances()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t i = 0; i < model_.instances.count; ++i)
      texels_.push_back({0, 0, bits(model_.instances[i].outer), 0});
    for (std::uint32_t g = 0; g < model_.world_groups.count; ++g)
    {
      ProofTexel& texel = texels_[first + model_.world_groups[g].instance];
      texel[0] = texel[1] == 0 ? g : texel[0];
      texel[1] = g + 1;
    }
    return first;
  }

  /// Half lengths of a box around an object.
  static std::array<float, 3> boxAround(const lanes::Object& object)
  {
    const bool round = object.kind == lanes::ObjectKind::Cylinder || object.kind == lanes::ObjectKind::Cone;
    return {object.half[0], object.half[round ? 0 : 1], object.half[round ? 1 : 2]};
  }

  /// The half lengths are those of a box around the object.
  std::uint32_t addObjects()
  {
    const std::uint32_t first = begin();
    for (std::uint32_t o = 0; o < model_.objects.count; ++o)
    {
      const lanes::Object& object = model_.objects[o];
      for (std::size_t row = 0; row < 3; ++row)
      {
        const float* entries = object.from_planning_frame + 4 * row;
        texels_.push_back(numbers(entries[0], entries[1], entries[2], entries[3]));
      }
      const std::array<float, 3> half = boxAround(object);
      texels_.push_back({bits(half[0]), bits(half[1]), bits(half[2]), static_cast<std::uint32_t>(object.kind)});
    }
    return first;
  }

  std::uint32_t addInstances()
  {
    const std::uint32_t first = begin();
    const std::vector<int> places = placesOfFrames(model_);
    for (std::uint32_t i = 0; i < model_.instances.count; ++i)
    {
      const lanes::Instance& instance = model_.instances[i];
      const lanes::Box& box = instance.box;
      texels_.push_back({static_cast<std::uint32_t>(places[static_cast<std::size_t>(instance.frame)]),
                         instance.same_centers ? 1U : 0U, 0, 0});
      for (int axis = 0; axis < 3; ++axis)
        texels_.push_back(numbers(box.axes[axis][0], box.axes[axis][1], box.axes[axis][2], box.half[axis]));
      texels_.push_back(numbers(box.center[0], box.center[1], box.center[2], 0.0F));
      const lanes::Balls& outer = instance.outer_balls;
      const lanes::Balls& inner = instance.inner_balls;
      for (int k = 0; k < lanes::kBalls; ++k)
        texels_.push_back(numbers(outer.x[k], outer.y[k], outer.z[k], outer.radius[k]));
      for (int k = 0; k < lanes::kBalls; k += TEXEL_WORDS)
        texels_.push_back(numbers(inner.radius[k], inner.radius[k + 1], inner.radius[k + 2], inner.radius[k + 3]));
      for (int k = 0; k < lanes::kBalls; ++k)
        texels_.push_back(numbers(inner.x[k], inner.y[k], inner.z[k], 0.0F));
    }
    return first;
  }

  const LaneScene& scene_;
  const lanes::Model& model_;
  std::vector<ProofTexel> texels_;
  std::vector<std::uint32_t> centers_begin_;  // of each frame, and their number
  std::uint32_t self_groups_ = 0;             // that the robot's shader does not test
};
}  // namespace

std::uint32_t texelsOfCells(const lanes::Table& table)
{
  return static_cast<std::uint32_t>((cellsOf(table) + kCellsATexel - 1) / kCellsATexel);
}

std::vector<ProofTexel> proofTexels(const LaneScene& scene)
{
  return Writer(scene).write();
}
}  // namespace gpu_planning_scene::core
