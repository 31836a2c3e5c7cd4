#include "collision/gpu/problem/gpu_kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "collision/gpu/problem/kinematics_shader.h"
#include "gpu/staging_ring.h"
#include "shader_constants.h"

// Uploads the joint values of a part; the robot's shader computes the link poses in double and writes the instances'
// poses as floats. setInstances lists the shape instances of each link for the shader.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kTestedStates = 64;
// The error of the double computation, relative to the distance from the origin (docs/error_bounds.md), with room.
constexpr double kDoubleError = 1e-11;

/// Whether the twelve floats are the rows of the pose.
bool isNear(const float* rows, const Eigen::Isometry3d& pose)
{
  const double error = kDoubleError * (1.0 + pose.translation().norm());
  for (int entry = 0; entry < POSE_FLOATS; ++entry)
  {
    const double expected = pose(entry / 4, entry % 4);
    if (!(std::abs(static_cast<double>(rows[entry]) - expected) <= 0.5 * UNIT_ROUNDOFF * std::abs(expected) + error))
      return false;
  }
  return true;
}

using Texel = std::array<std::uint32_t, 4>;

Texel twoDoubles(double first, double second)
{
  const std::array<double, 2> values = {first, second};
  Texel texel;
  std::memcpy(texel.data(), values.data(), sizeof(texel));
  return texel;
}
}  // namespace

GpuKinematics::GpuKinematics(const std::string& shader_folder, std::shared_ptr<const RobotModel> robot)
  : robot_(std::move(robot)),
    program_(Program::fromText(shader_folder, "kinematics of " + robot_->name(), kinematicsShader(*robot_)))
{
}

std::string GpuKinematics::findFault()
{
  const std::size_t links = robot_->links().size();
  CollisionProblem problem;
  for (std::size_t link = 0; link < links; ++link)
    problem.robot.push_back(
        {0, static_cast<std::int32_t>(link), static_cast<std::int32_t>(link), Eigen::Isometry3d::Identity()});
  const std::size_t width = boundVariables();
  std::vector<double> states(kTestedStates * width);
  std::mt19937_64 generator(20033);
  for (std::size_t i = 0; i < kTestedStates; ++i)
    robot_->randomState(generator, states.data() + i * width);
  setInstances(problem);
  setStates(states.data());
  TexelBuffer poses;
  poses.reserve(kTestedStates * links * POSE_FLOATS * sizeof(float));
  const Buffer no_list(COUNTER_WORDS * sizeof(std::uint32_t));
  no_list.bindStorage(BINDING_COUNTERS);
  no_list.bindStorage(BINDING_OPEN_STATES);
  begin(0, kTestedStates);
  place(poses);
  std::vector<float> found(kTestedStates * links * POSE_FLOATS);
  poses.buffer().read(found.data(), found.size() * sizeof(float));
  std::vector<Eigen::Isometry3d> expected(links);
  for (std::size_t i = 0; i < kTestedStates; ++i)
  {
    robot_->linkPoses(states.data() + i * width, expected.data());
    for (std::size_t link = 0; link < links; ++link)
      if (!isNear(&found[(link * kTestedStates + i) * POSE_FLOATS], expected[link]))
        return "forward kinematics: link '" + robot_->links()[link].name +
               "' is elsewhere than the robot model says; the CPU computes the link poses";
  }
  return {};
}

void GpuKinematics::setInstances(const CollisionProblem& problem)
{
  const std::size_t link_count = robot_->links().size();
  std::vector<std::vector<std::uint32_t>> of_link(link_count);
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    of_link[static_cast<std::size_t>(problem.robot[i].link)].push_back(static_cast<std::uint32_t>(i));

  std::vector<Texel> texels = {twoDoubles(problem.origin.x(), problem.origin.y()), twoDoubles(problem.origin.z(), 0.0)};
  const auto first_record = static_cast<std::uint32_t>(LINK_SHAPES_HEADER + link_count);
  std::uint32_t record = 0;
  for (const auto& instances : of_link)
  {
    const auto end = record + static_cast<std::uint32_t>(instances.size());
    texels.push_back({record, end, first_record, 0});
    record = end;
  }
  for (const auto& instances : of_link)
    for (const std::uint32_t instance : instances)
    {
      const Eigen::Isometry3d& pose = problem.robot[instance].pose;
      for (int row = 0; row < 3; ++row)
      {
        texels.push_back(twoDoubles(pose(row, 0), pose(row, 1)));
        texels.push_back(twoDoubles(pose(row, 2), pose(row, 3)));
      }
      texels.push_back({instance, 0, 0, 0});
    }
  link_shapes_.reserve(texels.size() * sizeof(Texel));
  link_shapes_.buffer().write(texels);
}

void GpuKinematics::setStates(const double* states)
{
  setStates([states, width = boundVariables()](const StateRange& rows, double* to)
            { std::copy_n(states + rows.begin * width, rows.count * width, to); });
}

std::size_t GpuKinematics::maxStates() const
{
  const std::size_t numbers = TexelBuffer::maxBytes() / sizeof(double) - 1;  // see begin()
  return std::max<std::size_t>(1, numbers / std::max<std::size_t>(1, boundVariables()));
}

void GpuKinematics::begin(std::size_t begin, std::size_t count)
{
  const std::size_t width = boundVariables();
  TexelBuffer& upload = uploads_[next_upload_];
  next_upload_ = 1 - next_upload_;
  upload.reserve((count * width + 1) * sizeof(double));
  const std::size_t row_bytes = width * sizeof(double);
  const std::size_t most =
      std::max<std::size_t>(1, StagingRing::kLargestPieceBytes / std::max<std::size_t>(1, row_bytes));
  for (std::size_t first = 0; first < count; first += most)
  {
    const std::size_t rows = std::min(most, count - first);
    upload.buffer().write(rows * row_bytes, first * row_bytes,
                          [&](void* to) {
                            copyOnAllCores(copy_, {begin + first, rows}, width, static_cast<double*>(to));
                          });
  }
  upload.bindTexture(UNIT_STATES);
  count_ = count;
}

void GpuKinematics::bind(TexelBuffer& poses, bool listed)
{
  link_shapes_.bindTexture(UNIT_LINK_SHAPES);
  poses.buffer().bindStorage(BINDING_A);
  program_.set(LOCATION_STATE_COUNT, static_cast<std::uint32_t>(count_));
  program_.set(LOCATION_LISTED, listed ? 1U : 0U);
}

void GpuKinematics::place(TexelBuffer& poses)
{
  bind(poses, false);
  program_.dispatch(groupsFor(count_));
}

void GpuKinematics::placeOpenStates(TexelBuffer& poses, const BatchLists& lists)
{
  bind(poses, true);
  lists.open_states.bindStorage(BINDING_OPEN_STATES);
  program_.dispatchIndirect(lists.counters, LIST_OPEN_STATES * sizeof(std::uint32_t));
}
}  // namespace gpu_planning_scene::core
