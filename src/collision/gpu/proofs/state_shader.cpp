#include "collision/gpu/proofs/state_shader.h"

#include <algorithm>
#include <cmath>

#include "collision/gpu/proofs/frames_text.h"
#include "collision/gpu/proofs/proof_names.h"
#include "collision/gpu/proofs/proof_texels.h"
#include "shader_constants.h"

// Each step of the lane kernel becomes statements without loops: constants need no loads, and the centres stay in
// registers. On llvmpipe, a load in a loop costs as much as ten tests of a pair.
namespace gpu_planning_scene::core
{
namespace
{
std::string packedPair(const lanes::SelfPair& pair)
{
  return std::to_string(pair.a << PAIR_OTHER_BITS | pair.b) + "u";
}

/// The place of a value among the cells of a table, in cells.
std::string placeText(const lanes::TableAxis& axis)
{
  const std::string value = valueName(axis.variable);
  return "(" + (axis.wraps ? "turned(" + value + ")" : value) + " - " + exactText(axis.lower) + "lf) * " +
         exactText(axis.cells_per_unit) + "lf";
}

/// Looks a pair up in its table.
std::string tableLines(const LaneScene& scene, const lanes::Table& table, std::uint32_t cells)
{
  const bool two = table.variables == 2;
  std::string text = "  proof = lookUp(" + std::to_string(cells) + "u, dvec2(" + placeText(table.variable[0]) + ", " +
                     (two ? placeText(table.variable[1]) : "0.0lf") + "), uvec2(" +
                     std::to_string(table.variable[0].cells) + "u, " +
                     std::to_string(two ? table.variable[1].cells : 1) + "u));\n";
  return text + "  hit = proof == TABLE_COLLIDING ? " + packedPair(scene.model().self_pairs[table.pair]) +
         " : hit;\n  open |= proof == TABLE_NONE ? " + std::to_string(1U << table.pair % 32) + "u : 0u;\n";
}

/// Pairs with tables have the first numbers. Up to 32 of them have their bits in a word.
std::string tablesText(const LaneScene& scene)
{
  const lanes::Model& model = scene.model();
  std::string text;
  std::uint32_t cells = RECORDS_HEADER;
  for (std::uint32_t t = 0; t < model.tables.count; ++t)
  {
    if (t % 32 == 0)
      text += "  open = 0u;\n";
    text += tableLines(scene, model.tables[t], cells);
    cells += texelsOfCells(model.tables[t]);
    if (t % 32 == 31 || t + 1 == model.tables.count)
      text += "  addOpenSelfPairs(state, " + std::to_string(t - t % 32) + "u, open);\n";
  }
  return text;
}

std::string squaredText(std::uint32_t a, std::uint32_t b)
{
  return "squaredBetween(" + centerName(a) + ", " + centerName(b) + ")";
}

/// Tests the pairs of a group by their enclosing balls.
std::string groupLines(const LaneScene& scene, const lanes::SelfGroup& group)
{
  const lanes::Model& model = scene.model();
  const bool is_tested = std::isfinite(group.reach);
  std::string text;
  if (is_tested)
    text += "  for (bool near = !isBeyond(" + squaredText(group.centers[0], group.centers[1]) + ", " +
            number(group.reach) + "); near; near = false)\n  {\n";
  constexpr std::uint32_t kWordBits = 32;
  for (std::uint32_t first = group.first; first < group.end; first += kWordBits)
  {
    text += "  open = 0u;\n";
    for (std::uint32_t p = first; p < std::min(first + kWordBits, group.end); ++p)
    {
      const lanes::SelfPair& pair = model.self_pairs[p];
      text += "  open |= isBeyond(" + squaredText(pair.a, pair.b) + ", " + number(enclosingSum(model, pair)) +
              ") ? 0u : " + std::to_string(1U << (p - first)) + "u;\n";
    }
    text += "  addOpenSelfPairs(state, " + std::to_string(first) + "u, open);\n";
  }
  return text + (is_tested ? "  }\n" : "");
}

std::string pairsText(const LaneScene& scene)
{
  const lanes::Model& model = scene.model();
  std::string text;
  for (std::uint32_t g = 0; g < model.self_groups.count; ++g)
    if (scene.isOfLinks(model.self_groups[g]))
      text += groupLines(scene, model.self_groups[g]);
  return text;
}

/// The world and the links that have pairs with it.
std::string worldText(const LaneScene& scene)
{
  std::string text;
  for (const std::uint32_t center : scene.linkCenters())
    if (center < scene.model().instances.count)
      text += "  proveWorldPairs(state, records, " + std::to_string(center) + "u, " + centerName(center) + ");\n";
  return text;
}
}  // namespace

std::string stateShader(const LaneScene& scene, std::size_t attached_centers)
{
  const std::size_t centers = scene.model().instances.count + scene.model().clusters.count;
  const std::string head =
      "#define ATTACHED " + std::to_string(attached_centers != 0 ? 1 : 0) + "\n#define CENTERS " +
      std::to_string(attached_centers != 0 ? attached_centers : std::max<std::size_t>(1, centers)) +
      "u\n"
      "#include \"shader_constants.h\"\n"
      "layout(local_size_x = GROUP_SIZE) in;\n"
      "#include \"common/invocation.glsl\"\n"
      "#include \"proofs/state_proofs.glsl\"\n";
  const std::string values = R"(
// A pair that collides, VERDICT_UNDECIDED or VERDICT_FREE.
uint proveState(uint state, Records records)
{
)" + valuesText(scene) + R"(  if (!bounded)
    return VERDICT_UNDECIDED;
)";
  const std::string tables = R"(#if !MARGINS
  uint open, proof;
  uint hit = VERDICT_FREE;
)" + tablesText(scene) + R"(  if (hit != VERDICT_FREE)
    return hit;
#endif
)";
  const std::string frames = R"(#if CENTER_ARRAY
  vec3 centers[CENTERS];
  centers[0] = vec3(0.0);
#endif
  bool placed = true;
)" + framesText(scene) + R"(  if (!placed)
    return VERDICT_UNDECIDED;
)";
  const std::string pairs = "#if !MARGINS\n" + pairsText(scene) + "#endif\n" + worldText(scene);
  return head + values + tables + frames + pairs +
         "#if CENTER_ARRAY\n"
         "  proveAttached(state, records, centers);\n"
         "#endif\n"
         "  return VERDICT_FREE;\n"
         "}\n"
         "#include \"proofs/state_main.glsl\"\n";
}
}  // namespace gpu_planning_scene::core
