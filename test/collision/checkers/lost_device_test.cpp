// The real GPU checker with a driver that reports a reset of its context.

#include <atomic>
#include <utility>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
std::atomic<int> resets{0};  // number of resets that the driver still has to report
PFNGLGETGRAPHICSRESETSTATUSPROC true_answer = nullptr;

GLenum answer()
{
  return resets.fetch_sub(1) > 0 ? static_cast<GLenum>(GL_GUILTY_CONTEXT_RESET) : true_answer();
}

/// The scene with its objects raised by `distance`.
std::shared_ptr<const PlanningScene> raised(const PlanningScene& scene, double distance)
{
  auto changed = std::make_shared<PlanningScene>(scene);
  changed->revision += 1;
  for (WorldObject& object : changed->objects)
    object.pose.translation().z() += distance;
  return changed;
}

TEST(LostDevice, ChangesNoAnswer)
{
  const TestScene& test = testScene("arm_boxes");
  const std::size_t width = test.scene->robot->variables().size();
  const std::vector<double> states = test.randomStates(300, 7);
  const std::size_t count = states.size() / width;

  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker checker(test.scene, options);
  true_answer = epoxy_glGetGraphicsResetStatus;  // only now: libepoxy looks the function up at its first call
  epoxy_glGetGraphicsResetStatus = answer;
  std::shared_ptr<const PlanningScene> scene = test.scene;
  BatchResult expected = CpuChecker(scene).check(states.data(), count);
  for (const int losses : {0, 1, 2})
  {
    scene = raised(*scene, 0.1);
    const BatchResult before = std::exchange(expected, CpuChecker(scene).check(states.data(), count));
    ASSERT_NE(expected.valid, before.valid) << "answers of the scene before would not be told apart";
    if (losses == 2)
      resets = 1;  // one reset in setScene(); another one in check()
    checker.setScene(scene);
    checker.check(states.data(), 1);  // waits until the device has taken the scene
    ASSERT_LE(resets, 0);
    resets = losses == 0 ? 0 : 1;
    const BatchResult result = checker.check(states.data(), count);
    EXPECT_EQ(result.valid, expected.valid) << losses;
    EXPECT_EQ(result.revision, scene->revision);
  }
  resets = 0;
  EXPECT_EQ(checker.history().losses, 3u);
  EXPECT_EQ(checker.history().rebuilds, 2u);
  EXPECT_TRUE(checker.history().on_cpu) << "after three losses";
  epoxy_glGetGraphicsResetStatus = true_answer;
}
}  // namespace
}  // namespace gpu_planning_scene::core
