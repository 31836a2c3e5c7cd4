// Checks for many clients at once: which requests are merged, queued or rejected, and to which scene an answer belongs.

#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <typeinfo>

#include <gtest/gtest.h>
#include <pthread.h>

#include "scene/slider_robot.h"
#include "service/check_server.h"
#include "service/gated_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kSmall = 8;

CheckServerOptions options()
{
  CheckServerOptions options;
  options.small_request = kSmall;
  options.max_waiting_requests = 5;
  options.max_waiting_states = 200;
  options.max_states = 100;
  return options;
}

/// States of two variables, all with the first variable `first`.
CheckJob job(std::size_t states, double first = 1.0)
{
  CheckJob job;
  for (std::size_t i = 0; i < states; ++i)
  {
    job.states.push_back(first);
    job.states.push_back(0.0);
  }
  return job;
}

/// States with a value for `turn` and none for `slide`.
CheckJob jobWithoutSlide(std::size_t states)
{
  CheckJob job;
  job.columns = {1};
  job.states.assign(states, 0.5);
  return job;
}

std::string errorOf(std::future<CheckAnswer>& answer)
{
  try
  {
    answer.get();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

const std::type_info& typeOfError(std::future<CheckAnswer>& answer)
{
  try
  {
    answer.get();
  }
  catch (const std::exception& error)
  {
    return typeid(error);
  }
  return typeid(void);
}

MakeChecker checkersAt(Gate& gate)
{
  return [&gate](std::shared_ptr<const PlanningScene> scene)
  { return std::make_shared<GatedChecker>(std::move(scene), gate); };
}

class Server : public testing::Test
{
 public:
  /// A request that waits at the closed gate, so that all later requests of its queue wait too.
  std::future<CheckAnswer> blocked(std::size_t states = 1)
  {
    gate.close();
    const std::size_t checks = gate.batches().size();
    std::future<CheckAnswer> answer = server.submit(job(states));
    gate.waitForChecks(checks + 1);
    return answer;
  }

  std::uint64_t rename(const std::string& name)
  {
    SceneChange change;
    change.is_diff = true;
    change.name = name;
    return store.apply(change, nullptr).revision;
  }

  std::uint64_t slideTo(double position)
  {
    SceneChange change;
    change.is_diff = true;
    change.state.variables = {{"slide", position}, {"turn", 0.0}};
    return store.apply(change, nullptr).revision;
  }

  Gate gate;
  SceneStore store{PlanningScene(sliderRobot()), {}, {}};
  CheckServer server{store, checkersAt(gate), options()};
};

TEST_F(Server, SmallRequestsThatWaitTogetherAreOneBatchAndEachGetsItsOwnRows)
{
  std::future<CheckAnswer> first = blocked();
  std::vector<std::future<CheckAnswer>> waiting;
  for (const double value : {1.0, -1.0, 2.0})
    waiting.push_back(server.submit(job(2, value)));
  gate.open();
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), waiting[0].get().result.valid);
  const CheckAnswer colliding = waiting[1].get();
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), colliding.result.valid);
  EXPECT_EQ(2u, colliding.result.colliding.size());
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), waiting[2].get().result.valid);
  first.get();
  EXPECT_EQ((std::vector<std::size_t>{1, 6}), gate.batches());
  const CheckStatistics statistics = server.statistics();
  EXPECT_EQ(4u, statistics.requests);
  EXPECT_EQ(2u, statistics.batches);
  EXPECT_EQ(7u, statistics.states);
  EXPECT_EQ(0u, statistics.waiting_requests + statistics.waiting_states);
}

TEST_F(Server, ABatchIsNoLargerThanItsBound)
{
  std::future<CheckAnswer> first = blocked();
  std::vector<std::future<CheckAnswer>> waiting;
  for (int i = 0; i < 4; ++i)
    waiting.push_back(server.submit(job(kSmall)));
  gate.open();
  for (auto& answer : waiting)
    EXPECT_EQ(kSmall, answer.get().result.valid.size());
  EXPECT_EQ((std::vector<std::size_t>{1, 3 * kSmall, kSmall}), gate.batches());
}

TEST_F(Server, ARequestOfFewStatesIsNotMergedWithOneOfMany)
{
  constexpr std::size_t kMany = 20;
  CheckServerOptions larger = options();
  larger.small_request = kMany;
  CheckServer of_larger(store, checkersAt(gate), larger);
  gate.close();
  const std::size_t checks = gate.batches().size();
  std::vector<std::future<CheckAnswer>> answers;
  answers.push_back(of_larger.submit(job(1)));
  gate.waitForChecks(checks + 1);
  for (const std::size_t states : {std::size_t{1}, kMany, std::size_t{2}})
    answers.push_back(of_larger.submit(job(states)));
  gate.open();
  for (auto& answer : answers)
    answer.get();
  EXPECT_EQ((std::vector<std::size_t>{1, 3, kMany}), gate.batches());
}

TEST_F(Server, RequestsOfOtherGroupsOrMatricesAreBatchesOfTheirOwn)
{
  std::future<CheckAnswer> first = blocked();
  std::vector<std::future<CheckAnswer>> waiting;
  waiting.push_back(server.submit(job(1)));
  CheckJob grouped = job(2);
  grouped.group = "mast";
  waiting.push_back(server.submit(std::move(grouped)));
  CheckJob with_matrix = job(3);
  AllowedCollisionMatrix matrix;
  matrix.setEntry("cart", "crate", true);
  with_matrix.matrix = std::make_shared<const AllowedCollisionMatrix>(matrix);
  waiting.push_back(server.submit(std::move(with_matrix)));
  waiting.push_back(server.submit(job(4)));
  gate.open();
  first.get();
  EXPECT_FALSE(waiting[0].get().scene->allowed_collisions.allowed("cart", "crate"));
  waiting[1].get();
  EXPECT_TRUE(waiting[2].get().scene->allowed_collisions.allowed("cart", "crate"));
  EXPECT_EQ(4u, waiting[3].get().result.valid.size());
  EXPECT_EQ((std::vector<std::size_t>{1, 5, 2, 3}), gate.batches());
  EXPECT_FALSE(server.submit(job(1)).get().scene->allowed_collisions.allowed("cart", "crate"))
      << "the matrix of a request stays with it";
}

TEST_F(Server, EqualMatricesOfTwoRequestsAreOne)
{
  std::future<CheckAnswer> first = blocked();
  std::vector<std::future<CheckAnswer>> waiting;
  for (int i = 0; i < 2; ++i)
  {
    AllowedCollisionMatrix matrix;
    matrix.setEntry("cart", "crate", true);
    CheckJob with_matrix = job(2);
    with_matrix.matrix = std::make_shared<const AllowedCollisionMatrix>(matrix);
    waiting.push_back(server.submit(std::move(with_matrix)));
  }
  gate.open();
  for (auto& answer : waiting)
    answer.get();
  EXPECT_EQ((std::vector<std::size_t>{1, 4}), gate.batches());
}

TEST_F(Server, ALargeMatrixMakesALargeRequest)
{
  AllowedCollisionMatrix matrix;
  for (int i = 0; i < 200; ++i)
    matrix.setDefault("object " + std::to_string(i), true);
  gate.close();
  CheckJob with_matrix = job(1);
  with_matrix.matrix = std::make_shared<const AllowedCollisionMatrix>(matrix);
  std::future<CheckAnswer> large = server.submit(std::move(with_matrix));
  gate.waitForChecks(1);
  std::future<CheckAnswer> small = server.submit(job(1));
  gate.waitForChecks(2);  // waits for ever if the small request is queued behind the large one
  gate.open();
  EXPECT_EQ(1u, large.get().result.valid.size());
  EXPECT_EQ(1u, small.get().result.valid.size());
}

TEST_F(Server, MissingVariablesComeFromTheSnapshotOfTheScene)
{
  slideTo(1.0);
  std::future<CheckAnswer> first = blocked();
  std::future<CheckAnswer> waiting = server.submit(jobWithoutSlide(2));
  std::future<CheckAnswer> full = server.submit(job(1));
  EXPECT_EQ(2u, slideTo(-1.0));
  gate.open();
  const CheckAnswer answer = waiting.get();
  EXPECT_EQ(2u, answer.result.revision);
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), answer.result.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), full.get().result.valid);
  EXPECT_EQ((std::vector<std::size_t>{1, 3}), gate.batches()) << "they are still answered together";
}

TEST_F(Server, MissingVariablesFailOnlyTheirRequest)
{
  std::future<CheckAnswer> first = blocked();
  std::future<CheckAnswer> wrong = server.submit(jobWithoutSlide(1));
  std::future<CheckAnswer> right = server.submit(job(1));
  gate.open();
  EXPECT_NE(std::string::npos, errorOf(wrong).find("no value for slide"));
  EXPECT_EQ((std::vector<std::uint8_t>{1}), right.get().result.valid);
}

TEST_F(Server, ColumnsComeInAnyOrderAndFullStatesAreKeptWhereAsked)
{
  std::future<CheckAnswer> first = blocked();
  CheckJob swapped;
  swapped.columns = {1, 0};
  swapped.states = {0.25, -1.0, 0.5, 1.0};
  swapped.keep_states = true;
  std::future<CheckAnswer> kept = server.submit(swapped);
  std::future<CheckAnswer> other = server.submit(job(1));
  gate.open();
  const CheckAnswer answer = kept.get();
  EXPECT_EQ((std::vector<std::uint8_t>{0, 1}), answer.result.valid);
  EXPECT_EQ((std::vector<double>{-1.0, 0.25, 1.0, 0.5}), answer.states);
  EXPECT_TRUE(other.get().states.empty());
  EXPECT_EQ((std::vector<double>{-1.0, 0.25, 1.0, 0.5}), server.submit(swapped).get().states) << "alone";
}

TEST_F(Server, ASmallRequestDoesNotWaitForALargeOne)
{
  std::future<CheckAnswer> large = blocked(kSmall + 1);
  std::future<CheckAnswer> small = server.submit(job(1));
  gate.waitForChecks(2);  // waits for ever if the small request is queued behind the large one
  EXPECT_EQ((std::vector<std::size_t>{kSmall + 1, 1}), gate.batches());
  gate.open();
  EXPECT_EQ(1u, small.get().result.valid.size());
  EXPECT_EQ(kSmall + 1, large.get().result.valid.size());
  EXPECT_EQ(2u, gate.checkers()) << "each queue has its own checker";
}

TEST_F(Server, FullQueueRejectsAtOnce)
{
  std::future<CheckAnswer> first = blocked();
  std::vector<std::future<CheckAnswer>> waiting;
  for (int i = 0; i < 5; ++i)
    waiting.push_back(server.submit(job(1)));
  EXPECT_THROW(server.submit(job(1)), Busy);
  EXPECT_EQ(1u, server.statistics().busy);
  EXPECT_EQ(5u, server.statistics().waiting_requests);
  EXPECT_EQ(5u, server.statistics().waiting_states);
  std::future<CheckAnswer> large = server.submit(job(100));
  gate.waitForChecks(2);
  waiting.push_back(server.submit(job(100)));
  waiting.push_back(server.submit(job(100)));
  EXPECT_THROW(server.submit(job(kSmall + 1)), Busy) << "201 states or more would wait";
  gate.open();
  for (auto& answer : waiting)
    EXPECT_FALSE(answer.get().result.valid.empty());
  EXPECT_EQ(1u, server.submit(job(1)).get().result.valid.size()) << "it is free again";
}

TEST_F(Server, ARequestOfTooManyStatesIsRefusedAndNotBusy)
{
  try
  {
    server.submit(job(101));
    FAIL() << "it was taken";
  }
  catch (const Busy&)
  {
    FAIL() << "to ask again later would not help";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("the limit is 100")) << error.what();
  }
}

TEST_F(Server, OnlyTheWrongRequestOfABatchGetsItsError)
{
  std::future<CheckAnswer> first = blocked();
  std::future<CheckAnswer> right = server.submit(job(1, 1.0));
  std::future<CheckAnswer> wrong = server.submit(job(1, 13.0));
  std::future<CheckAnswer> also_right = server.submit(job(2, -1.0));
  gate.open();
  EXPECT_EQ((std::vector<std::uint8_t>{1}), right.get().result.valid);
  EXPECT_EQ("13 is not a position", errorOf(wrong));
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), also_right.get().result.valid);
  EXPECT_EQ(1u, server.statistics().errors);
}

TEST_F(Server, AnAnswerIsOfTheNewestSceneWhenItsBatchStarts)
{
  EXPECT_EQ(0u, server.submit(job(1)).get().result.revision);
  std::future<CheckAnswer> first = blocked();
  std::future<CheckAnswer> waiting = server.submit(job(1));
  rename("other");
  gate.open();
  EXPECT_EQ(0u, first.get().result.revision);
  const CheckAnswer answer = waiting.get();
  EXPECT_EQ(1u, answer.result.revision);
  EXPECT_EQ("other", answer.scene->name);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), answer.result.valid);
}

TEST_F(Server, ACheckerThatRefusesASceneIsDropped)
{
  server.submit(job(1)).get();
  EXPECT_EQ(1u, gate.checkers());
  rename("unusable");
  std::future<CheckAnswer> refused = server.submit(job(1));
  EXPECT_EQ("the scene is unusable", errorOf(refused));
  rename("good");
  EXPECT_EQ(2u, server.submit(job(1)).get().result.revision);
  EXPECT_EQ(2u, gate.checkers());
}

/// The scene named "unusable", as a request that changes the scene would bring it.
CheckJob jobInUnusableScene(const SceneStore& store)
{
  CheckJob unusable = job(1);
  unusable.scene = store.snapshot();
  auto scene = std::make_shared<PlanningScene>(*unusable.scene->scene);
  scene->name = "unusable";
  unusable.scene->scene = std::move(scene);
  return unusable;
}

TEST_F(Server, ASceneThatCannotBeCheckedIsTheFaultOfWhoHasMadeIt)
{
  server.submit(job(2 * kSmall)).get();  // from now on, each queue has a checker
  const std::size_t checkers = gate.checkers();
  std::future<CheckAnswer> of_request = server.submit(jobInUnusableScene(store));
  EXPECT_EQ(typeid(Error), typeOfError(of_request));
  EXPECT_EQ(1u, server.submit(job(2 * kSmall)).get().result.valid.size() / (2 * kSmall));
  EXPECT_EQ(checkers + 1, gate.checkers()) << "the checker that refused the scene was dropped";
  rename("unusable");
  std::future<CheckAnswer> of_service = server.submit(job(1));
  EXPECT_EQ(typeid(InternalError), typeOfError(of_service));
  of_service = server.submit(job(1));
  EXPECT_EQ(typeid(InternalError), typeOfError(of_service)) << "without a checker";
  CheckJob with_matrix = job(1);
  with_matrix.matrix = std::make_shared<AllowedCollisionMatrix>();
  of_service = server.submit(std::move(with_matrix));
  EXPECT_EQ(typeid(InternalError), typeOfError(of_service)) << "the matrix of the request is not the cause";
}

TEST_F(Server, ADeviceThatCannotBeOpenedAgainIsNotTheFaultOfARequest)
{
  bool is_lost = false;
  const MakeChecker make = [&](std::shared_ptr<const PlanningScene> scene) -> std::shared_ptr<StateChecker>
  {
    if (is_lost)
      throw Error("no usable EGL device");
    return std::make_shared<GatedChecker>(std::move(scene), gate);
  };
  CheckServer losing(store, make, options());
  is_lost = true;
  std::future<CheckAnswer> large = losing.submit(job(2 * kSmall));
  EXPECT_EQ(typeid(InternalError), typeOfError(large));
  CheckJob changed = job(1);
  changed.scene = store.snapshot();
  changed.scene->scene = std::make_shared<PlanningScene>(*changed.scene->scene);
  std::future<CheckAnswer> of_request = losing.submit(std::move(changed));
  EXPECT_EQ(typeid(InternalError), typeOfError(of_request));
}

/// While it exists, the process cannot start threads: their stacks would be larger than the address space.
class NoFurtherThread
{
 public:
  NoFurtherThread()
  {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    pthread_getattr_default_np(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 47);
    pthread_setattr_default_np(&huge);
  }
  ~NoFurtherThread() { pthread_setattr_default_np(&before_); }

 private:
  pthread_attr_t before_;
};

TEST_F(Server, ARequestForWhichNoThreadStartsIsNotQueued)
{
  {
    const NoFurtherThread limit;
    EXPECT_THROW(server.submit(job(1)), std::system_error);
  }
  EXPECT_EQ(0u, server.statistics().waiting_requests);
  EXPECT_EQ(1u, server.submit(job(1)).get().result.valid.size());
}

TEST_F(Server, AReportComesWithTheSceneThatItIsOf)
{
  CheckJob asked = job(0);
  asked.report = true;
  const CheckAnswer answer = server.submit(std::move(asked)).get();
  ASSERT_TRUE(answer.report);
  EXPECT_EQ(7u, answer.report->self_pairs);
  EXPECT_EQ("gate", answer.device);
}

TEST_F(Server, StopAnswersRunningAndRejectsQueued)
{
  std::future<CheckAnswer> running = blocked();
  std::future<CheckAnswer> waiting = server.submit(job(1));
  std::thread stopping([this] { server.stop(); });
  EXPECT_THROW(waiting.get(), ShuttingDown);
  gate.open();
  stopping.join();
  EXPECT_EQ(1u, running.get().result.valid.size());
  EXPECT_THROW(server.submit(job(1)), ShuttingDown);
}

/// A checker makes proofs in threads of its own, and the end of the process would wait for them.
TEST_F(Server, StopDropsTheCheckers)
{
  Gate open_gate;
  std::vector<std::weak_ptr<StateChecker>> made;
  const auto kept = [&made](const MakeChecker& make)
  {
    return [&made, make](std::shared_ptr<const PlanningScene> scene)
    {
      std::shared_ptr<StateChecker> checker = make(std::move(scene));
      made.push_back(checker);
      return checker;
    };
  };
  CheckServer relieved(store, kept(checkersAt(gate)), options(), kept(checkersAt(open_gate)));
  relieved.submit(job(100)).get();
  gate.close();
  const std::size_t checks = gate.batches().size();
  std::future<CheckAnswer> slow = relieved.submit(job(kSmall));
  gate.waitForChecks(checks + 1);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), relieved.submit(job(1)).get().result.valid);
  gate.open();
  slow.get();
  relieved.stop();
  ASSERT_EQ(3u, made.size()) << "of small requests, large requests and the relief";
  for (const std::weak_ptr<StateChecker>& checker : made)
    EXPECT_TRUE(checker.expired());
}

TEST_F(Server, ALargeRequestIsAnsweredWhole)
{
  CheckJob large = job(100);
  for (std::size_t i = 0; i < 100; i += 3)
    large.states[2 * i] = -1.0;
  const CheckAnswer answer = server.submit(std::move(large)).get();
  ASSERT_EQ(100u, answer.result.valid.size());
  ASSERT_EQ(100u, answer.result.colliding.size());
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(i % 3 == 0 ? 0 : 1, answer.result.valid[i]) << i;
  EXPECT_EQ((std::vector<std::size_t>{24, 24, 24, 24, 4}), gate.batches());
}

TEST_F(Server, StopEndsALargeRequestAfterItsCurrentSlice)
{
  std::future<CheckAnswer> running = blocked(100);
  std::future<CheckAnswer> waiting = server.submit(job(100));
  std::thread stopping([this] { server.stop(); });
  EXPECT_THROW(waiting.get(), ShuttingDown);
  gate.open();
  stopping.join();
  EXPECT_THROW(running.get(), ShuttingDown);
  EXPECT_EQ(1u, gate.batches().size());
}

/// The checker of the batches waits at the gate; that of the relief does not.
TEST_F(Server, RequestsOfFewStatesDoNotWaitForASlowBatch)
{
  Gate open_gate;
  CheckServerOptions roomy = options();
  roomy.small_request = 50;
  CheckServer relieved(store, checkersAt(gate), roomy, checkersAt(open_gate));
  // The relief never takes a request of so many states.
  EXPECT_EQ(std::vector<std::uint8_t>(17, 1), relieved.submit(job(17)).get().result.valid);
  EXPECT_EQ(0U, open_gate.checkers()) << "without a slow batch, the relief has nothing to do";
  gate.close();
  std::future<CheckAnswer> slow = relieved.submit(job(50));
  gate.waitForChecks(2);
  std::future<CheckAnswer> as_slow = relieved.submit(job(50));
  CheckJob motion = job(2);
  motion.motions = MotionCheckerOptions();
  motion.samples = 2;
  std::future<CheckAnswer> motions = relieved.submit(std::move(motion));
  EXPECT_EQ((std::vector<std::uint8_t>{1}), relieved.submit(job(1)).get().result.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), relieved.submit(job(2, -1.0)).get().result.valid);
  rename("new");
  EXPECT_EQ((std::vector<std::uint8_t>{0}), relieved.submit(job(1)).get().result.valid) << "in the new scene";
  CheckJob wrong = job(1);
  wrong.group = "no such group";
  std::future<CheckAnswer> error = relieved.submit(std::move(wrong));
  EXPECT_NE("", errorOf(error));
  EXPECT_EQ(2U, gate.batches().size());
  EXPECT_EQ(2U, relieved.statistics().waiting_requests);
  gate.open();
  EXPECT_EQ(50U, slow.get().result.valid.size());
  EXPECT_EQ(50U, as_slow.get().result.valid.size());
  EXPECT_EQ(1U, motions.get().motions.size());
  EXPECT_EQ(1U, open_gate.checkers());
  relieved.stop();
}

/// The trees of a large robot take long, so the first request beside a slow batch would wait for them.
TEST_F(Server, TheReliefIsReadyBeforeARequestWaitsBesideASlowBatch)
{
  Gate open_gate;
  CheckServer relieved(store, checkersAt(gate), options(), checkersAt(open_gate));
  gate.close();
  std::future<CheckAnswer> slow = relieved.submit(job(kSmall));
  for (int i = 0; i < 2000 && open_gate.checkers() == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(1U, open_gate.checkers());
  EXPECT_EQ((std::vector<std::uint8_t>{1}), relieved.submit(job(1)).get().result.valid);
  EXPECT_EQ(1U, open_gate.checkers());
  gate.open();
  EXPECT_EQ(kSmall, slow.get().result.valid.size());
}

TEST_F(Server, TheFirstThreadAnswersWhileTheReliefIsMade)
{
  std::promise<void> begun;
  std::promise<void> may_end;
  Gate open_gate;
  CheckServer relieved(store, checkersAt(gate), options(),
                       [&](std::shared_ptr<const PlanningScene> scene)
                       {
                         begun.set_value();
                         may_end.get_future().wait();
                         return checkersAt(open_gate)(std::move(scene));
                       });
  gate.close();
  std::future<CheckAnswer> slow = relieved.submit(job(kSmall));
  gate.waitForChecks(1);
  std::future<CheckAnswer> waiting = relieved.submit(job(1));
  begun.get_future().wait();
  gate.open();
  EXPECT_EQ((std::vector<std::uint8_t>{1}), waiting.get().result.valid) << "the relief holds the request";
  EXPECT_EQ(kSmall, slow.get().result.valid.size());
  may_end.set_value();
}

TEST_F(Server, WithoutAReliefTheFirstThreadAnswers)
{
  std::atomic<int> attempts{0};
  const auto fail = [&attempts](const std::shared_ptr<const PlanningScene>&) -> std::shared_ptr<StateChecker>
  {
    ++attempts;
    throw Error("there is no memory for another checker");
  };
  CheckServer relieved(store, checkersAt(gate), options(), fail);
  gate.close();
  std::future<CheckAnswer> slow = relieved.submit(job(kSmall));
  gate.waitForChecks(1);
  std::future<CheckAnswer> waiting = relieved.submit(job(1));
  std::future<CheckAnswer> other = relieved.submit(job(2, -1.0));
  for (int i = 0; i < 2000 && attempts == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(1, attempts);
  gate.open();
  EXPECT_EQ(kSmall, slow.get().result.valid.size());
  EXPECT_EQ((std::vector<std::uint8_t>{1}), waiting.get().result.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), other.get().result.valid);
  EXPECT_EQ(0U, relieved.statistics().errors);
  EXPECT_EQ(0U, relieved.statistics().waiting_states);
  EXPECT_LE(attempts, 2) << "it rests after a failure";
}

/// The first check of a scene makes its trees, which may fail.
TEST_F(Server, AReliefWhoseFirstCheckFailsGetsNoRequest)
{
  class FailingChecker : public GatedChecker
  {
   public:
    FailingChecker(std::shared_ptr<const PlanningScene> scene, Gate& gate, std::atomic<int>& checks)
      : GatedChecker(std::move(scene), gate), checks_(checks)
    {
    }
    BatchResult checkBatch(const StateBatch& /*batch*/) override
    {
      ++checks_;
      throw Error("there is no memory for the trees");
    }

   private:
    std::atomic<int>& checks_;
  };
  Gate open_gate;
  std::atomic<int> checks{0};
  CheckServer relieved(store, checkersAt(gate), options(),
                       [&](std::shared_ptr<const PlanningScene> scene)
                       { return std::make_shared<FailingChecker>(std::move(scene), open_gate, checks); });
  gate.close();
  std::future<CheckAnswer> slow = relieved.submit(job(kSmall));
  gate.waitForChecks(1);
  std::future<CheckAnswer> waiting = relieved.submit(job(1));
  // After a failure, the relief rests for a second.
  for (int i = 0; i < 2000 && checks < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(2, checks);
  EXPECT_EQ(std::future_status::timeout, waiting.wait_for(std::chrono::milliseconds(50)));
  gate.open();
  EXPECT_EQ((std::vector<std::uint8_t>{1}), waiting.get().result.valid);
  EXPECT_EQ(kSmall, slow.get().result.valid.size());
  EXPECT_EQ(0U, relieved.statistics().errors);
}

TEST_F(Server, EveryAnswerBelongsToTheRevisionThatItNames)
{
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0};
  std::atomic<int> answers{0};
  std::vector<std::thread> clients;
  for (int client = 0; client < 4; ++client)
    clients.emplace_back(
        [&, client]
        {
          while (!done)
          {
            const std::uint64_t before = store.snapshot().scene->revision;
            const CheckAnswer answer =
                server.submit(job(client == 0 ? kSmall + 1 : 2, client % 2 == 0 ? 1.0 : -1.0)).get();
            const bool free = client % 2 == 0 && answer.result.revision % 2 == 0;
            wrong += answer.result.revision < before || answer.result.revision != answer.scene->revision ? 1 : 0;
            for (const std::uint8_t valid : answer.result.valid)
              wrong += valid == (free ? 1 : 0) ? 0 : 1;
            ++answers;
          }
        });
  while (answers < 200)
    rename("scene " + std::to_string(answers));
  done = true;
  for (std::thread& client : clients)
    client.join();
  EXPECT_EQ(0, wrong);
}
}  // namespace
}  // namespace gpu_planning_scene::core
