#include "command_line/robot_arguments.h"

#include <iostream>
#include <map>

#include "gpu_planning_scene/planning_file.h"

namespace gpu_planning_scene::core
{
Option packageOption()
{
  return {"--package", "NAME=DIR",
          "the folder of package://NAME/..., and of $(find NAME) in xacro\nfiles; packages on ROS_PACKAGE_PATH need no "
          "option; can be\nrepeated",
          true};
}

std::vector<Option> robotOptions()
{
  return {{"--urdf", "FILE", "the robot: a URDF, or a xacro file if xacro is installed"},
          {"--srdf", "FILE",
           "groups, and pairs of links that are not checked;\nwithout it, adjacent links are not checked"},
          packageOption(),
          {"--planning", "FILE",
           "position limits: a YAML file with MoveIt's joint_limits; they\nreplace those of the URDF"},
          {"--unbounded-translation", "METRES",
           "planar and floating joints without limits: random positions\nare from -METRES to METRES (default 1)"},
          {"--solid", "LINK=RULE",
           "what the meshes of a link have inside: auto (default), surface\n(nothing) or filled (holes are filled); "
           "can be repeated",
           true}};
}

std::vector<Option> deviceOptions()
{
  return {{"--device", "DEVICE",
           "auto (default): a GPU, else the CPU; software (llvmpipe);\nan index; part of a renderer's name;\n"
           "several of these (0+1); all: all GPUs; or cpu: double\nprecision without a GL device"},
          {"--traversal", "NAME", "work_queue (default) or breadth_first; cpu has its own"},
          {"--device-only", "",
           "the device checks all states that it can, and auto takes\nllvmpipe if there is no GPU; else cores check "
           "states too"},
          {"--max-batch", "N", "most states that go to the device at once (default 131072)"}};
}

std::map<std::string, std::string> packageFoldersFrom(const CommandLine& arguments)
{
  std::map<std::string, std::string> folders;
  for (const std::string& package : arguments.values("--package"))
  {
    const std::size_t equals = package.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == package.size())
      throw UsageError("--package: '" + package + "' is not NAME=DIR");
    if (!folders.emplace(package.substr(0, equals), package.substr(equals + 1)).second)
      throw UsageError("--package: '" + package.substr(0, equals) + "' is given twice");
  }
  return folders;
}

PackageResolver packagesFrom(const CommandLine& arguments)
{
  return packageResolver(packageFoldersFrom(arguments), "name its folder (--package NAME=DIR)");
}

namespace
{
std::map<std::string, SolidRule> solidsFrom(const CommandLine& arguments)
{
  std::map<std::string, SolidRule> solids;
  for (const std::string& text : arguments.values("--solid"))
  {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--solid: '" + text + "' is not LINK=RULE");
    SolidRule rule;
    try
    {
      rule = solidRuleFrom(text.substr(equals + 1));
    }
    catch (const Error& error)
    {
      throw UsageError(std::string("--solid: ") + error.what());
    }
    if (!solids.emplace(text.substr(0, equals), rule).second)
      throw UsageError("--solid: '" + text.substr(0, equals) + "' is given twice");
  }
  return solids;
}
}  // namespace

std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, std::vector<std::string>* warnings)
{
  return robotFrom(arguments, arguments.value("--srdf", ""), warnings);
}

std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, const std::string& srdf,
                                            std::vector<std::string>* warnings)
{
  RobotModelOptions options;
  options.packages = packagesFrom(arguments);
  options.package_folders = packageFoldersFrom(arguments);
  options.unbounded_translation = arguments.number("--unbounded-translation", options.unbounded_translation, 0.0, 1e6);
  if (const std::string planning = arguments.value("--planning", ""); !planning.empty())
    options.joint_limits = readJointLimits(planning, warnings);
  options.info = [](const std::string& line) { std::cerr << line << "\n"; };
  return RobotModel::fromFiles(arguments.required("--urdf"), srdf, options, warnings)
      ->withSolids(solidsFrom(arguments));
}

BatchCheckerOptions checkerOptionsFrom(const CommandLine& arguments)
{
  BatchCheckerOptions options;
  options.device = arguments.value("--device", options.device);
  if (arguments.has("--traversal"))
  {
    try
    {
      options.traversal = traversalFromName(arguments.required("--traversal"));
    }
    catch (const Error& error)
    {
      throw UsageError(std::string("--traversal: ") + error.what());
    }
  }
  options.device_only = arguments.has("--device-only");
  options.max_batch = arguments.count("--max-batch", options.max_batch, 1, 1 << 24);
  return options;
}

void printWarnings(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
    std::cerr << "warning: " << warning << "\n";
}
}  // namespace gpu_planning_scene::core
