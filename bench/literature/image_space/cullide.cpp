#include "literature/image_space/cullide.h"

#include <algorithm>
#include <numeric>

#include <epoxy/gl.h>

// N. K. Govindaraju, S. Redon, M. C. Lin, D. Manocha: CULLIDE: interactive collision detection between complex models
// in large environments using graphics hardware, 2003.
//
// Idea: a part of a shape that no point of the other shape hides from the viewer does not collide with it. So it
// leaves the potentially colliding set. First the other shape is drawn into the depth buffer. Then each part is
// compared with it: a fragment at the same depth or behind is hidden. Both orders and each view are tried, for whole
// shapes, then for parts of kPartSize triangles, then for single triangles, until nothing leaves the set. Exact tests
// decide on the triangles that are left. The paper's first level, boxes of whole shapes, is the test of bounding
// boxes by which views are cropped. The hidden fragments set words of a buffer in place of occlusion queries, one for
// each part.
//
// Domain: all meshes, also open ones. Only surfaces are compared, so containment is missed.
//
// Failures: a part that covers the centre of no pixel has no fragment, so it counts as visible and is discarded. This
// concerns triangles that are smaller than a pixel, and triangles of any size that are parallel to the view: three
// views along the axes of a box discard all of its faces. Nor do fragments show the depth between the centres of
// pixels. So contacts that are smaller than a pixel are missed, and each further view misses more. Where the
// triangles are as small as pixels, even deep overlaps are missed: a triangle leaves the set once the triangles that
// hid it have left it. There are no false hits.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kPartSize = 32;  // triangles

/// Splits parts of `size` triangles into parts of `smaller_size`.
std::vector<std::uint32_t> smallerParts(const std::vector<std::uint32_t>& parts, std::size_t size,
                                        std::size_t smaller_size, std::size_t triangles)
{
  std::vector<std::uint32_t> result;
  for (const std::uint32_t part : parts)
  {
    const std::size_t end = std::min(triangles, (part + 1) * size);
    for (std::size_t first = part * size; first < end; first += smaller_size)
      result.push_back(static_cast<std::uint32_t>(first / smaller_size));
  }
  return result;
}
}  // namespace

Cullide::Cullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                 const ImageOptions& options)
  : Cullide(a, b, options, makeTrianglePainter)
{
}

Cullide::Cullide(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                 const ImageOptions& options, const MakePainter& make_painter)
  : ImageSpaceMethod(a, b, options)
{
  run([&] { painter_ = make_painter(device()); });
}

Cullide::~Cullide()
{
  run([this] { painter_.reset(); });
}

WorkCounts Cullide::work() const
{
  WorkCounts counts = ImageSpaceMethod::work();
  counts.emplace_back("rounds", rounds_);
  counts.emplace_back("triangle tests", triangle_tests_.tests());
  return counts;
}

std::vector<std::uint8_t> Cullide::draw(const std::vector<PlacedPair>& pairs)
{
  glDisable(GL_CULL_FACE);
  glDisable(GL_STENCIL_TEST);
  std::size_t size = std::max(shape(0).triangleCount(), shape(1).triangleCount());
  std::vector<Survivors> survivors(pairs.size(),
                                   Survivors{std::vector<std::uint32_t>{0}, std::vector<std::uint32_t>{0}});
  prune(size, survivors);
  for (const std::size_t smaller : {kPartSize, std::size_t{1}})
  {
    if (smaller >= size)
      continue;
    for (Survivors& pair : survivors)
      for (unsigned number = 0; number < 2; ++number)
        pair[number] = smallerParts(pair[number], size, smaller, shape(number).triangleCount());
    size = smaller;
    prune(size, survivors);
  }

  std::vector<std::uint8_t> answers;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    std::array<std::vector<std::uint32_t>, 2> triangles;
    for (unsigned number = 0; number < 2; ++number)
      for (const std::uint32_t place : survivors[i][number])
        triangles[number].push_back(shape(number).order()[place]);
    answers.push_back(
        triangle_tests_.collide(*shape(0).mesh(), triangles[0], *shape(1).mesh(), triangles[1], pairs[i].b_in_a) ? 1
                                                                                                                 : 0);
  }
  return answers;
}

/// Removes parts that are fully visible in a view, until no part is. If one shape has no parts left, the pair is free.
void Cullide::prune(std::size_t part_size, std::vector<Survivors>& survivors)
{
  std::vector<std::size_t> changed(survivors.size());
  std::iota(changed.begin(), changed.end(), 0U);
  while (true)
  {
    changed.erase(
        std::remove_if(changed.begin(), changed.end(),
                       [&](std::size_t pair) { return survivors[pair][0].empty() || survivors[pair][1].empty(); }),
        changed.end());
    if (changed.empty())
      return;
    rounds_ += 1.0;
    std::array<PartList, 2> lists;
    for (unsigned number = 0; number < 2; ++number)
    {
      lists[number].part_size = std::min(part_size, shape(number).triangleCount());
      for (const std::size_t pair : changed)
        for (const std::uint32_t part : survivors[pair][number])
          for (std::size_t view = 0; view < views(); ++view)
            lists[number].entries.push_back({static_cast<std::uint32_t>(pair * views() + view), part});
    }
    const std::vector<std::uint8_t> stays = everyView(hiddenParts(lists), views());
    auto next = stays.begin();
    std::vector<std::uint8_t> smaller(survivors.size(), 0);
    for (unsigned number = 0; number < 2; ++number)
      for (const std::size_t pair : changed)
      {
        std::vector<std::uint32_t>& parts = survivors[pair][number];
        const auto end = std::remove_if(parts.begin(), parts.end(), [&](std::uint32_t) { return *next++ == 0; });
        smaller[pair] |= end != parts.end() ? 1 : 0;
        parts.erase(end, parts.end());
      }
    changed.erase(std::remove_if(changed.begin(), changed.end(), [&](std::size_t pair) { return smaller[pair] == 0; }),
                  changed.end());
  }
}

/// For each entry of the first list, then of the second: whether a point of it is hidden by the parts of the other
/// list.
std::vector<std::uint32_t> Cullide::hiddenParts(const std::array<PartList, 2>& lists)
{
  atlas().clearHits(lists[0].entries.size() + lists[1].entries.size());
  for (unsigned number = 0; number < 2; ++number)
  {
    atlas().clearDepth();
    glDepthFunc(GL_LEQUAL);
    drawParts(1 - number, lists[1 - number], false, 0);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GEQUAL);
    drawParts(number, lists[number], true, number == 0 ? 0 : lists[0].entries.size());
  }
  return atlas().hits();
}

void Cullide::drawParts(unsigned number, const PartList& list, bool mark, std::size_t first_hit)
{
  painter_->draw(shape(number), number, list, mark, first_hit);
  countPass(list.entries.size() * list.part_size);
}
}  // namespace gpu_planning_scene::core::literature
