#include "collision/gpu/problem/uploaded_poses.h"

#include <vector>

#include "base/parallel_for.h"
#include "collision/gpu/problem/gpu_scene.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Large enough that threads rarely contend for chunks, small enough that they finish at about the same time.
constexpr std::size_t kPosesPerChunk = 256;
}  // namespace

/// Computes the poses in double, subtracts the origin, and rounds each pose once to float.
void UploadedPoses::place(TexelBuffer& poses)
{
  const std::vector<ShapeInstance>& instances = problem_.robot;
  std::vector<float> rows(count_ * instances.size() * POSE_FLOATS);
  parallelFor(count_, kPosesPerChunk,
              [&, links = std::vector<Eigen::Isometry3d>(link_count_)](std::size_t from, std::size_t to) mutable
              {
                for (std::size_t i = from; i < to; ++i)
                {
                  link_poses_(begin_ + i, links.data());
                  for (std::size_t k = 0; k < instances.size(); ++k)
                  {
                    Eigen::Isometry3d pose = placed(instances[k], links.data());
                    pose.translation() -= problem_.origin;
                    writePoseRows(pose, &rows[(k * count_ + i) * POSE_FLOATS]);
                  }
                }
              });
  poses.buffer().write(rows);
}
}  // namespace gpu_planning_scene::core
