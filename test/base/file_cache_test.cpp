// Files of the user's cache are found again, and damaged or foreign ones never are. Failures of the file system are no
// errors.

#include "base/file_cache.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

constexpr FileCache::Magic kMagic = {'T', 'E', 'S', 'T', 'T', 'E', 'S', '1'};
constexpr std::uintmax_t kMostBytes = 1U << 20U;

std::vector<char> bytesOf(const std::string& text)
{
  return {text.begin(), text.end()};
}

class FileCacheTest : public testing::Test
{
 protected:
  void SetUp() override
  {
    std::string name = (fs::temp_directory_path() / "gpu_planning_scene_files_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  FileCache cache(const fs::path& folder) const { return {folder, kMagic, ".test", kMostBytes}; }
  FileCache cache() const { return cache(folder_); }

  fs::path onlyFile() const
  {
    const std::vector<fs::path> files(fs::directory_iterator(folder_), fs::directory_iterator{});
    EXPECT_EQ(files.size(), 1U);
    return files.at(0);
  }
  static std::string read(const fs::path& path)
  {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void write(const fs::path& path, const std::string& bytes)
  {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  fs::path folder_;
};

TEST_F(FileCacheTest, FindsTheNewestContentOfAKey)
{
  EXPECT_FALSE(cache().load("key"));
  cache().store("key", bytesOf("first"));
  cache().store("other key", bytesOf("other"));
  cache().store("key", bytesOf("second"));
  EXPECT_EQ(cache().load("key"), bytesOf("second"));
  EXPECT_EQ(cache().load("other key"), bytesOf("other"));
  EXPECT_FALSE(cache().load("ke"));
  EXPECT_FALSE(cache().load("keyy"));
}

TEST_F(FileCacheTest, NeverFindsADamagedFile)
{
  cache().store("key", bytesOf("content"));
  const fs::path file = onlyFile();
  const std::string good = read(file);
  std::vector<std::string> damaged = {good + 'x', good + good};
  for (std::size_t i = 0; i < good.size(); ++i)
  {
    damaged.push_back(good.substr(0, i));
    for (int bit = 0; bit < 8; ++bit)
    {
      damaged.push_back(good);
      damaged.back()[i] = static_cast<char>(good[i] ^ (1 << bit));
    }
  }
  for (const std::string& bytes : damaged)
  {
    write(file, bytes);
    ASSERT_FALSE(cache().load("key")) << "file of " << bytes.size() << " bytes";
  }
  cache().store("key", bytesOf("content"));
  EXPECT_EQ(read(file), good);
}

TEST_F(FileCacheTest, NeverFindsTheFileOfAnotherKeyOrVersion)
{
  cache().store("key 1", bytesOf("content"));
  const fs::path file = onlyFile();
  const std::string other = read(file);
  fs::remove(file);
  cache().store("key 2", bytesOf("content"));
  write(onlyFile(), other);  // as if both keys had the same hash
  EXPECT_FALSE(cache().load("key 2"));
  cache().store("key 2", bytesOf("content"));
  EXPECT_FALSE(FileCache(folder_, {'T', 'E', 'S', 'T', 'T', 'E', 'S', '2'}, ".test", kMostBytes).load("key 2"));
  EXPECT_TRUE(cache().load("key 2"));
}

TEST_F(FileCacheTest, AFailureOfTheFileSystemIsNoError)
{
  const fs::path file = folder_ / "file";
  write(file, "x");
  for (const fs::path& unusable : {file, file / "below", fs::path("/proc/nothing"), fs::path()})
  {
    cache(unusable).store("key", bytesOf("content"));
    EXPECT_FALSE(cache(unusable).load("key")) << unusable;
    cache(unusable).removeOldest();
  }
  EXPECT_EQ(onlyFile(), file);
  fs::remove(file);
  cache().store("key", bytesOf("content"));
  const fs::path stored = onlyFile();
  fs::remove(stored);
  fs::create_directory(stored);  // neither readable as a file nor replaceable
  EXPECT_FALSE(cache().load("key"));
  cache().store("key", bytesOf("content"));
  EXPECT_FALSE(cache().load("key"));
  EXPECT_EQ(onlyFile(), stored) << "no temporary file is left";
}

/// A limit on the size of files stands for the full disk: writing fails in the middle.
TEST_F(FileCacheTest, NothingIsLeftOfAFileThatTheDiskCannotTake)
{
  cache().store("key", bytesOf("content"));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 50;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  cache().store("key", bytesOf(std::string(1000, 'x')));
  cache().store("other key", bytesOf(std::string(100'000, 'x')));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(cache().load("key"), bytesOf("content"));
  EXPECT_FALSE(cache().load("other key"));
  onlyFile();
}

TEST_F(FileCacheTest, ReadersSeeWholeFilesWhileOthersWrite)
{
  const std::vector<std::vector<char>> contents = {std::vector<char>(70'000, 'a'), std::vector<char>(70'000, 'b')};
  cache().store("key", contents[0]);
  std::vector<std::thread> writers;
  for (const std::vector<char>& content : contents)
    writers.emplace_back(
        [this, &content]
        {
          for (int i = 0; i < 200; ++i)
            cache().store("key", content);
        });
  for (int i = 0; i < 400; ++i)
  {
    const auto found = cache().load("key");
    EXPECT_TRUE(found && (*found == contents[0] || *found == contents[1])) << "load " << i;
  }
  for (std::thread& writer : writers)
    writer.join();
  onlyFile();
}

TEST_F(FileCacheTest, RemovesTheFilesThatWereUsedLongestAgo)
{
  const auto now = fs::file_time_type::clock::now();
  const std::vector<char> quarter(kMostBytes / 4 - 1000, 'x');
  std::vector<fs::path> files;
  for (int i = 0; i < 5; ++i)
  {
    cache().store(std::to_string(i), quarter);
    for (const auto& entry : fs::directory_iterator(folder_))
      if (std::find(files.begin(), files.end(), entry.path()) == files.end())
        files.push_back(entry.path());
    fs::last_write_time(files.back(), now - std::chrono::hours(10 - i));
  }
  fs::create_directory(folder_ / "other cache");
  fs::last_write_time(folder_ / "other cache", now - std::chrono::hours(20));
  write(folder_ / "other cache" / "file", "x");
  EXPECT_TRUE(cache().load("0"));  // used now
  cache().removeOldest();
  EXPECT_TRUE(cache().load("0"));
  EXPECT_FALSE(cache().load("1"));
  EXPECT_TRUE(cache().load("2"));
  EXPECT_TRUE(cache().load("4"));
  EXPECT_TRUE(fs::exists(folder_ / "other cache" / "file"));
}

TEST_F(FileCacheTest, FolderIsTheUsersAndCanBeSwitchedOff)
{
  const char* const name = "GPU_PLANNING_SCENE_TEST_CACHE";
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before != nullptr ? before : "";
  setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  EXPECT_EQ(userCacheFolder(name), folder_ / "gpu_planning_scene");
  setenv(name, "off", 1);
  EXPECT_EQ(userCacheFolder(name), fs::path());
  unsetenv(name);
  setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(userCacheFolder(name), fs::path(std::getenv("HOME")) / ".cache" / "gpu_planning_scene");
  if (before != nullptr)
    setenv("XDG_CACHE_HOME", kept.c_str(), 1);
  else
    unsetenv("XDG_CACHE_HOME");
}
}  // namespace
}  // namespace gpu_planning_scene::core
