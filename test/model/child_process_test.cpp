#include "model/files/child_process.h"

#include <array>
#include <chrono>
#include <csignal>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/description/description_file.h"
#include "model/model_testing.h"
#include "support/xacro_stand_in.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kLongWait = 30000;  // milliseconds

/// The answer to a script for /bin/sh.
ChildAnswer answerOf(const std::string& script, double seconds, std::size_t out = 1000)
{
  return runChild("the script", {"/bin/sh", "-c", script}, {seconds, out, 1000});
}

/// A pipe whose write end all children inherit, and the processes that they start. It hangs up when the last one ends.
class InheritedPipe
{
 public:
  InheritedPipe() { EXPECT_EQ(0, pipe2(ends_.data(), 0)); }
  ~InheritedPipe() { close(ends_[0]); }

  /// Whether all processes with the pipe end soon.
  bool hangsUp()
  {
    close(ends_[1]);
    pollfd end{ends_[0], POLLIN, 0};
    return poll(&end, 1, kLongWait) == 1;
  }

 private:
  std::array<int, 2> ends_{{-1, -1}};
};

/// This process ignores SIGCHLD, so that the system reaps its children.
class IgnoredChildren
{
 public:
  IgnoredChildren() : before_(std::signal(SIGCHLD, SIG_IGN)) {}
  ~IgnoredChildren() { std::signal(SIGCHLD, before_); }

 private:
  void (*before_)(int);
};

TEST(ChildProcess, ThatHangsIsKilledWithTheProcessesThatItHasStarted)
{
  InheritedPipe pipe;
  const ChildAnswer answer = answerOf("echo started; sleep 100; echo ended", 0.5);
  EXPECT_TRUE(answer.late);
  EXPECT_TRUE(pipe.hangsUp()) << "sleep still runs";
}

TEST(ChildProcess, ThatWritesTooMuchIsKilledWithTheProcessesThatItHasStarted)
{
  InheritedPipe pipe;
  const ChildAnswer answer = answerOf("sleep 100 & echo 1234567890; wait", 60.0, 5);
  EXPECT_TRUE(answer.too_long);
  EXPECT_TRUE(pipe.hangsUp()) << "sleep still runs";
}

TEST(ChildProcess, ThatLeavesAnotherProcessWithItsOutputIsLate)
{
  InheritedPipe pipe;
  const ChildAnswer answer = answerOf("sleep 100 &", 0.5);
  EXPECT_TRUE(answer.late);
  EXPECT_TRUE(pipe.hangsUp()) << "sleep still runs";
}

TEST(ChildProcess, HasAStatus)
{
  const ChildAnswer answer = answerOf("exit 3", 60.0);
  ASSERT_TRUE(answer.has_status);
  EXPECT_EQ(3, WEXITSTATUS(answer.status));
}

TEST(ChildProcess, HasEndedWithoutAStatusIfTheProgramIgnoresItsChildren)
{
  const IgnoredChildren ignored;
  const auto begin = std::chrono::steady_clock::now();
  const ChildAnswer answer = answerOf("echo done; exit 3", 60.0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(kLongWait));
  EXPECT_EQ("done\n", answer.out);
  EXPECT_FALSE(answer.late);
  EXPECT_FALSE(answer.has_status);
  EXPECT_TRUE(answerOf("sleep 100", 0.5).late);
}

TEST(ChildProcess, WithoutAStatusIsAnErrorThatNamesTheCause)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("r.xacro", "<robot name='r'><link name='${x}'/></robot>");
  const XacroStandIn xacro("echo \"<robot name='r'/>\"");
  const IgnoredChildren ignored;
  EXPECT_EQ("URDF '" + path + "' is a xacro file: " + xacro.program() + " has ended, but " + kNoStatus,
            errorOf([&] { readDescription(path, "URDF", {}, {}); }));
  MeshLimits limits;
  EXPECT_EQ(std::string("mesh file '/x/exit.stl': the reader has ended, but ") + kNoStatus,
            errorOf([&] { childMeshReader(GPS_FAULTY_MESH_READER, limits)("/x/exit.stl", Eigen::Vector3d::Ones()); }));
}

TEST(ChildProcess, ThatHasSentAMeshOrAnErrorNeedsNoStatus)
{
  const TemporaryFolder folder;
  const std::string mesh = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string none = folder.write("b.obj", "v 0 0 0\n");
  const IgnoredChildren ignored;
  const ReadMesh read = childMeshReader(GPS_READ_MESH, {});
  EXPECT_EQ(1u, read(mesh, Eigen::Vector3d::Ones())->triangles.size());
  EXPECT_NE(std::string::npos, errorOf([&] { read(none, Eigen::Vector3d::Ones()); }).find("no triangles"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
