#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene
{
enum class Traversal
{
  BreadthFirst,  ///< packed work lists, level by level (Gress and Zachmann 2003)
  WorkQueue      ///< a node stack per lane and a leaf queue per workgroup
};

/// "breadth_first" or "work_queue"; throws Error otherwise.
Traversal traversalFromName(const std::string& name);

struct BatchCheckerOptions : CheckerOptions
{
  /// "auto" (the first hardware device, else software), "software", an index, or part of a renderer's name.
  std::string device = "auto";
  Traversal traversal = Traversal::WorkQueue;
  std::size_t max_batch = 16384;  ///< states that go to the GPU at once; larger requests are split
  /// Batches of fewer states go to the CPU; 0: never. Unset: measured for each scene, whichever is faster.
  std::optional<std::size_t> cpu_below;
  std::string shader_folder;  ///< empty: where they were installed, or the source tree's (see shaderFolder())
};

/// What the GPU looked at, over all states.
struct GpuWork
{
  std::size_t states = 0;      ///< that went to it
  std::size_t candidates = 0;  ///< pairs of instances, by state, whose spheres or outer boxes overlap
  std::size_t root_pairs = 0;  ///< of them, those whose root boxes overlap: these are traversed
};

/// Checks states on the GPU: forward kinematics, root tests, tree traversal, triangle tests; undecided states go to a
/// double-precision traversal of the same trees on the CPU. Owns a GL context and the thread that it is current on.
class BatchChecker : public StateChecker
{
 public:
  /// Throws Error: no usable EGL device (lists what was tried), a shader that does not compile (with its log).
  BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options);
  ~BatchChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const Surroundings* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override;
  std::string deviceWarning() const override;
  /// Of the last call of `check`. The GPU counts these in any case: to know them costs nothing.
  GpuWork lastWork() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene
