#include "collision/gpu/problem/gpu_margins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "shader_constants.h"

// One buffer has the number of each self pair, the row of each state, and the rows of margins. A margin is rounded up,
// so the device never proves a motion free with too small a margin. Own method.
namespace gpu_planning_scene::core
{
float uploadedMargin(double margin)
{
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kLeast = std::numeric_limits<float>::min();  // a device may read a smaller number as 0
  // Written so that NaN also counts as above the range of a float. The conversion of a number above the range is
  // undefined.
  if (!(margin <= static_cast<double>(std::numeric_limits<float>::max())))
    return kInfinity;
  if (margin <= 0.0)
    return 0.0F;
  const auto rounded = static_cast<float>(margin);
  return std::max(kLeast, static_cast<double>(rounded) < margin ? std::nextafter(rounded, kInfinity) : rounded);
}

void GpuMargins::setPairs(const CollisionProblem& problem)
{
  robots_ = problem.robot.size();
  self_pairs_ = problem.self_pairs;
  numbers_.clear();
}

std::size_t GpuMargins::maxStates() const
{
  const std::size_t words = TexelBuffer::maxBytes() / sizeof(std::uint32_t);
  const std::size_t numbers = robots_ * robots_;
  return words < numbers ? 0 : (words - numbers) / (1 + robots_ + self_pairs_.size());
}

void GpuMargins::write(const Margins& margins, std::size_t begin, std::size_t count)
{
  if (numbers_.empty())
  {
    numbers_.resize(robots_ * robots_);
    auto number = static_cast<std::uint32_t>(robots_);
    for (const auto& [a, b] : self_pairs_)
      numbers_[a * robots_ + b] = numbers_[b * robots_ + a] = number++;
  }
  // Uploads only the rows from the first to the last one that a state of the part refers to.
  const auto rows = margins.rows.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto [first, last] = std::minmax_element(rows, rows + static_cast<std::ptrdiff_t>(count));
  std::vector<std::uint32_t> words = numbers_;
  words.reserve(words.size() + count + (*last - *first + std::size_t{1}) * margins.width);
  for (std::size_t i = begin; i < begin + count; ++i)
    words.push_back(margins.rows[i] - *first);
  for (std::size_t i = *first * margins.width; i < (*last + std::size_t{1}) * margins.width; ++i)
  {
    const float margin = uploadedMargin(margins.values[i]);
    std::uint32_t bits;
    std::memcpy(&bits, &margin, sizeof(bits));
    words.push_back(bits);
  }
  TexelBuffer& upload = uploads_[next_upload_];
  next_upload_ = 1 - next_upload_;
  upload.reserve((words.size() + TEXEL_WORDS - 1) / TEXEL_WORDS * TexelBuffer::kTexelBytes);
  upload.buffer().write(words);
  upload.bindTexture(UNIT_MARGINS);
}
}  // namespace gpu_planning_scene::core
