#include "collision/gpu/gpu_proofs.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "collision/geometry/outward_rounding.h"
#include "shader_constants.h"

// Each cover takes the same number of texels, so that a shader finds it without a table. Radii are rounded so that
// proofs stay true. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::array<std::size_t, 2> kLevelBalls = {COVER_COARSE_BALLS, COVER_FINE_BALLS};
static_assert(kCoverBalls.size() == kLevelBalls.size() + 1 && kCoverBalls[1] == COVER_COARSE_BALLS &&
                  kCoverBalls[2] == COVER_FINE_BALLS,
              "the levels of the shaders; the enclosing ball is not used");
static_assert(COVER_TEXELS == 1 + 2 * COVER_BALLS, "the layout of shaders/broad_phase/covers.glsl");

using CoverTexel = std::array<float, 4>;

/// At most x, which is at least 0, and itself at least 0.
float radiusBelow(double x)
{
  return std::max(0.0F, floatBelow(x));
}

CoverTexel coverTexel(const Eigen::Vector3d& point, float radius)
{
  return {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z()), radius};
}

/// The first texel of a cover.
CoverTexel headOf(const BallCover& cover, std::uint32_t bits)
{
  CoverTexel made = {floatAbove(cover.layer), radiusBelow(cover.thickness), 0.0F, 0.0F};
  std::memcpy(&made[2], &bits, sizeof(bits));
  return made;
}

/// The largest coordinates of the points of a shape, for which the error bounds of the shader hold.
Eigen::Vector3d largestCoordinates(const Tessellation& tessellation)
{
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : tessellation.mesh->vertices)
    far = far.cwiseMax(vertex.cwiseAbs());
  // The shader's bounds cover twice the size of the shape, and a millionth of a metre in any case.
  return 2.0 * far + Eigen::Vector3d::Constant(1e-6);
}

void appendCover(const BallCover& cover, const Eigen::Vector3d& far, std::vector<CoverTexel>& texels)
{
  bool same_centers = true;
  bool is_near = true;
  const std::size_t first = texels.size();
  texels.emplace_back();
  for (std::size_t level = 0; level < kLevelBalls.size(); ++level)
    for (std::size_t i = 0; i < kLevelBalls[level]; ++i)
    {
      const std::vector<CoverBall>& balls = cover.levels[level + 1];
      const CoverBall& ball = balls[std::min(i, balls.size() - 1)];
      texels.push_back(coverTexel(ball.center, floatAbove(ball.outer)));
      texels.push_back(coverTexel(ball.witness, radiusBelow(ball.inner)));
      same_centers = same_centers && ball.witness == ball.center;
      is_near = is_near && (ball.center.cwiseAbs().array() <= far.array()).all() &&
                (ball.witness.cwiseAbs().array() <= far.array()).all();
    }
  texels[first] = headOf(cover, (same_centers ? COVER_SAME_CENTERS : 0U) | (is_near ? 0U : COVER_UNUSABLE));
}

using TableTexel = std::array<std::uint32_t, TEXEL_WORDS>;
static_assert(static_cast<int>(Proof::Apart) == TABLE_APART && static_cast<int>(Proof::Colliding) == TABLE_COLLIDING &&
                  static_cast<int>(Proof::None) == TABLE_NONE,
              "the verdicts of the shaders");
static_assert(TABLE_CELLS_A_WORD * TABLE_CELL_BITS == 32, "a word of cells");

void appendAxis(const TableVariable& variable, std::uint32_t stride, std::vector<TableTexel>& texels)
{
  const std::array<double, 2> range = {variable.lower, 1.0 / variable.cell_width};
  TableTexel texel;
  std::memcpy(texel.data(), range.data(), sizeof(range));
  texels.push_back(texel);
  texels.push_back({static_cast<std::uint32_t>(variable.variable), variable.wraps ? 1U : 0U,
                    static_cast<std::uint32_t>(variable.cells), stride});
}

void appendTable(const JointTable& table, std::vector<TableTexel>& texels)
{
  const auto stride = static_cast<std::uint32_t>(table.variables.back().cells);
  appendAxis(table.variables.front(), table.variables.size() == 1 ? 1U : stride, texels);
  // The second variable of a table with one variable: the same one, without a step from cell to cell.
  appendAxis(table.variables.back(), table.variables.size() == 1 ? 0U : 1U, texels);
  const std::size_t first = texels.size();
  constexpr std::size_t kCellsATexel = std::size_t{TABLE_CELLS_A_WORD} * TEXEL_WORDS;
  texels.resize(first + (table.cells.size() + kCellsATexel - 1) / kCellsATexel);
  for (std::size_t i = 0; i < table.cells.size(); ++i)
    texels[first + i / kCellsATexel][i / TABLE_CELLS_A_WORD % TEXEL_WORDS] |=
        static_cast<std::uint32_t>(table.cells[i]) << TABLE_CELL_BITS * (i % TABLE_CELLS_A_WORD);
}
}  // namespace

void GpuProofs::set(const RobotProofs& proofs, const CollisionProblem& problem)
{
  clear();
  std::vector<CoverTexel> texels;
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    appendCover(*proofs.covers[i], largestCoordinates(problem.tessellations[problem.robot[i].tree]), texels);
  covers_.reserve(texels.size() * sizeof(CoverTexel));
  covers_.buffer().write(texels);
  have_tables_ = setTables(proofs, problem);
  exist_ = true;
}

/// Returns whether there is a table.
bool GpuProofs::setTables(const RobotProofs& proofs, const CollisionProblem& problem)
{
  const std::size_t robots = problem.robot.size();
  std::vector<TableTexel> texels((robots * robots + TEXEL_WORDS - 1) / TEXEL_WORDS);
  const auto set_table = [&](std::size_t a, std::size_t b)
  {
    const std::size_t place = a * robots + b;
    texels[place / TEXEL_WORDS][place % TEXEL_WORDS] = static_cast<std::uint32_t>(texels.size());
  };
  bool any = false;
  for (std::size_t p = 0; p < proofs.tables.size(); ++p)
  {
    if (!proofs.tables[p])
      continue;
    const auto [a, b] = problem.self_pairs[p];
    set_table(a, b);
    set_table(b, a);
    appendTable(*proofs.tables[p], texels);
    any = true;
  }
  tables_.reserve(texels.size() * sizeof(TableTexel));
  tables_.buffer().write(texels);
  return any;
}

void GpuProofs::bind() const
{
  covers_.bindTexture(UNIT_COVERS);
  tables_.bindTexture(UNIT_TABLES);
}
}  // namespace gpu_planning_scene::core
