#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <ros/init.h>
#include <ros/network.h>
#include <ros/serialization.h>

#include "bindings/interrupt.h"
#include "gpu_planning_scene/client/sharded_checker.h"
#include "gpu_planning_scene/error.h"

// The extension module _client: ShardedChecker, with serialised messages, for sharded_checker.py. It is apart from
// _core, which needs no ROS.
namespace gpu_planning_scene::python
{
namespace
{
namespace py = pybind11;
using core::ShardedChecker;

constexpr std::chrono::milliseconds kLook{20};  // between two looks at a running call
constexpr std::chrono::seconds kLongestEnd{2};  // for the calls that run when the interpreter ends

/// The calls of all threads. When the interpreter ends, it must wait for them: a thread that then came back would find
/// no interpreter, and the system would end the process with an error.
class RunningCalls
{
 public:
  /// A call, from its begin to its end. Both with the interpreter's lock.
  class Guard
  {
   public:
    Guard() { ++count; }
    ~Guard() { --count; }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
  };

  static bool areToEnd() { return are_to_end; }
  /// Throws RuntimeError.
  static void requireNoEnd()
  {
    if (are_to_end)
      throw std::runtime_error("the interpreter ends, so the call has no answer");
  }
  /// Ends all calls, also later ones.
  static void end()
  {
    are_to_end = true;
    const py::gil_scoped_release released;
    const auto last = std::chrono::steady_clock::now() + kLongestEnd;
    while (count != 0 && std::chrono::steady_clock::now() < last)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  static inline std::atomic<bool> are_to_end{false};
  static inline std::atomic<int> count{0};
};

/// The remappings among the arguments of the command line, for example "__ns:=/cell". Values of private parameters, for
/// example "_rate:=10", are not for this client: roscpp would set them below another name than rospy's.
ros::VP_string remappingsOf(const std::vector<std::string>& arguments)
{
  ros::VP_string remappings;
  for (const std::string& argument : arguments)
    if (const std::size_t middle = argument.find(":=");
        middle != std::string::npos && (argument[0] != '_' || argument[1] == '_'))
      remappings.emplace_back(argument.substr(0, middle), argument.substr(middle + 2));
  return remappings;
}

/// Initialises roscpp, unless another module has done so. The client needs only its names and the master's address. No
/// NodeHandle starts a second node beside that of rospy. Throws ValueError.
void initialiseRos(const std::vector<std::string>& arguments)
{
  if (ros::isInitialized())
    return;
  const ros::VP_string remappings = remappingsOf(arguments);
  const char* variable = std::getenv("ROS_MASTER_URI");
  std::string master = variable != nullptr ? variable : "http://localhost:11311";
  for (const auto& [name, value] : remappings)
    if (name == "__master")
      master = value;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(master, host, port))  // roscpp would end the process
    throw py::value_error("the address of the master '" + master + "' has no host and port; set ROS_MASTER_URI");
  ros::init(remappings, "gpu_planning_scene_client",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
}

std::unique_ptr<ShardedChecker> makeChecker(const std::vector<std::string>& nodes, std::size_t part_states,
                                            double timeout, double patience, const std::vector<std::string>& arguments)
{
  initialiseRos(arguments);
  core::ShardedCheckerOptions options;
  options.part_states = part_states;
  options.timeout = timeout;
  options.patience = patience;
  try
  {
    return std::make_unique<ShardedChecker>(nodes, options);
  }
  catch (const core::Error& fault)
  {
    throw py::value_error(fault.what());
  }
}

ShardedChecker::Request requestOf(std::string_view bytes)
{
  // The stream only reads, although its type does not say so.
  auto* begin = reinterpret_cast<std::uint8_t*>(const_cast<char*>(bytes.data()));
  ros::serialization::IStream stream(begin, static_cast<std::uint32_t>(bytes.size()));
  ShardedChecker::Request request;
  ros::serialization::deserialize(stream, request);
  return request;
}

/// Without a length before it.
ros::SerializedMessage bytesOf(const ShardedChecker::Response& response)
{
  ros::SerializedMessage message = ros::serialization::serializeMessage(response);
  message.num_bytes -= static_cast<std::size_t>(message.message_start - message.buf.get());
  return message;
}

/// Answers a request in a thread of its own, while this thread lets Python run the handlers of signals.
py::bytes check(ShardedChecker& checker, const py::bytes& request)
{
  RunningCalls::requireNoEnd();
  const RunningCalls::Guard running;
  const std::string_view bytes(PyBytes_AS_STRING(request.ptr()),
                               static_cast<std::size_t>(PyBytes_GET_SIZE(request.ptr())));
  Interrupt interrupt;
  ros::SerializedMessage answer;
  {
    const py::gil_scoped_release released;
    std::atomic<bool> is_cancelled{false};
    auto call = std::async(
        std::launch::async, [&]
        { return bytesOf(checker.check(requestOf(bytes), [&] { return is_cancelled || RunningCalls::areToEnd(); })); });
    while (call.wait_for(kLook) != std::future_status::ready)
      is_cancelled = interrupt.requested();
    try
    {
      answer = call.get();
    }
    catch (const core::Cancelled&)
    {
      // It has no answer, and the exception of the interrupt tells why.
    }
  }
  interrupt.rethrow();
  RunningCalls::requireNoEnd();
  return {reinterpret_cast<const char*>(answer.message_start), answer.num_bytes};
}
}  // namespace
}  // namespace gpu_planning_scene::python

PYBIND11_MODULE(_client, module)
{
  using namespace gpu_planning_scene::python;
  py::class_<ShardedChecker>(module, "Client")
      .def(py::init(&makeChecker), py::arg("nodes"), py::kw_only(), py::arg("part_states"), py::arg("timeout"),
           py::arg("patience"), py::arg("arguments"))
      .def("check", &check, py::arg("request"));
  py::module_::import("atexit").attr("register")(py::cpp_function(&RunningCalls::end));
}
