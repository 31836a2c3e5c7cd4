// Every shader, with all definitions that the program uses, passes Khronos' reference compiler (glslang) and the
// validator of SPIR-V. `precise` must reach all operations of its statement: they carry NoContraction in SPIR-V. No
// shader has a loop over constant places of a storage buffer, which NVIDIA's compiler refuses.

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "gpu/program.h"
#include "lanes/compute_shaders.h"
#include "lanes/unrolled_accesses.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::string kShaders = GPS_SOURCE_DIR "/shaders";

std::string contents(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The first comment after the definitions.
std::string titleOf(const std::string& shader)
{
  std::istringstream lines(shader);
  std::string title;
  for (std::string line; std::getline(lines, line) && title.empty();)
    if (line.rfind("// ", 0) == 0)
      title = line;
  return title;
}

/// Compiles shaders in a temporary folder.
class ShaderText : public testing::Test
{
 protected:
  void SetUp() override
  {
    for (const char* tool : {"glslangValidator --version", "spirv-val --version", "spirv-dis --version"})
      if (std::system((std::string(tool) + " > /dev/null 2>&1").c_str()) != 0)
        GTEST_SKIP() << "Install Debian's glslang-tools and spirv-tools for this test.";
    std::string name = testing::TempDir() + "/shader_text_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override
  {
    if (!folder_.empty())
      std::filesystem::remove_all(folder_);
  }

  /// Returns the disassembly of a valid shader. `stage`: comp, vert or frag. Adds a failure and returns an empty text
  /// otherwise.
  std::string disassembly(const std::string& text, const std::string& stage)
  {
    const std::string file = folder_ + "/shader";
    std::ofstream(file) << text;
    for (const std::string& command :
         {"timeout 60 glslangValidator -G -g -S " + stage + " " + file + " -o " + file + ".spv",
          "spirv-val --target-env opengl4.5 " + file + ".spv", "spirv-dis " + file + ".spv -o " + file + ".text"})
      if (std::system((command + " > " + file + ".log 2>&1").c_str()) != 0)
      {
        ADD_FAILURE() << titleOf(text) << ": " << command << "\n" << contents(file + ".log");
        return {};
      }
    return contents(file + ".text");
  }

  std::string folder_;
};

/// The statements that compute a `precise` variable: pairs of their first and last line, from 1 on.
std::vector<std::array<int, 2>> preciseStatements(const std::string& shader)
{
  static const std::regex declaration("^\\s*precise\\s+(const\\s+)?\\w+\\s+(\\w+)(\\[.*\\])?\\s*([=;]).*");
  static const std::regex assignment("^\\s*(\\w+)(\\[[^=]*\\])?\\s*=[^=].*");
  std::vector<std::array<int, 2>> statements;
  std::set<std::string> names;
  std::istringstream lines(shader);
  std::string line;
  bool open = false;
  for (int number = 1; std::getline(lines, line); ++number)
  {
    line = line.substr(0, line.find("//"));
    if (!line.empty() && line[0] == '}')
      names.clear();
    std::smatch match;
    if (open)
      statements.back()[1] = number;
    else if (line.find("precise") != std::string::npos && std::regex_match(line, match, declaration))
    {
      names.insert(match[2]);
      open = match[4] == "=";
    }
    else if (!names.empty() && std::regex_match(line, match, assignment))
      open = names.count(match[1]) > 0;
    if (open && (statements.empty() || statements.back()[1] < number))
      statements.push_back({number, number});
    if (line.find(';') != std::string::npos)
      open = false;
  }
  return statements;
}

/// The lines of `precise` statements with an operation that lacks NoContraction, or with a call of a function, into
/// which `precise` does not reach.
std::vector<std::string> loosePreciseLines(const std::string& shader, const std::string& disassembly)
{
  static const std::set<std::string> operations = {"OpFAdd",
                                                   "OpFSub",
                                                   "OpFMul",
                                                   "OpFDiv",
                                                   "OpFNegate",
                                                   "OpVectorTimesScalar",
                                                   "OpMatrixTimesVector",
                                                   "OpVectorTimesMatrix",
                                                   "OpMatrixTimesMatrix"};
  const std::vector<std::array<int, 2>> statements = preciseStatements(shader);
  std::set<std::string> exact;
  std::vector<std::string> loose;
  std::istringstream lines(disassembly);
  int number = 0;
  for (std::string line; std::getline(lines, line);)
  {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "OpDecorate" && third == "NoContraction")
      exact.insert(second);
    else if (first == "OpLine")
      number = std::stoi(third);
    else if (second == "=" && (third == "OpFunctionCall" || (operations.count(third) > 0 && exact.count(first) == 0)))
      for (const auto& [begin, end] : statements)
        if (number >= begin && number <= end)
          loose.push_back("line " + std::to_string(number) + ": " + third);
  }
  return loose;
}

TEST_F(ShaderText, PassesTheReferenceCompiler)
{
  const std::set<std::string> texts = computeShaders(kShaders);
  std::size_t precise = 0;
  for (const std::string& text : texts)
  {
    const std::string assembly = disassembly(text, "comp");
    precise += preciseStatements(text).size();
    for (const std::string& line : loosePreciseLines(text, assembly))
      ADD_FAILURE() << titleOf(text) << ": `precise` does not reach " << line;
  }
  EXPECT_GT(precise, 100U);
  // No kernel is left out.
  std::string all;
  for (const std::string& text : texts)
    all += text;
  for (const auto& file : std::filesystem::recursive_directory_iterator(kShaders))
    if (file.path().extension() == ".comp")
      EXPECT_NE(all.find(titleOf(contents(file.path()))), std::string::npos) << file.path();
  for (const std::string stage : {"vert", "frag"})
    disassembly("#version 450\n" + readShader(kShaders, "draw/draw." + stage), stage);
}

TEST_F(ShaderText, FindsAnOperationThatPreciseDoesNotReach)
{
  const auto loose = [&](const std::string& body)
  {
    const std::string text =
        "#version 450\n"
        "layout(local_size_x = 1) in;\n"
        "layout(std430, binding = 0) buffer Values { float values[]; };\n"
        "float product(float a, float b)\n"
        "{\n"
        "  return a * b;\n"
        "}\n"
        "void main()\n"
        "{\n"
        "  precise float r;\n" +
        body + "  values[0] = r;\n}\n";
    return loosePreciseLines(text, disassembly(text, "comp")).size();
  };
  EXPECT_EQ(loose("  r = values[1] * values[2] +\n      values[3];\n"), 0U);
  EXPECT_EQ(loose("  r = product(values[1], values[2]) + values[3];\n"), 1U);
}

TEST(UnrolledAccesses, NoShaderHasOne)
{
  const std::set<std::string> texts = computeShaders(kShaders);
  EXPECT_GT(texts.size(), 30U);
  for (const std::string& text : texts)
    for (const std::string& access : unrolledAccesses(text))
      ADD_FAILURE() << titleOf(text) << ": NVIDIA's compiler refuses " << access << "; write one statement each";
}

/// The accesses in the body of main().
std::vector<std::string> unrolledIn(const std::string& body)
{
  return unrolledAccesses(
      "#define VALUES numbers\n"
      "layout(location = 0) uniform uint count;\n"
      "layout(std430, binding = 0) buffer Numbers { uint numbers[]; };\n"
      "shared uint few[3];\n"
      "void store(uint at, uint value) { numbers[FIRST + at] = value; }\n"
      "void storeTwice(uint value, uint at) { store(at, value); store(at + 1u, value); }\n"
      "void main() {\n" +
      body + "\n}\n");
}

TEST(UnrolledAccesses, AreFoundInEachKindOfLoop)
{
  using Lines = std::vector<std::string>;
  EXPECT_EQ(unrolledIn("for (uint i = 0u; i < 3u; ++i) numbers[FIRST + i] = 1u;"), Lines{"line 8: numbers[FIRST + i]"});
  EXPECT_EQ(unrolledIn("for (int i = 2; i >= 0; --i) { few[i] = 0u; VALUES[i] += few[i]; }"),
            Lines{"line 8: numbers[i]"});
  EXPECT_EQ(
      unrolledIn("for (int i = 0; i < SIDE; i++)\nfor (int k = i; k < SIDE; k++)\natomicAdd(numbers[SIDE * i + k], "
                 "1u);"),
      Lines{"line 10: numbers[SIDE * i + k]"});
  EXPECT_EQ(
      unrolledIn("for (uint i = 0u; i < 3u; ++i) { const uint at = 2u * i; if (few[i] > 0u) numbers[at + 1u] = 1u; }"),
      Lines{"line 8: numbers[at + 1u]"});
  EXPECT_EQ(unrolledIn("uint i = 0u; for (; i < 3u; ++i) numbers[i] = 1u;"), Lines{"line 8: numbers[i]"});
  EXPECT_EQ(unrolledIn("uint i = 0u; while (i < 3u) numbers[i++] = 1u;"), Lines{"line 8: numbers[i++]"});
  EXPECT_EQ(unrolledIn("uint i = 0u; do { numbers[uint(i)] = 1u; ++i; } while (i < 3u);"),
            Lines{"line 8: numbers[uint(i)]"});
  EXPECT_EQ(unrolledIn("for (uint i = 0u; i < 3u; ++i) few[0] = numbers[FIRST + i];"),
            Lines{"line 8: numbers[FIRST + i]"});
  EXPECT_EQ(unrolledIn("for (uint i = 0u; i < 3u; ++i) store(2u * i, 1u);"), Lines{"line 8: store(2u * i, 1u)"});
  EXPECT_EQ(unrolledIn("for (uint i = 0u; i < 3u; ++i) storeTwice(1u, i);").size(), 1U);
}

TEST(UnrolledAccesses, AtPlacesThatAreNotConstantAreAllowed)
{
  for (const char* body : {
           "numbers[FIRST] = 0u; numbers[FIRST + 1u] = 0u; store(2u, 0u);",
           "for (uint i = 0u; i < count; ++i) numbers[i] = 0u;",
           "for (uint i = count; i < 3u; ++i) numbers[i] = 0u;",
           "for (uint i = 0u; i < 3u; ++i) numbers[count + i] = 0u;",
           "for (uint i = 0u; i < 3u; ++i) { const uint at = gl_LocalInvocationID.x + i; numbers[at] = 0u; }",
           "for (uint i = 0u; i < 3u; ++i) { few[i] = 0u; numbers[FIRST] += few[i]; }",
           "for (uint i = 0u; i < 3u; ++i) store(count, i);",
           "{ for (uint i = 0u; i < 3u; ++i) few[i] = 0u; } const uint i = count; numbers[i] = 0u;",
       })
    EXPECT_EQ(unrolledIn(body), std::vector<std::string>()) << body;
}
}  // namespace
}  // namespace gpu_planning_scene::core
