// Freed memory does not count as used memory.

#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "service/memory_guard.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(MemoryGuard, FreedMemoryDoesNotCount)
{
#if defined(GPS_SANITIZED) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer keeps what is freed";
#endif
  constexpr std::size_t kPiece = 4096;
  constexpr std::size_t kPieces = 25000;
  const std::size_t limit = residentMemory() + kPiece * kPieces / 2;
  std::vector<std::unique_ptr<char[]>> pieces;
  for (std::size_t i = 0; i < kPieces; ++i)
  {
    pieces.push_back(std::make_unique<char[]>(kPiece));
    std::memset(pieces.back().get(), 1, kPiece);
  }
  EXPECT_THROW(MemoryGuard(limit).require(), OutOfMemory);
  pieces.erase(pieces.begin(), pieces.end() - 1);  // the last piece keeps the heap from shrinking by itself
  if (residentMemory() <= limit)
    GTEST_SKIP() << "this system takes back what is freed";
  EXPECT_NO_THROW(MemoryGuard(limit).require());
}
}  // namespace
}  // namespace gpu_planning_scene::core
