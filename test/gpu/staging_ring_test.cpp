// Uploads arrive whole, at their place among other commands, whatever their sizes. A wait ends if the device is lost.

#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/egl_context.h"
#include "gpu/expected_gl_errors.h"
#include "gpu/fence.h"
#include "gpu/readback.h"
#include "gpu/staging_ring.h"
#include "gpu_planning_scene/error.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Words = std::vector<std::uint32_t>;

Words numbersFrom(std::uint32_t first, std::size_t bytes)
{
  Words words(bytes / sizeof(std::uint32_t));
  std::iota(words.begin(), words.end(), first);
  return words;
}

Words contentsOf(const Buffer& buffer, std::size_t bytes)
{
  Words words(bytes / sizeof(std::uint32_t));
  buffer.read(words.data(), bytes);
  return words;
}

class StagingRingTest : public testing::Test
{
 protected:
  EglContext context_{"auto"};
  StagingRing& ring_ = StagingRing::ofThisThread();
};

TEST_F(StagingRingTest, UploadsOfAllSizesArriveWhole)
{
  std::mt19937 generator(kSeed);
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  constexpr std::size_t kPiece = StagingRing::kFirstPieceBytes;
  std::vector<std::pair<Buffer, Words>> written;
  std::uint32_t first = 0;
  // Far more bytes than the ring has, so that it is used again and again.
  for (int i = 0; i < 60; ++i)
  {
    const std::size_t bytes = i % 3 == 0 ? 4 : (generator() % (kPiece / 4 - 1) + 1) * 4;
    Words words = numbersFrom(first, bytes);
    first += static_cast<std::uint32_t>(words.size());
    Buffer buffer(bytes);
    buffer.write(words);
    written.emplace_back(std::move(buffer), std::move(words));
  }
  EXPECT_EQ(ring_.pieceBytes(), kPiece);
  for (const auto& [buffer, words] : written)
    EXPECT_EQ(contentsOf(buffer, words.size() * sizeof(std::uint32_t)), words);
}

TEST_F(StagingRingTest, GrowsWithTheUploadsAndSplitsTheLargest)
{
  constexpr std::size_t kPiece = StagingRing::kFirstPieceBytes;
  Buffer small(64);
  small.write(numbersFrom(1, 64));
  const std::size_t larger = kPiece + 4;
  Buffer middle(larger);
  middle.write(numbersFrom(2, larger));  // the copy from the old memory has perhaps not been executed
  EXPECT_EQ(ring_.pieceBytes(), 2 * kPiece);
  const std::size_t largest = (StagingRing::kPieces - 1) * StagingRing::kLargestPieceBytes + kPiece + 4;
  ASSERT_LE(largest, Buffer::maxBytes());
  Buffer large(largest);
  for (const std::uint32_t first : {4U, 3U})  // twice, so that all pieces are used again
    large.write(numbersFrom(first, largest));
  EXPECT_EQ(ring_.pieceBytes(), StagingRing::kLargestPieceBytes);
  EXPECT_EQ(contentsOf(small, 64), numbersFrom(1, 64));
  EXPECT_EQ(contentsOf(middle, larger), numbersFrom(2, larger));
  EXPECT_EQ(contentsOf(large, largest), numbersFrom(3, largest));
}

TEST_F(StagingRingTest, AnUploadKeepsItsPlaceAmongClearsAndCopies)
{
  constexpr std::size_t kBytes = 4096;
  for (std::uint32_t i = 0; i < 200; ++i)
  {
    Buffer buffer(kBytes);
    buffer.write(numbersFrom(i, kBytes));
    Buffer copy(kBytes);
    copy.copyFrom(buffer, kBytes);
    buffer.clear();
    buffer.write(numbersFrom(i + 1, kBytes / 2));
    Words expected = numbersFrom(i + 1, kBytes / 2);
    expected.resize(kBytes / 4, 0);
    ASSERT_EQ(contentsOf(buffer, kBytes), expected);
    ASSERT_EQ(contentsOf(copy, kBytes), numbersFrom(i, kBytes));
  }
}

TEST_F(StagingRingTest, AnUploadBeyondTheEndOfABufferIsAnError)
{
  Buffer buffer(64);
  const ExpectedGlErrors expected;
  EXPECT_THROW(buffer.write(numbersFrom(0, 64).data(), 64, 16), Error);
}

/// While this object lives, the driver answers each wait with GL_TIMEOUT_EXPIRED, and says that the context was reset.
class LostWhileWaiting
{
 public:
  LostWhileWaiting() : wait_(epoxy_glClientWaitSync), status_(epoxy_glGetGraphicsResetStatus)
  {
    epoxy_glClientWaitSync = [](GLsync, GLbitfield, GLuint64) { return static_cast<GLenum>(GL_TIMEOUT_EXPIRED); };
    epoxy_glGetGraphicsResetStatus = [] { return static_cast<GLenum>(GL_UNKNOWN_CONTEXT_RESET); };
  }
  ~LostWhileWaiting()
  {
    epoxy_glClientWaitSync = wait_;
    epoxy_glGetGraphicsResetStatus = status_;
  }
  LostWhileWaiting(const LostWhileWaiting&) = delete;
  LostWhileWaiting& operator=(const LostWhileWaiting&) = delete;

 private:
  PFNGLCLIENTWAITSYNCPROC wait_;
  PFNGLGETGRAPHICSRESETSTATUSPROC status_;
};

TEST_F(StagingRingTest, WaitsEndIfTheDeviceIsLost)
{
  Fence fence;
  fence.place();
  fence.wait("a test");  // libepoxy looks the functions up at their first calls
  glGetGraphicsResetStatus();
  Buffer buffer(StagingRing::kFirstPieceBytes);
  const Words words = numbersFrom(0, StagingRing::kFirstPieceBytes);
  const auto upload_often = [&]
  {
    for (std::size_t i = 0; i < 2 * StagingRing::kPieces; ++i)
      buffer.write(words);
  };
  Readback readback;
  readback.begin(buffer, buffer.size());
  {
    const LostWhileWaiting lost;
    EXPECT_THROW(upload_often(), DeviceLost);
    EXPECT_THROW(readback.wait(), DeviceLost);
  }
  upload_often();
  EXPECT_EQ(contentsOf(buffer, buffer.size()), words);
}
}  // namespace
}  // namespace gpu_planning_scene::core
