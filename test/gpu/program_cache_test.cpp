// The program cache saves time. Damage to the cache changes no answer.

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "gpu/program_cache.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

constexpr char kShader[] =
    "layout(local_size_x = 1) in;\nlayout(location = 3) uniform uint factor;\n"
    "layout(std430, binding = 0) buffer Result { uint result; };\nvoid main() { result = 7u * factor; }\n";
constexpr std::size_t kHeaderBytes = 32;
constexpr std::size_t kFormatBytes = 4;

class ProgramCacheTest : public testing::Test
{
 protected:
  void SetUp() override
  {
    std::string name = (fs::temp_directory_path() / "gpu_planning_scene_cache_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    home_ = name;
    setenv("XDG_CACHE_HOME", name.c_str(), 1);
    unsetenv("GPU_PLANNING_SCENE_PROGRAM_CACHE");
    shaders_.write("seven.comp", kShader);
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    if (formats == 0)
      GTEST_SKIP() << "the device has no program binaries";
  }
  void TearDown() override { fs::remove_all(home_); }

  void expectSeven() const
  {
    const Program program(shaders_.path(), "seven.comp");
    Buffer buffer(4);
    buffer.bindStorage(0);
    program.set(3, 6);
    program.dispatch(1);
    std::uint32_t result = 0;
    buffer.read(&result, sizeof(result));
    EXPECT_EQ(result, 42U);
  }

  static bool isCached(const std::string& text = kShader)
  {
    const std::uint32_t program = loadCachedProgram("#version 450\n" + text);
    if (program != 0)
      glDeleteProgram(program);
    return program != 0;
  }

  fs::path folder() const { return home_ / "gpu_planning_scene"; }
  fs::path onlyEntry() const
  {
    const std::vector<fs::path> files(fs::directory_iterator(folder()), fs::directory_iterator{});
    EXPECT_EQ(files.size(), 1U);
    return files.at(0);
  }
  static std::vector<char> read(const fs::path& path)
  {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void write(const fs::path& path, const std::vector<char>& bytes)
  {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  EglContext context_{"auto"};
  ShaderFolder shaders_;
  fs::path home_;
};

TEST_F(ProgramCacheTest, HoldsOnlyProgramsThatWereCompiledBefore)
{
  EXPECT_FALSE(isCached());
  expectSeven();
  EXPECT_TRUE(isCached());
  EXPECT_FALSE(isCached(std::string(kShader) + "\n"));
  expectSeven();  // from the cache
}

TEST_F(ProgramCacheTest, DamagedEntriesAreNeverUsedAndAreReplaced)
{
  expectSeven();
  const fs::path entry = onlyEntry();
  const std::vector<char> good = read(entry);
  const std::uint64_t seed = 5;
  std::cout << "seed " << seed << std::endl;
  std::mt19937_64 random(seed);
  std::vector<std::vector<char>> damaged = {{}, {'x'}, {good.begin(), good.end() - 1}, good};
  damaged.back().push_back('x');
  for (int i = 0; i < 200; ++i)
  {
    damaged.push_back(good);
    // Half of the damaged bytes are in the header, where every byte matters.
    const std::size_t at = random() % (i % 2 == 0 ? kHeaderBytes : good.size());
    damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ (1 << random() % 8));
  }
  for (const std::vector<char>& bytes : damaged)
  {
    write(entry, bytes);
    EXPECT_FALSE(isCached());
  }
  for (std::size_t i = 0; i < 8; ++i)
  {
    write(entry, damaged[i]);
    expectSeven();
    EXPECT_TRUE(isCached());
  }
}

/// Intact entries whose binary the driver does not accept, for example a binary of another version of the driver.
TEST_F(ProgramCacheTest, EntriesThatTheDriverRefusesAreReplaced)
{
  expectSeven();
  const fs::path entry = onlyEntry();
  std::vector<char> bytes = read(entry);
  std::uint64_t key_bytes = 0;
  std::memcpy(&key_bytes, &bytes[8], 8);
  for (std::size_t i = kHeaderBytes + key_bytes + kFormatBytes; i < bytes.size(); ++i)
    bytes[i] = 0;
  std::memset(&bytes[24], 0, 8);
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (const char byte : bytes)
    sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  std::memcpy(&bytes[24], &sum, 8);
  write(entry, bytes);
  EXPECT_FALSE(isCached());
  expectSeven();
  EXPECT_TRUE(isCached());
}

TEST_F(ProgramCacheTest, IsNotNeeded)
{
  setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
  expectSeven();
  EXPECT_FALSE(fs::exists(folder()));
  unsetenv("GPU_PLANNING_SCENE_PROGRAM_CACHE");
  write(folder(), {'x'});  // a file where the folder should be
  expectSeven();
  EXPECT_FALSE(isCached());
}

TEST_F(ProgramCacheTest, RemovesTheOldestEntriesPastItsSize)
{
  fs::create_directories(folder());
  const auto now = fs::file_time_type::clock::now();
  for (int i = 0; i < 5; ++i)
  {
    const fs::path file = folder() / ("old_" + std::to_string(i));
    write(file, {});
    fs::resize_file(file, 16U << 20U);
    fs::last_write_time(file, now - std::chrono::hours(10 - i));
  }
  expectSeven();
  EXPECT_FALSE(fs::exists(folder() / "old_0"));
  EXPECT_FALSE(fs::exists(folder() / "old_1"));
  EXPECT_TRUE(fs::exists(folder() / "old_2"));
  EXPECT_TRUE(fs::exists(folder() / "old_4"));
  EXPECT_TRUE(isCached());
}
}  // namespace
}  // namespace gpu_planning_scene::core
