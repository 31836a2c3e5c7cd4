// Work on all cores: each chunk once, and exceptions of any thread reach the caller.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/parallel_for.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(ParallelFor, DoesEachItemOnce)
{
  std::vector<int> done(1000, 0);
  parallelFor(done.size(), 7,
              [&done](std::size_t begin, std::size_t end)
              {
                for (std::size_t i = begin; i < end; ++i)
                  ++done[i];
              });
  EXPECT_EQ(std::vector<int>(1000, 1), done);
}

/// Does 64 chunks of one item. Those for which `throws` is true throw an exception. Returns its text.
template <class Throws>
std::string errorOfCalls(Throws throws, std::size_t* calls = nullptr)
{
  std::atomic<std::size_t> count{0};
  std::string text;
  try
  {
    parallelFor(
        64, 1,
        [&](std::size_t begin, std::size_t)
        {
          ++count;
          if (throws())
            throw std::runtime_error("chunk " + std::to_string(begin));
        });
  }
  catch (const std::runtime_error& error)
  {
    text = error.what();
  }
  if (calls != nullptr)
    *calls = count;
  return text;
}

TEST(ParallelFor, ThrowsTheExceptionOfAThreadAgainInTheCaller)
{
  if (std::thread::hardware_concurrency() < 2)
    GTEST_SKIP() << "needs two cores";
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> thrown{false};
  const std::string text = errorOfCalls(
      [&]
      {
        if (std::this_thread::get_id() != caller)
        {
          thrown = true;
          return true;
        }
        while (!thrown)  // leaves a chunk to another thread
          std::this_thread::yield();
        return false;
      });
  EXPECT_EQ(0u, text.find("chunk "));
}

TEST(ParallelFor, JoinsItsThreadsBeforeItThrowsTheExceptionOfTheCaller)
{
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> running{0};
  const std::string text = errorOfCalls(
      [&]
      {
        if (std::this_thread::get_id() == caller)
          return true;
        ++running;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        --running;
        return false;
      });
  EXPECT_EQ(0u, text.find("chunk "));
  EXPECT_EQ(0, running);
}

TEST(ParallelFor, LeavesOutTheRestAfterAnException)
{
  std::size_t calls = 0;
  EXPECT_NE("", errorOfCalls([] { return true; }, &calls));
  EXPECT_LE(calls, std::max(1U, std::thread::hardware_concurrency()));
}

TEST(ParallelFor, ThrowsTheExceptionOfACopyOfTheWork)
{
  struct Uncopyable
  {
    Uncopyable() = default;
    Uncopyable(const Uncopyable& /*other*/) { throw std::runtime_error("no memory"); }
    void operator()(std::size_t /*begin*/, std::size_t /*end*/) const {}
  };
  const Uncopyable work;
  EXPECT_THROW(parallelFor(64, 1, work), std::runtime_error);
}
}  // namespace
}  // namespace gpu_planning_scene::core
