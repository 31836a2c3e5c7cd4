#include "literature/cgal/cgal_method.h"

#include <array>
#include <csignal>
#include <ctime>
#include <filesystem>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu_planning_scene/error.h"

// CGAL, Rigid_triangle_mesh_collision_detection (Loriot, Rouxel-Labbe, Tournois, Yaz, "Polygon Mesh Processing", CGAL
// User and Reference Manual): trees of axis-aligned boxes, exact predicates. Domain: meshes without edges of three or
// more faces; closed components are solids. The work is done by the program cgal_collide.
namespace gpu_planning_scene::core::literature
{
namespace
{
/// The program lies beside the one that runs.
std::string programPath()
{
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cgal_collide").string();
}

class Cgal : public Method
{
 public:
  Cgal(const Mesh& a, const Mesh& b)
  {
    start();
    try
    {
      send(a);
      send(b);
      if (receive(1).front() == 0)
        throw Error("CGAL cannot take the mesh '" + a.name + "' or '" + b.name + "', because it is not a manifold");
    }
    catch (...)
    {
      stop();
      throw;
    }
  }
  ~Cgal() override { stop(); }
  Cgal(const Cgal&) = delete;
  Cgal& operator=(const Cgal&) = delete;

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<double> matrices;
    for (const Eigen::Isometry3d& pose : b_in_a)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k)
          matrices.push_back(pose.matrix()(i, k));
    const std::uint64_t count = b_in_a.size();
    send(&count, sizeof count);
    send(matrices.data(), matrices.size() * sizeof(double));
    return receive(b_in_a.size());
  }

  double otherCpuSeconds() const override
  {
    clockid_t clock{};
    timespec time{};
    if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &time) != 0)
      throw Error("the CPU time of cgal_collide cannot be read");
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  void start()
  {
    std::array<int, 2> in{};   // the process reads from in[0]
    std::array<int, 2> out{};  // the process writes to out[1]
    if (pipe(in.data()) != 0 || pipe(out.data()) != 0)
      throw Error("no pipe to cgal_collide can be made");
    to_ = in[1];
    from_ = out[0];
    std::signal(SIGPIPE, SIG_IGN);  // a process that ended is an error of write
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    for (const int file : {in[0], in[1], out[0], out[1]})
      posix_spawn_file_actions_addclose(&actions, file);
    std::string program = programPath();
    std::array<char*, 2> arguments = {program.data(), nullptr};
    const int failed = posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
    if (failed != 0)
    {
      process_ = 0;
      stop();
      throw Error(program + " cannot be started");
    }
  }

  void stop()
  {
    close(to_);
    close(from_);
    if (process_ != 0)
      waitpid(process_, nullptr, 0);
    process_ = 0;
  }

  void send(const Mesh& mesh)
  {
    const std::array<std::uint64_t, 2> counts = {mesh.vertices.size(), mesh.triangles.size()};
    send(counts.data(), sizeof counts);
    send(mesh.vertices.data(), mesh.vertices.size() * sizeof mesh.vertices.front());
    send(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles.front());
  }

  void send(const void* data, std::size_t size)
  {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0)
    {
      const ssize_t written = write(to_, bytes, size);
      if (written <= 0)
        throw Error("cgal_collide has ended");
      bytes += written;
      size -= static_cast<std::size_t>(written);
    }
  }

  std::vector<std::uint8_t> receive(std::size_t count)
  {
    std::vector<std::uint8_t> bytes(count);
    for (std::size_t done = 0; done < count;)
    {
      const ssize_t found = read(from_, bytes.data() + done, count - done);
      if (found <= 0)
        throw Error("cgal_collide has ended");
      done += static_cast<std::size_t>(found);
    }
    return bytes;
  }

  int to_ = -1;
  int from_ = -1;
  pid_t process_ = 0;
};
}  // namespace

std::string whyNoCgal()
{
  return access(programPath().c_str(), X_OK) == 0 ? "" : "there is no program " + programPath();
}

std::vector<MethodInfo> cgalMethods()
{
  if (!whyNoCgal().empty())
    return {};
  return {{"cgal",
           "CGAL",
           "CGAL: Rigid_triangle_mesh_collision_detection",
           "library",
           {true, true, true},
           [](const auto& a, const auto& b) { return std::make_unique<Cgal>(*a, *b); }}};
}
}  // namespace gpu_planning_scene::core::literature
