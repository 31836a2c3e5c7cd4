// Leases of checkers: which checker a user gets, and when its scene is set.

#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "scene/slider_robot.h"
#include "service/checker_pool.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Records the scenes that it gets.
class RecordingChecker : public StateChecker
{
 public:
  void setScene(std::shared_ptr<const PlanningScene> scene) override { scenes.push_back(std::move(scene)); }
  BatchResult checkBatch(const StateBatch& /*batch*/) override { return {}; }
  SceneReport report(const std::string& /*group*/) override { return {}; }
  std::string deviceName() const override { return "none"; }

  std::vector<std::shared_ptr<const PlanningScene>> scenes;
};

class CheckerPoolTest : public testing::Test
{
 protected:
  static const RecordingChecker* checkerOf(const CheckerPool::Lease& lease)
  {
    return dynamic_cast<const RecordingChecker*>(lease.checker().get());
  }

  const RecordingChecker* lendOnce(const std::shared_ptr<const PlanningScene>& scene)
  {
    CheckerPool::Lease lease(pool_, scene);
    const RecordingChecker* const lent = checkerOf(lease);
    lease.giveBack();
    return lent;
  }

  CheckerPool pool_{[](std::shared_ptr<const PlanningScene> scene)
                    {
                      auto made = std::make_shared<RecordingChecker>();
                      made->setScene(std::move(scene));
                      return made;
                    }};
  std::shared_ptr<const PlanningScene> hall_ = std::make_shared<PlanningScene>(sliderRobot());
  std::shared_ptr<const PlanningScene> yard_ = std::make_shared<PlanningScene>(sliderRobot());
};

TEST_F(CheckerPoolTest, KeepsWhatACheckerHasLearnedInItsScene)
{
  const RecordingChecker* const first = lendOnce(hall_);
  EXPECT_EQ(lendOnce(hall_), first);
  EXPECT_EQ(first->scenes.size(), 1U);  // setScene would discard it
}

TEST_F(CheckerPoolTest, GivesEachUserTheScene)
{
  const RecordingChecker* const first = lendOnce(hall_);
  EXPECT_EQ(lendOnce(yard_), first);
  EXPECT_EQ(lendOnce(hall_), first);
  EXPECT_EQ(first->scenes, (std::vector{hall_, yard_, hall_}));
}

TEST_F(CheckerPoolTest, PrefersTheCheckerThatHasTheScene)
{
  const RecordingChecker* of_hall = nullptr;
  {
    CheckerPool::Lease hall(pool_, hall_);
    CheckerPool::Lease yard(pool_, yard_);
    of_hall = checkerOf(hall);
    hall.giveBack();
    yard.giveBack();
  }
  EXPECT_EQ(lendOnce(hall_), of_hall);
  EXPECT_EQ(of_hall->scenes.size(), 1U);
}

TEST_F(CheckerPoolTest, KeepsTheCheckerThatWasUsedLastForItsScene)
{
  const RecordingChecker* last = nullptr;
  {
    CheckerPool::Lease one(pool_, hall_);
    CheckerPool::Lease other(pool_, hall_);
    last = checkerOf(other);
    one.giveBack();
    other.giveBack();
  }
  EXPECT_EQ(lendOnce(hall_), last);
  EXPECT_NE(lendOnce(yard_), last);
  EXPECT_EQ(lendOnce(hall_), last);
}

TEST_F(CheckerPoolTest, DropsACheckerThatIsNotGivenBack)
{
  std::weak_ptr<StateChecker> dropped;
  {
    const CheckerPool::Lease lease(pool_, hall_);
    dropped = lease.checker();
  }
  EXPECT_TRUE(dropped.expired());
}
}  // namespace
}  // namespace gpu_planning_scene::core
