// MoveIt's messages are read as ours and written back. No ROS master is needed.

#include <functional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/bounded_message.h"
#include "node/moveit/layouts.h"
#include "node/moveit/moveit_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Fills all fields of a message with different values, in the order of the fields. Arrays get two elements.
class Filler
{
 public:
  template <class T>
  std::enable_if_t<std::is_arithmetic_v<T>> next(T& value)
  {
    value = static_cast<T>(++count_);
  }
  template <class T>
  std::enable_if_t<ros::message_traits::IsMessage<T>::value> next(T& message)
  {
    ros::serialization::Serializer<T>::template allInOne<Filler, T&>(*this, message);
  }
  template <class T, std::size_t N>
  void next(boost::array<T, N>& values)
  {
    for (T& value : values)
      next(value);
  }
  template <class T, class Allocator>
  void next(std::vector<T, Allocator>& values)
  {
    values.resize(2);
    for (T& value : values)
      next(value);
  }
  void next(std::string& text) { text = "text " + std::to_string(++count_); }
  void next(ros::Time& time) { time = ros::Time(++count_, 5); }
  void next(ros::Duration& time) { time = ros::Duration(static_cast<std::int32_t>(++count_), 5); }

  std::uint32_t count() const { return count_; }

 private:
  std::uint32_t count_ = 0;
};

template <class Message>
Message filled(std::uint32_t* count = nullptr)
{
  Message message;
  Filler filler;
  filler.next(message);
  if (count != nullptr)
    *count = filler.count();
  return message;
}

template <class Message>
std::vector<std::uint8_t> bytesOf(const Message& message)
{
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  EXPECT_EQ(0U, stream.getLength());
  return bytes;
}

/// MoveIt's message with a value in every field is read as ours, with bounds and without, and written back.
template <class Ours, class Theirs>
AsMoveIt<Ours, Theirs> expectSameBothWays(const Theirs& theirs)
{
  using Read = AsMoveIt<Ours, Theirs>;
  std::vector<std::uint8_t> bytes = bytesOf(theirs);
  Read plain;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, plain);
  EXPECT_EQ(0U, stream.getLength());
  EXPECT_EQ(bytes, bytesOf(plain));
  Read bounded;
  readBounded(bytes.data(), static_cast<std::uint32_t>(bytes.size()), bounded);
  EXPECT_EQ(bytes, bytesOf(bounded));
  EXPECT_STREQ(ros::message_traits::md5sum<Theirs>(), ros::message_traits::md5sum<Read>());
  EXPECT_STREQ(ros::message_traits::datatype<Theirs>(), ros::message_traits::datatype<Read>());
  EXPECT_STREQ(ros::message_traits::definition<Theirs>(), ros::message_traits::definition<Read>());
  return bounded;
}

TEST(MoveItMessages, EveryFieldOfASceneIsReadAndWrittenBack)
{
  std::uint32_t fields = 0;
  const auto theirs = filled<moveit_msgs::PlanningScene>(&fields);
  EXPECT_GT(fields, 500U);
  const PlanningSceneMessage ours = expectSameBothWays<PlanningSceneMessage, moveit_msgs::PlanningScene>(theirs).ours;
  // Our message, filled in the order of its own fields, has the same bytes, but for its own fields at its end.
  const auto own_message = filled<PlanningSceneMessage>();
  std::vector<std::uint8_t> own = bytesOf(own_message);
  own.resize(own.size() - 3 * sizeof(std::uint64_t) - bytesOf(own_message.exact_places).size() -
             bytesOf(own_message.exact_values).size() - bytesOf(own_message.octomap_fault).size() -
             bytesOf(own_message.solids).size());
  EXPECT_EQ(bytesOf(theirs), own);
  EXPECT_EQ(0U, ours.scene_revision);
  EXPECT_EQ(0U, ours.previous_revision);
}

TEST(MoveItMessages, FieldsKeepTheirNames)
{
  const auto theirs = filled<moveit_msgs::PlanningScene>();
  const PlanningSceneMessage ours = expectSameBothWays<PlanningSceneMessage, moveit_msgs::PlanningScene>(theirs).ours;
  EXPECT_EQ(theirs.name, ours.name);
  EXPECT_EQ(theirs.robot_model_name, ours.robot_model_name);
  EXPECT_EQ(theirs.is_diff, ours.is_diff);
  EXPECT_EQ(theirs.robot_state.joint_state.effort.at(1), ours.robot_state.joint_state.effort.at(1));
  EXPECT_EQ(theirs.robot_state.is_diff, ours.robot_state.is_diff);
  EXPECT_EQ(theirs.fixed_frame_transforms.at(1).child_frame_id, ours.fixed_frame_transforms.at(1).child_frame_id);
  EXPECT_EQ(theirs.allowed_collision_matrix.default_entry_names, ours.allowed_collision_matrix.default_entry_names);
  EXPECT_EQ(theirs.link_padding.at(1).padding, ours.link_padding.at(1).padding);
  EXPECT_EQ(theirs.link_scale.at(1).scale, ours.link_scale.at(1).scale);
  EXPECT_EQ(theirs.object_colors.at(1).color.a, ours.object_colors.at(1).color.a);
  const auto& their_object = theirs.world.collision_objects.at(1);
  const CollisionObject& object = ours.world.collision_objects.at(1);
  EXPECT_EQ(their_object.id, object.id);
  EXPECT_EQ(their_object.type.key, object.type.key);
  EXPECT_EQ(their_object.type.db, object.type.db);
  EXPECT_EQ(their_object.mesh_poses.at(1).orientation.w, object.mesh_poses.at(1).orientation.w);
  EXPECT_EQ(their_object.planes.at(1).coef, object.planes.at(1).coef);
  EXPECT_EQ(their_object.subframe_names, object.subframe_names);
  EXPECT_EQ(their_object.operation, object.operation);
  const auto& their_attached = theirs.robot_state.attached_collision_objects.at(1);
  const AttachedCollisionObject& attached = ours.robot_state.attached_collision_objects.at(1);
  EXPECT_EQ(their_attached.link_name, attached.link_name);
  EXPECT_EQ(their_attached.touch_links, attached.touch_links);
  EXPECT_EQ(their_attached.detach_posture.points.at(1).positions, attached.detach_posture.points.at(1).positions);
  EXPECT_EQ(their_attached.weight, attached.weight);
  EXPECT_EQ(theirs.world.octomap.origin.position.z, ours.world.octomap.origin.position.z);
  EXPECT_EQ(theirs.world.octomap.octomap.id, ours.world.octomap.octomap.id);
  EXPECT_EQ(theirs.world.octomap.octomap.resolution, ours.world.octomap.octomap.resolution);
  EXPECT_EQ(theirs.world.octomap.octomap.data, ours.world.octomap.octomap.data);
}

TEST(MoveItMessages, EveryFieldOfTheOtherMessagesIsReadAndWrittenBack)
{
  expectSameBothWays<CollisionObject>(filled<moveit_msgs::CollisionObject>());
  expectSameBothWays<AttachedCollisionObject>(filled<moveit_msgs::AttachedCollisionObject>());
  expectSameBothWays<PlanningSceneWorld>(filled<moveit_msgs::PlanningSceneWorld>());
  expectSameBothWays<GetPlanningScene::Request>(filled<moveit_msgs::GetPlanningScene::Request>());
  expectSameBothWays<PlanningSceneMessage>(filled<moveit_msgs::GetPlanningScene::Response>());
  expectSameBothWays<PlanningSceneMessage>(filled<moveit_msgs::ApplyPlanningScene::Request>());
  const auto theirs = filled<moveit_msgs::GetStateValidity::Request>();
  const StateValidityRequest ours = expectSameBothWays<StateValidityRequest>(theirs).ours;
  EXPECT_EQ(theirs.group_name, ours.group_name);
  EXPECT_EQ(theirs.robot_state.attached_collision_objects.at(1).object.id,
            ours.robot_state.attached_collision_objects.at(1).object.id);
}

TEST(MoveItMessages, AMessageThatEndsEarlyIsRefused)
{
  const std::vector<std::uint8_t> bytes = bytesOf(filled<moveit_msgs::PlanningScene>());
  MoveItScene read;
  EXPECT_THROW(readBounded(bytes.data(), static_cast<std::uint32_t>(bytes.size() - 1), read), std::runtime_error);
}

TEST(MoveItMessages, TheLayoutsOfThisBuildAreEqual)
{
  EXPECT_NO_THROW(requireMoveItLayouts());
}

/// The message of the error for two layouts; empty if they are equal.
std::string refusalOf(const LayoutPair& pair)
{
  try
  {
    requireEqualLayouts(pair);
    return "";
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

TEST(MoveItMessages, AFieldMoreInAnyPartOfAMoveItMessageIsRefused)
{
  std::set<std::string> names;
  for (LayoutPair pair : moveItLayouts())
  {
    names.insert(pair.name);
    const std::string definition = pair.theirs + "\n====\n";
    for (std::size_t end = definition.find("\n===="); end != std::string::npos;
         end = definition.find("\n====", end + 1))
    {
      pair.theirs = definition;
      pair.theirs.insert(end, "\nbool added");
      EXPECT_EQ(0U, refusalOf(pair).rfind(pair.name + " has 'bool ", 0)) << pair.theirs.substr(0, end + 20);
    }
  }
  EXPECT_EQ((std::set<std::string>{"moveit_msgs/ApplyPlanningSceneRequest", "moveit_msgs/AttachedCollisionObject",
                                   "moveit_msgs/CollisionObject", "moveit_msgs/GetPlanningSceneRequest",
                                   "moveit_msgs/GetPlanningSceneResponse", "moveit_msgs/GetStateValidityRequest",
                                   "moveit_msgs/PlanningScene", "moveit_msgs/PlanningSceneWorld"}),
            names);
}

TEST(Layouts, NamesOfPackagesAndOfEqualTypesDoNotCount)
{
  const std::string ours = "Item[] items # the items\nbyte ADD=0\nbyte operation\n====\nMSG: ours/Item\nstring id\n";
  const std::string theirs = "theirs/Item[] items\nint8 ADD = 0\nint8 operation\n====\nMSG: theirs/Item\nstring id\n";
  EXPECT_EQ((std::vector<std::string>{"Item[] items", "string items.id", "int8 ADD=0", "int8 operation"}),
            layoutOf(ours));
  EXPECT_NO_THROW(requireEqualLayouts({"theirs/Items", ours, theirs, ""}));
}

TEST(Layouts, OfATypeThatIsDefinedTwiceTheFirstDefinitionCounts)
{
  EXPECT_EQ((std::vector<std::string>{"Item item", "string item.id"}),
            layoutOf("Item item\n====\nMSG: a/Item\nstring id\n====\nMSG: a/Item\nstring id\n"));
}

TEST(Layouts, ADifferentLayoutIsRefusedWithBothFields)
{
  const std::string ours = "string id\nfloat64 weight\nuint32 KIND=1\nuint64 revision\n";
  const auto refusal = [&ours](const std::string& theirs) {
    return refusalOf({"theirs/Item", ours, theirs, "revision"});
  };
  EXPECT_EQ("", refusal("string id\nfloat64 weight\nuint32 KIND=1\n"));
  EXPECT_EQ(0U,
            refusal("string id\nfloat32 weight\nuint32 KIND=1\n")
                .rfind("theirs/Item has 'float32 weight' where the message of this package has 'float64 weight'", 0));
  EXPECT_NE("", refusal("float64 weight\nstring id\nuint32 KIND=1\n")) << "another order";
  EXPECT_NE("", refusal("string name\nfloat64 weight\nuint32 KIND=1\n")) << "another name";
  EXPECT_NE("", refusal("string id\nfloat64 weight\nuint32 KIND=2\n")) << "another constant";
  EXPECT_NE("", refusal("string id\nfloat64 weight\nuint32 KIND=1\nbool flag\n")) << "a further field";
  EXPECT_NE("", refusal("string id\nfloat64 weight\n")) << "a field less";
  EXPECT_NE("", refusal("string id\nUnknown weight\nuint32 KIND=1\n")) << "a type without definition";
}
}  // namespace
}  // namespace gpu_planning_scene::core
