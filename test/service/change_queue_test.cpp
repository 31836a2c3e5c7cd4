// Scene changes from topics: their order, which changes are merged, and how refused changes are reported.

#include <future>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "scene/change_testing.h"
#include "scene/slider_robot.h"
#include "service/change_queue.h"
#include "service/scene_store.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
SceneChange diff()
{
  SceneChange change;
  change.is_diff = true;
  return change;
}

SceneChange object(const std::string& id, Operation operation = Operation::Add)
{
  ObjectChange object;
  object.id = id;
  object.operation = operation;
  if (operation == Operation::Add || operation == Operation::Append)
    object.shapes.push_back({Box{{0.1, 0.1, 0.1}}, Eigen::Isometry3d::Identity()});
  SceneChange change = diff();
  change.objects.push_back(object);
  return change;
}

SceneChange carried(const std::string& id, Operation operation = Operation::Add)
{
  AttachedChange attached;
  attached.object.id = id;
  attached.object.operation = operation;
  attached.link = "cart";
  SceneChange change = diff();
  change.state.attached.push_back(attached);
  return change;
}

/// A change queue in front of a scene store. A first change waits at a gate, so that all other changes are queued.
class Queue : public testing::Test
{
 public:
  ChangeQueue::BeginBatch beginBatch()
  {
    return [this]
    {
      return [this](const SceneChange& change)
      {
        if (change.name == "gate")
        {
          at_gate.set_value();
          opened.get_future().wait();
        }
        else
          ++made;
        store.apply(change, nullptr);
      };
    };
  }
  ChangeQueue::OnRejected onRejected()
  {
    return [this](const std::string& source, const std::string& why) { refused.push_back(source + ": " + why); };
  }

  void closeGate(ChangeQueue& queue, std::size_t bytes = 0)
  {
    SceneChange gate = diff();
    gate.name = "gate";
    queue.add("gate", gate, bytes);
    at_gate.get_future().wait();
  }

  std::promise<void> at_gate;
  std::promise<void> opened;
  int made = 0;  // changes made or tried
  std::vector<std::string> refused;
  SceneStore store{PlanningScene(sliderRobot()), {}, {}};
};

/// Opens the gate and waits until the queue's thread has ended, so that the test can read the results.
void finish(ChangeQueue& queue, std::promise<void>& opened, SceneStore& store)
{
  std::promise<void> last;
  store.setListener(&last,
                    [&last](const auto&, const auto& after)
                    {
                      if (after->name == "last")
                        last.set_value();
                    });
  SceneChange change = diff();
  change.name = "last";
  queue.add("last", change, 0);
  opened.set_value();
  last.get_future().wait();
  queue.stop();
}

TEST_F(Queue, QueuedChangesAreMerged)
{
  ChangeQueue queue(beginBatch(), onRejected(), 1000, 1000);
  closeGate(queue);
  for (int i = 0; i < 100; ++i)
    queue.add("topic", object("box " + std::to_string(i)), 1);
  queue.add("topic", object("box 7", Operation::Remove), 1);
  finish(queue, opened, store);
  EXPECT_EQ(99u, store.snapshot().scene->objects.size());
  EXPECT_EQ(2, made) << "the boxes, and the last one";
  EXPECT_TRUE(refused.empty());
}

TEST_F(Queue, AWrongChangeIsRejectedAlone)
{
  ChangeQueue queue(beginBatch(), onRejected(), 100000, 100000);
  closeGate(queue);
  for (int i = 0; i < 1000; ++i)
    queue.add("topic " + std::to_string(i), object("box " + std::to_string(i)), 1);
  queue.add("wrong topic", object("no such box", Operation::Remove), 1);
  for (int i = 1000; i < 2000; ++i)
    queue.add("topic " + std::to_string(i), object("box " + std::to_string(i)), 1);
  finish(queue, opened, store);
  EXPECT_EQ(2000u, store.snapshot().scene->objects.size());
  ASSERT_EQ(1u, refused.size());
  EXPECT_EQ("wrong topic: object 'no such box' cannot be removed: the scene has no such object", refused[0]);
  EXPECT_LT(made, 50);
}

TEST_F(Queue, TheSceneIsTheSameAsOneByOne)
{
  const unsigned seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  ChangeQueue queue(beginBatch(), onRejected(), 100000, 100000);
  SceneStore one_by_one{PlanningScene(sliderRobot()), {}, {}};
  SceneChange known = diff();
  known.state.variables = {{"slide", 0.5}, {"turn", 0.0}};
  store.apply(known, nullptr);
  one_by_one.apply(known, nullptr);
  closeGate(queue);
  std::vector<std::string> expected;
  for (int i = 0; i < 3000; ++i)
  {
    const std::string id = "box " + std::to_string(random() % 8);
    const Operation operation = static_cast<Operation>(random() % 4);
    SceneChange change = object(id, operation);
    switch (random() % 8)
    {
      case 0:
      case 1:
      case 2:
        change = carried(id, operation);
        break;
      case 3:
        change.colors[id] = Color{1.0F, 0.0F, 0.0F, 1.0F};
        break;
      case 4:
        change.is_diff = random() % 8 != 0;
        break;
      default:
        break;
    }
    try
    {
      one_by_one.apply(change, nullptr);
    }
    catch (const Error& error)
    {
      expected.push_back(std::to_string(i) + ": " + error.what());
    }
    queue.add(std::to_string(i), change, 1);
  }
  finish(queue, opened, store);
  EXPECT_EQ(expected, refused);
  EXPECT_GT(expected.size(), 100u);
  PlanningScene scene = *store.snapshot().scene;
  const auto expected_scene = one_by_one.snapshot().scene;
  EXPECT_LT(scene.revision, expected_scene->revision);
  scene.name = expected_scene->name;
  scene.revision = expected_scene->revision;
  expectSameScene(*expected_scene, scene);
}

TEST_F(Queue, ChangesBeyondTheBoundsAreRejected)
{
  ChangeQueue queue(beginBatch(), onRejected(), 3, 100);
  closeGate(queue);
  queue.add("topic", object("1"), 90);
  EXPECT_THROW(queue.add("topic", object("2"), 11), Busy) << "bytes";
  queue.add("topic", object("3"), 5);
  EXPECT_THROW(queue.add("topic", object("4"), 1), Busy) << "the gate and two objects are three";
  opened.set_value();
}

TEST_F(Queue, ALargeChangeFitsAnEmptyQueue)
{
  ChangeQueue queue(beginBatch(), onRejected(), 3, 100);
  closeGate(queue, 1000);
  EXPECT_THROW(queue.add("topic", object("1"), 1), Busy);
  opened.set_value();
}

TEST_F(Queue, StopRejectsQueuedChanges)
{
  ChangeQueue queue(beginBatch(), onRejected(), 100, 100);
  closeGate(queue);
  queue.add("topic", object("1"), 1);
  queue.add("topic", object("2"), 1);
  std::thread stopping([&queue] { queue.stop(); });
  for (bool stopped = false; !stopped;)
    try
    {
      queue.add("topic", object("later"), 1);
    }
    catch (const Busy&)
    {
      std::this_thread::yield();
    }
    catch (const ShuttingDown&)
    {
      stopped = true;
    }
  opened.set_value();
  stopping.join();
  ASSERT_GE(refused.size(), 2u);
  EXPECT_EQ("topic: shutting down: the change was not made", refused[0]);
  EXPECT_TRUE(store.snapshot().scene->objects.empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
