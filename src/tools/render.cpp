// render: draws a robot in its scene, with colliding bodies in red, as a PNG file.

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <random>
#include <sstream>
#include <string_view>

#include "collision/report/scene_text.h"
#include "command_line/robot_arguments.h"
#include "command_line/scene_arguments.h"
#include "gpu_planning_scene/state_inspector.h"
#include "render/drawing.h"
#include "render/renderer.h"
#include "tools/state_values.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxContacts = 200;

std::vector<Option> options()
{
  std::vector<Option> all = robotOptions();
  for (const Option& option : sceneOptions())
    all.push_back(option);
  all.push_back({"--state", "ITEM,...",
                 "items NAME=VALUE (a variable) and names of states of the\nSRDF (ready, or GROUP/ready); other "
                 "variables have the values\nof the scene's state, or their defaults"});
  all.push_back({"--random", "SEED",
                 "a random state instead, within the joints' limits; planar\nand floating joints stay where they are"});
  all.push_back({"--camera", "X,Y,Z[,X,Y,Z]",
                 "camera position and target; default: the view that shows\nmost of each link, of the colliding parts "
                 "and of the\ncontact points"});
  all.push_back({"--up", "X,Y,Z", "upward direction (default 0,0,1)"});
  all.push_back({"--size", "WxH", "pixels (default 960x720)"});
  all.push_back({"--device", "DEVICE", "auto (default), software, an index, or part of a renderer's name"});
  all.push_back({"--out", "FILE", "the PNG file to write"});
  return all;
}

std::vector<double> stateFrom(const CommandLine& arguments, const PlanningScene& scene)
{
  std::vector<double> state = startState(scene);
  if (arguments.has("--random"))
  {
    std::mt19937_64 generator(arguments.count("--random", 0, 0, 1ULL << 32));
    randomise(*scene.robot, generator, startState(scene), true, state.data());
  }
  if (arguments.has("--state"))
    if (const std::string warning =
            setValues(*scene.robot, arguments.value("--state", ""), !scene.current_state.empty(), state).warning;
        !warning.empty())
      printWarnings({warning});
  return state;
}

/// "X,Y,Z", to the millimetre.
std::string textOf(const Eigen::Vector3d& point)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << point.x() << "," << point.y() << "," << point.z();
  return text.str();
}

Camera cameraFrom(const CommandLine& arguments, const PlanningScene& scene, const double* state,
                  const std::vector<BodyPair>& colliding, const std::vector<Eigen::Vector3d>& contact_points)
{
  const std::vector<double> up = numbersFrom("--up", arguments.value("--up", "0,0,1"), 3);
  const Eigen::Vector3d upward(up.data());
  if (upward.norm() == 0.0)
    throw UsageError("--up: the vector has length 0");
  if (!arguments.has("--camera"))
    return clearestView(scene, state, colliding, contact_points, upward.normalized(),
                        arguments.value("--device", "auto"));
  Camera camera = viewsOf(scene, state, upward.normalized())[0];
  const std::string text = arguments.required("--camera");
  const bool has_target = std::count(text.begin(), text.end(), ',') > 2;
  const std::vector<double> values = numbersFrom("--camera", text, has_target ? 6 : 3);
  camera.eye = Eigen::Vector3d(values.data());
  if (has_target)
    camera.target = Eigen::Vector3d(values.data() + 3);
  return camera;
}

std::pair<int, int> sizeFrom(const CommandLine& arguments)
{
  const std::string text = arguments.value("--size", "960x720");
  int width = 0;
  int height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &rest) != 2)
    throw UsageError("--size: '" + text + "' is not WIDTHxHEIGHT");
  return {width, height};
}

std::string pngFileFrom(const CommandLine& arguments)
{
  std::string out = arguments.required("--out");
  constexpr std::string_view kEnding = ".png";
  if (out.size() <= kEnding.size() || out.substr(out.size() - kEnding.size()) != kEnding)
    throw UsageError("--out: '" + out + "' does not end in .png; render writes only PNG files");
  return out;
}

void run(const CommandLine& arguments)
{
  const std::string out = pngFileFrom(arguments);
  const auto [width, height] = sizeFrom(arguments);
  std::vector<std::string> warnings;
  const auto shared = std::make_shared<const PlanningScene>(sceneFrom(arguments, &warnings));
  const PlanningScene& scene = *shared;
  printWarnings(warnings);
  const std::vector<double> state = stateFrom(arguments, scene);
  const auto colliding = collidingPairs(scene, state.data());
  std::vector<Eigen::Vector3d> points;
  if (!colliding.empty())
    for (const Contact& contact : StateInspector(shared).contacts(state.data(), "", kMaxContacts, kMaxContactsOfPair))
      points.push_back(contact.point);
  const Camera camera = cameraFrom(arguments, scene, state.data(), colliding, points);
  writePng(render(scene, state.data(), colliding, points, camera, width, height, arguments.value("--device", "auto")),
           out);
  if (!arguments.has("--camera"))
    std::cerr << "camera: --camera " << textOf(camera.eye) << "," << textOf(camera.target) << "\n";
  for (const auto& pair : colliding)
    std::cerr << "collides: " << scene.bodyName(pair[0]) << " - " << scene.bodyName(pair[1]) << "\n";
  std::cerr << (colliding.empty() ? "free of collision" : counted(colliding.size(), "colliding pair")) << ", " << out
            << " (collision shapes, not visual meshes)\n";
}
}  // namespace
}  // namespace gpu_planning_scene::core

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  const Tool tool{"render",
                  "--urdf FILE [--srdf FILE] [--package NAME=DIR]... [--scene FILE] [--object ID=FILE]...\n"
                  "              [--state ITEM,...] --out FILE.png [options]",
                  "Draws a robot in its scene: links grey, objects in colours, bodies that collide red,\n"
                  "contact points yellow. Hidden contact points and colliding links are faint. It draws the\n"
                  "collision shapes of the URDF, not the visual meshes. Unless the scene has a plane, it adds a\n"
                  "floor below the scene, with shadows.\n"
                  "Needs an OpenGL device (a software device works too), but no window system.\n"
                  "Exit code: 0 success, 2 bad usage, 1 any other error.",
                  options(), run};
  return runTool(tool, argc, argv);
}
