// Messages are read from bytes. No ROS master is needed.

#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>

#include "node/endpoints/bounded_message.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
namespace
{
using Bytes = std::vector<std::uint8_t>;

template <class M>
Bytes bytesOf(const M& message)
{
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

// The error of readBounded for the bytes; "" if it accepts them. Other exceptions fail the test.
template <class M>
std::string faultOfReading(const Bytes& bytes, M& message)
{
  try
  {
    readBounded(bytes.data(), static_cast<std::uint32_t>(bytes.size()), message);
    return "";
  }
  catch (const std::length_error& error)
  {
    ADD_FAILURE() << "memory was asked for: " << error.what();
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "not a runtime_error";
}

// A request with every kind of field: strings, times, nested messages, arrays of fixed and variable length.
ApplyPlanningScene::Request fullRequest()
{
  ApplyPlanningScene::Request request;
  request.scene.name = "cell";
  request.scene.is_diff = true;
  request.scene.robot_state.joint_state.name = {"a", "b"};
  request.scene.robot_state.joint_state.position = {0.25, -1.5};
  request.scene.robot_state.multi_dof_joint_state.joint_names = {"base"};
  request.scene.robot_state.multi_dof_joint_state.transforms.resize(1);
  request.scene.allowed_collision_matrix.entry_names = {"a", "b"};
  request.scene.allowed_collision_matrix.entry_values.resize(2);
  request.scene.allowed_collision_matrix.entry_values[1].enabled = {true, false};
  CollisionObject object;
  object.header.frame_id = "world";
  object.header.stamp = ros::Time(12, 34);
  object.id = "box";
  object.primitives.resize(2);
  object.primitives[1].dimensions = {0.1, 0.2, 0.3};
  object.meshes.resize(1);
  object.meshes[0].triangles.resize(2);
  object.meshes[0].triangles[1].vertex_indices = {{1, 2, 3}};
  object.meshes[0].vertices.resize(4);
  object.planes.resize(1);
  object.planes[0].coef = {{0.0, 0.0, 1.0, -2.0}};
  request.scene.world.collision_objects = {object, object};
  return request;
}

sensor_msgs::PointCloud2 cloud()
{
  sensor_msgs::PointCloud2 message;
  message.fields.resize(3);
  message.fields[1].name = "y";
  message.data = Bytes(1000, 7);
  return message;
}

class BoundedMessage : public ::testing::Test
{
 protected:
  ~BoundedMessage() override { setMessageLimit(256U << 20); }
};

template <class M>
void expectTheSameAsRoscpp(const M& message)
{
  const Bytes bytes = bytesOf(message);
  M read;
  EXPECT_EQ(faultOfReading(bytes, read), "");
  EXPECT_EQ(bytesOf(read), bytes);
}

TEST_F(BoundedMessage, ReadsWhatRoscppWrites)
{
  expectTheSameAsRoscpp(fullRequest());
  expectTheSameAsRoscpp(cloud());
  expectTheSameAsRoscpp(ApplyPlanningScene::Request());
  sensor_msgs::JointState joints;
  joints.header.stamp = ros::Time(1, 2);
  joints.name = {"", "a"};
  joints.effort = {1.0};
  expectTheSameAsRoscpp(joints);
}

TEST_F(BoundedMessage, EveryTruncatedMessageIsRefused)
{
  const Bytes bytes = bytesOf(fullRequest());
  for (std::size_t size = 0; size < bytes.size(); ++size)
  {
    ApplyPlanningScene::Request request;
    EXPECT_NE(faultOfReading(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)), request), "")
        << size;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  ApplyPlanningScene::Request request;
  EXPECT_NE(faultOfReading(longer, request), "");
}

TEST_F(BoundedMessage, WrongLengthsAllocateNoMemory)
{
  const Bytes bytes = bytesOf(fullRequest());
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 4 <= bytes.size(); ++at)
    for (const std::uint8_t value : {0x7f, 0xff})
    {
      Bytes wrong = bytes;
      std::fill_n(wrong.begin() + static_cast<std::ptrdiff_t>(at), 4, value);
      ApplyPlanningScene::Request request;
      refused += faultOfReading(wrong, request).empty() ? 0 : 1;
      EXPECT_LT(request.scene.world.collision_objects.capacity(), 1000u);
      EXPECT_LT(request.scene.robot_state.joint_state.position.capacity(), 1000u);
    }
  EXPECT_GT(refused, 100u);
}

TEST_F(BoundedMessage, TheLimitIsHeldAndItsParameterNamed)
{
  const Bytes bytes = bytesOf(cloud());
  sensor_msgs::PointCloud2 message;
  setMessageLimit(static_cast<std::uint32_t>(bytes.size()));
  EXPECT_EQ(faultOfReading(bytes, message), "");
  setMessageLimit(static_cast<std::uint32_t>(bytes.size()) - 1);
  EXPECT_NE(faultOfReading(bytes, message).find("~limits/message_size"), std::string::npos);
}

TEST_F(BoundedMessage, RoscppTakesItForTheMessage)
{
  using ros::message_traits::DataType;
  using ros::message_traits::MD5Sum;
  EXPECT_STREQ(MD5Sum<Bounded<sensor_msgs::PointCloud2>>::value(), MD5Sum<sensor_msgs::PointCloud2>::value());
  EXPECT_STREQ(DataType<Bounded<sensor_msgs::PointCloud2>>::value(), "sensor_msgs/PointCloud2");
  Bytes bytes = bytesOf(cloud());
  ros::serialization::IStream good(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  Bounded<sensor_msgs::PointCloud2> bounded;
  ros::serialization::deserialize(good, bounded);
  EXPECT_EQ(bounded.fault, "");
  EXPECT_EQ(bounded.message.data.size(), 1000u);
  ros::serialization::IStream bad(bytes.data(), static_cast<std::uint32_t>(bytes.size()) - 1);
  ros::serialization::deserialize(bad, bounded);
  EXPECT_NE(bounded.fault, "");
  EXPECT_TRUE(bounded.message.data.empty());
}

TEST_F(BoundedMessage, AServiceAnswersAFaultyRequest)
{
  auto handler = [](Bounded<Clear::Request>& request, Clear::Response& response)
  {
    response.success = request.fault.empty();
    response.message = request.fault;
    return true;
  };
  const ros::AdvertiseServiceOptions options = boundedService<Clear>("clear", handler, nullptr);
  EXPECT_EQ(options.md5sum, ros::service_traits::md5sum<Clear>());
  const auto call = [&](std::size_t size)
  {
    ros::ServiceCallbackHelperCallParams parameters;
    const boost::shared_array<std::uint8_t> buffer(new std::uint8_t[size + 1]());
    parameters.request = ros::SerializedMessage(buffer, size);
    parameters.request.message_start = buffer.get();
    EXPECT_TRUE(options.helper->call(parameters));
    constexpr std::size_t kHeader = 5;  // of an answer: its success flag and its length
    Clear::Response response;
    ros::serialization::IStream stream(parameters.response.buf.get() + kHeader,
                                       static_cast<std::uint32_t>(parameters.response.num_bytes - kHeader));
    ros::serialization::deserialize(stream, response);
    return response;
  };
  EXPECT_TRUE(call(0).success);
  EXPECT_FALSE(call(5).success) << "a request with bytes too many";
}
}  // namespace
}  // namespace gpu_planning_scene::core
