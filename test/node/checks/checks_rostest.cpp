// check_states, check_motions and get_report: contacts, clearances, fractions of motions and the report.

#include <limits>
#include <set>

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Checks : public RunningNode
{
 public:
  static CheckMotions::Request motion(const std::vector<double>& start, const std::vector<double>& end)
  {
    CheckMotions::Request request;
    request.joint_names = stateRequest(start).joint_names;
    request.starts = start;
    request.ends = end;
    request.resolution = 0.02;
    request.translation_resolution = 0.02;
    return request;
  }
};

TEST_F(Checks, ContactsAreThoseOfTheReportedBodies)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  CheckStates::Request request = stateRequest(free_state);
  request.max_contacts = 3;
  const auto response = call<CheckStates>("check_states", request);
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_FALSE(response.contacts.empty());
  EXPECT_LE(response.contacts.size(), 3u);
  for (const ContactInformation& contact : response.contacts)
  {
    EXPECT_EQ("box", contact.contact_body_2);
    EXPECT_EQ(ContactInformation::ROBOT_LINK, contact.body_type_1);
    EXPECT_EQ(ContactInformation::WORLD_OBJECT, contact.body_type_2);
    EXPECT_GE(contact.depth, 0.0);
    const Eigen::Vector3d point(contact.position.x, contact.position.y, contact.position.z);
    EXPECT_LT((point - tipPoint()).norm(), 0.05);
    EXPECT_NEAR(1.0, Eigen::Vector3d(contact.normal.x, contact.normal.y, contact.normal.z).norm(), 1e-6);
    EXPECT_EQ(0u, contact.state);
  }
  request.max_contacts = 100;
  request.max_contacts_per_pair = 1;
  std::set<std::string> pairs;
  for (const ContactInformation& contact : call<CheckStates>("check_states", request).contacts)
    EXPECT_TRUE(pairs.insert(contact.contact_body_1 + " " + contact.contact_body_2).second) << *pairs.rbegin();
  EXPECT_FALSE(pairs.empty());
}

TEST_F(Checks, ClearanceIsTheDistanceToTheWorldAndToItself)
{
  CheckStates::Request request = stateRequest(free_state);
  request.clearance = true;
  auto response = call<CheckStates>("check_states", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(std::numeric_limits<double>::infinity(), response.clearance_world.at(0)) << "there is no world";
  EXPECT_GT(response.clearance_self.at(0), 0.0);
  apply(diffWith(boxObject("box", tipPoint() + Eigen::Vector3d(0.0, 0.0, 10.0), 0.02)));
  response = call<CheckStates>("check_states", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_GT(response.clearance_world.at(0), 7.0);
  EXPECT_LT(response.clearance_world.at(0), 10.0);
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_EQ(0.0, call<CheckStates>("check_states", request).clearance_world.at(0));
}

TEST_F(Checks, AMotionIsFreeUntilItsFirstCollision)
{
  std::vector<double> end = free_state;
  end[0] += end[0] > 0.0 ? -0.5 : 0.5;
  auto request = motion(free_state, free_state);
  auto response = call<CheckMotions>("check_motions", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1}), response.valid);
  EXPECT_EQ((std::vector<double>{1.0}), response.last_valid_fraction);

  const Eigen::Vector3d in_link = linkPose(tip, free_state).inverse() * tipPoint();
  apply(diffWith(boxObject("box", linkPose(tip, end) * in_link, 0.02)));
  ASSERT_TRUE(isFree());
  request = motion(free_state, end);
  request.starts.insert(request.starts.end(), end.begin(), end.end());
  request.ends.insert(request.ends.end(), free_state.begin(), free_state.end());
  response = call<CheckMotions>("check_motions", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), response.valid);
  EXPECT_LT(response.last_valid_fraction.at(0), 1.0);
  EXPECT_GT(response.first_invalid_fraction.at(0), response.last_valid_fraction.at(0));
  EXPECT_EQ(0.0, response.last_valid_fraction.at(1)) << "its start collides";
  EXPECT_EQ(0.0, response.first_invalid_fraction.at(1));
  EXPECT_FALSE(response.body_1.at(0).empty());
  EXPECT_GE(response.states_checked, 2u * 25u);
}

TEST_F(Checks, ATrajectoryHasTheVerdictsOfItsWaypointsAndMotions)
{
  std::vector<double> end = free_state;
  end[0] += end[0] > 0.0 ? -0.5 : 0.5;
  const Eigen::Vector3d in_link = linkPose(tip, free_state).inverse() * tipPoint();
  apply(diffWith(boxObject("box", linkPose(tip, end) * in_link, 0.02)));
  ASSERT_TRUE(isFree());
  std::vector<double> beside = free_state;
  beside[0] += end[0] > free_state[0] ? -0.2 : 0.2;

  CheckTrajectory::Request request;
  request.joint_trajectory.joint_names = {stateRequest(free_state).joint_names[0]};
  request.joint_trajectory.points.resize(3);
  request.joint_trajectory.points[0].positions = {beside[0]};
  request.joint_trajectory.points[1].positions = {end[0]};
  request.joint_trajectory.points[2].positions = {free_state[0]};
  request.resolution = request.translation_resolution = 0.02;
  const auto response = call<CheckTrajectory>("check_trajectory", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_TRUE(response.start_valid) << "it starts at the current state";
  EXPECT_FALSE(response.valid);

  const std::vector<std::vector<double>> path = {free_state, beside, end, free_state};
  for (std::size_t i = 0; i < 3; ++i)
  {
    EXPECT_EQ(check(path[i + 1]).valid.at(0), response.waypoint_valid.at(i)) << i;
    const auto part = call<CheckMotions>("check_motions", motion(path[i], path[i + 1]));
    EXPECT_EQ(part.valid.at(0), response.part_valid.at(i)) << i;
    EXPECT_EQ(part.first_invalid_fraction.at(0), response.first_invalid_fraction.at(i)) << i;
    EXPECT_EQ(part.last_valid_fraction.at(0), response.last_valid_fraction.at(i)) << i;
  }
  EXPECT_EQ(0, response.waypoint_valid.at(1));
  EXPECT_EQ(scene().scene_revision, response.scene_revision);
  request.joint_trajectory.points[1].positions.clear();
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, call<CheckTrajectory>("check_trajectory", request).status);
}

TEST_F(Checks, ASceneDiffCountsForItsRequestAlone)
{
  const PlanningSceneMessage before = scene();
  CheckStates::Request request = stateRequest(free_state);
  request.nearest = 1;
  request.scene_diff = diffWith(boxObject("box", tipPoint(), 0.02));
  const auto changed = call<CheckStates>("check_states", request);
  ASSERT_TRUE(changed.success) << changed.message;
  EXPECT_EQ((std::vector<std::uint8_t>{0}), changed.valid);
  EXPECT_EQ("box", changed.nearest_world.at(0).body_2);
  EXPECT_LE(changed.nearest_world.at(0).distance, 0.0);
  EXPECT_EQ(before.scene_revision, changed.scene_revision);
  EXPECT_EQ(before, scene());
  EXPECT_TRUE(isFree());

  const std::uint64_t revision = apply(request.scene_diff);
  request.scene_diff = PlanningSceneMessage();
  const auto applied = call<CheckStates>("check_states", request);
  EXPECT_EQ(changed.valid, applied.valid);
  EXPECT_EQ(changed.nearest_world, applied.nearest_world);
  EXPECT_EQ(revision, applied.scene_revision);
  request.scene_diff = diffWith(objectOperation("box", CollisionObject::REMOVE));
  EXPECT_EQ((std::vector<std::uint8_t>{1}), call<CheckStates>("check_states", request).valid);
}

TEST_F(Checks, WrongMotionsAreRefused)
{
  auto request = motion(free_state, free_state);
  request.resolution = 0.0;
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, call<CheckMotions>("check_motions", request).status);
  request = motion(free_state, free_state);
  request.ends.pop_back();
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, call<CheckMotions>("check_motions", request).status);
}

TEST_F(Checks, TheReportListsModelledAndOmittedParts)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  const auto response = call<GetReport>("get_report", GetReport::Request());
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_EQ(response.names.size(), response.values.size());
  double world_pairs = 0.0;
  for (std::size_t i = 0; i < response.names.size(); ++i)
    if (response.names[i] == "world_pairs")
      world_pairs = response.values[i];
  EXPECT_GT(world_pairs, 0.0);
  EXPECT_GE(response.lines.size(), 5u);
  EXPECT_EQ(scene().scene_revision, response.scene_revision);
  GetReport::Request unknown;
  unknown.group = "no such group";
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, call<GetReport>("get_report", unknown).status);
}
}  // namespace
}  // namespace gpu_planning_scene::core
