// The answers that a client gets from a service that fails or contradicts itself. The endpoints are in this process.

#include <functional>

#include "node/endpoints/diagnostics.h"
#include "node/endpoints/endpoints.h"
#include "node/node_client.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Advertises `Service` for one call, and returns what the client gets.
template <class Service>
typename Service::Response answerWith(const std::function<typename Service::Response()>& answer)
{
  static int number = 0;
  const std::string name = "service_" + std::to_string(++number);
  Diagnostics diagnostics;
  Endpoints endpoints(ros::NodeHandle(), ros::NodeHandle("~"), 1, diagnostics);
  endpoints.advertise<Service>(name, [&answer](const typename Service::Request&) { return answer(); });
  Service call;
  EXPECT_TRUE(ros::service::call(ros::NodeHandle("~").resolveName(name), call));
  return call.response;
}

TEST(EndpointsOfServices, AnErrorIsAStatusAndAMessage)
{
  const auto fail = []() -> Clear::Response { throw Unavailable("later"); };
  const Clear::Response cleared = answerWith<Clear>(fail);
  EXPECT_FALSE(cleared.success);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, cleared.status);
  EXPECT_EQ("later", cleared.message);
  const auto lose = []() -> GetPlanningScene::Response { throw std::bad_alloc(); };
  const GetPlanningScene::Response scene = answerWith<GetPlanningScene>(lose);
  EXPECT_FALSE(scene.success);
  EXPECT_EQ(AnswerStatus::OUT_OF_MEMORY, scene.status);
  EXPECT_TRUE(scene.scene.is_diff) << "a full scene without objects must not come back to a node";
}

TEST(EndpointsOfServices, ClientsThatReadTheStatusAndClientsThatReadTheSuccessGetTheSameAnswer)
{
  for (const bool success : {false, true})
    for (const int status : {0, AnswerStatus::OK + 0, AnswerStatus::BUSY + 0})
    {
      Clear::Response made;
      made.success = success;
      made.status = static_cast<std::uint8_t>(status);
      const Clear::Response got = answerWith<Clear>([&made] { return made; });
      EXPECT_EQ(got.success != 0, got.status == AnswerStatus::OK);
      if (success == (status == AnswerStatus::OK) && status != 0)
        EXPECT_EQ(status, got.status);
      else
        EXPECT_EQ(AnswerStatus::INTERNAL_ERROR, got.status) << got.message;
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
