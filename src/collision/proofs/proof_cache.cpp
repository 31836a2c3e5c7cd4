#include "collision/proofs/proof_cache.h"

#include <cmath>
#include <cstring>
#include <utility>

// A cover is a row of doubles. A table has four cells in a byte. The key determines the variables of a table, so its
// file holds only the cells. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kCellsPerByte = 4;

/// Reads the numbers of a cover.
class NumberReader
{
 public:
  explicit NumberReader(const std::vector<char>& bytes) : bytes_(bytes) {}

  /// The next number. If there is none or it is not finite, returns 0, and the content counts as wrong.
  double next()
  {
    double number = 0.0;
    if (bytes_.size() - at_ < sizeof(number))
    {
      is_good_ = false;
      return 0.0;
    }
    std::memcpy(&number, bytes_.data() + at_, sizeof(number));
    at_ += sizeof(number);
    is_good_ = is_good_ && std::isfinite(number);
    return is_good_ ? number : 0.0;
  }
  double nextLength()
  {
    const double length = next();
    is_good_ = is_good_ && length >= 0.0;
    return length;
  }
  Eigen::Vector3d nextPoint()
  {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }

  /// Whether all numbers were valid, and the last one has been read.
  bool isComplete() const { return is_good_ && at_ == bytes_.size(); }

 private:
  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
  bool is_good_ = true;
};

std::size_t cellCount(const std::vector<TableVariable>& variables)
{
  std::size_t count = 1;
  for (const TableVariable& variable : variables)
    count *= static_cast<std::size_t>(variable.cells);
  return count;
}
}  // namespace

ProofCache::ProofCache(std::filesystem::path folder)
  : files_(std::move(folder), {'G', 'P', 'S', 'P', 'R', 'F', '0', '1'}, ".proof", std::uintmax_t{256} << 20U)
{
}

ProofCache ProofCache::ofUser()
{
  const std::filesystem::path folder = userCacheFolder("GPU_PLANNING_SCENE_PROOF_CACHE");
  return ProofCache(folder.empty() ? folder : folder / "proofs");
}

std::optional<BallCover> ProofCache::cover(const std::string& key) const
{
  const std::optional<std::vector<char>> content = files_.load(key);
  if (!content)
    return {};
  NumberReader numbers(*content);
  BallCover cover;
  cover.layer = numbers.nextLength();
  cover.thickness = numbers.nextLength();
  for (std::size_t level = 0; level < kCoverBalls.size(); ++level)
  {
    const double count = numbers.next();
    if (!(count >= 1.0 && count <= static_cast<double>(kCoverBalls[level])))
      return {};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    {
      CoverBall ball;
      ball.center = numbers.nextPoint();
      ball.outer = numbers.nextLength();
      ball.witness = numbers.nextPoint();
      ball.inner = numbers.nextLength();
      cover.levels[level].push_back(ball);
    }
  }
  if (!numbers.isComplete())
    return {};
  return cover;
}

void ProofCache::store(const std::string& key, const BallCover& cover) const
{
  std::vector<double> numbers = {cover.layer, cover.thickness};
  for (const std::vector<CoverBall>& level : cover.levels)
  {
    numbers.push_back(static_cast<double>(level.size()));
    for (const CoverBall& ball : level)
      numbers.insert(numbers.end(), {ball.center.x(), ball.center.y(), ball.center.z(), ball.outer, ball.witness.x(),
                                     ball.witness.y(), ball.witness.z(), ball.inner});
  }
  std::vector<char> content(numbers.size() * sizeof(double));
  std::memcpy(content.data(), numbers.data(), content.size());
  files_.store(key, content);
}

std::optional<JointTable> ProofCache::table(const std::string& key, const std::vector<TableVariable>& variables) const
{
  const std::optional<std::vector<char>> content = files_.load(key);
  const std::size_t count = cellCount(variables);
  if (!content || content->size() * kCellsPerByte != count)
    return {};
  JointTable table{variables, std::vector<Proof>(count)};
  unsigned wrong = 0;
  for (std::size_t i = 0; i < content->size(); ++i)
  {
    const unsigned byte = static_cast<unsigned char>((*content)[i]);
    wrong |= byte & (byte >> 1U) & 0x55U;  // a cell with both bits set
    for (std::size_t k = 0; k < kCellsPerByte; ++k)
      table.cells[i * kCellsPerByte + k] = static_cast<Proof>((byte >> (2U * k)) & 3U);
  }
  if (wrong != 0)
    return {};
  return table;
}

void ProofCache::store(const std::string& key, const JointTable& table) const
{
  static_assert(static_cast<unsigned>(Proof::None) == 2U, "a cell has two bits");
  std::vector<char> content(table.cells.size() / kCellsPerByte);
  for (std::size_t i = 0; i < table.cells.size(); ++i)
    content[i / kCellsPerByte] =
        static_cast<char>(static_cast<unsigned char>(content[i / kCellsPerByte]) |
                          (static_cast<unsigned>(table.cells[i]) << (2U * (i % kCellsPerByte))));
  files_.store(key, content);
}
}  // namespace gpu_planning_scene::core
