#include "scene/files/scene_keys.h"

#include <algorithm>
#include <cstddef>

#include "base/text/name_list.h"
#include "base/text/nearest_key.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Whether a map may have keys that are not used.
enum class FurtherKeys
{
  Warning,
  Error
};

struct MapKeys
{
  const char* name;  ///< for messages
  FurtherKeys further;
  std::vector<std::string> known;
};

const MapKeys& keysOf(SceneMap kind)
{
  // In the order of SceneMap.
  static const std::vector<MapKeys> maps = {
      {"the scene",
       FurtherKeys::Warning,
       {"name", "robot_state", "robot_model_name", "fixed_frame_transforms", "allowed_collision_matrix",
        "allowed_collisions", "link_padding", "link_scale", "link_solid", "object_colors", "world", "octomap",
        "is_diff", "scene_revision"}},
      {"'world'", FurtherKeys::Warning, {"collision_objects", "octomap"}},
      {"an object",
       FurtherKeys::Warning,
       {"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses", "planes",
        "plane_poses", "subframe_names", "subframe_poses", "operation", "solid"}},
      {"the type of an object", FurtherKeys::Warning, {"key", "db"}},
      {"a primitive", FurtherKeys::Warning, {"type", "dimensions"}},
      {"a mesh", FurtherKeys::Warning, {"vertices", "triangles", "resource", "scale", "dimensions"}},
      {"a triangle", FurtherKeys::Error, {"vertex_indices"}},
      {"a plane", FurtherKeys::Error, {"coef"}},
      {"'world.octomap'", FurtherKeys::Warning, {"header", "origin", "octomap", "resource"}},
      {"an octomap's 'octomap'", FurtherKeys::Warning, {"header", "binary", "id", "resolution", "data"}},
      {"'robot_state'",
       FurtherKeys::Warning,
       {"joint_state", "multi_dof_joint_state", "named_state", "attached_collision_objects", "is_diff"}},
      {"'joint_state'", FurtherKeys::Warning, {"header", "name", "position", "velocity", "effort"}},
      {"'multi_dof_joint_state'", FurtherKeys::Warning, {"header", "joint_names", "transforms", "twist", "wrench"}},
      {"an attached object", FurtherKeys::Warning, {"link_name", "object", "touch_links", "detach_posture", "weight"}},
      {"a trajectory", FurtherKeys::Warning, {"header", "joint_names", "points"}},
      {"a point of a trajectory",
       FurtherKeys::Warning,
       {"positions", "velocities", "accelerations", "effort", "time_from_start"}},
      {"a time", FurtherKeys::Error, {"secs", "nsecs", "sec", "nanosec"}},  // the last two: ROS 2
      {"'fixed_frame_transforms'", FurtherKeys::Warning, {"header", "child_frame_id", "transform"}},
      {"'allowed_collision_matrix'",
       FurtherKeys::Warning,
       {"entry_names", "entry_values", "default_entry_names", "default_entry_values"}},
      {"a row of the matrix", FurtherKeys::Error, {"enabled"}},
      {"'link_padding'", FurtherKeys::Warning, {"link_name", "padding"}},
      {"'link_scale'", FurtherKeys::Warning, {"link_name", "scale"}},
      {"'link_solid'", FurtherKeys::Error, {"link_name", "solid"}},
      {"'object_colors'", FurtherKeys::Warning, {"id", "color"}},
      {"a colour", FurtherKeys::Error, {"r", "g", "b", "a"}},
      {"a header", FurtherKeys::Error, {"seq", "stamp", "frame_id"}},
      {"a pose", FurtherKeys::Error, {"position", "orientation"}},
      {"a transform", FurtherKeys::Error, {"translation", "rotation"}},
      {"a position", FurtherKeys::Error, {"x", "y", "z"}},
      {"a quaternion", FurtherKeys::Error, {"x", "y", "z", "w"}},
  };
  return maps[static_cast<std::size_t>(kind)];
}

std::string singular(std::string word)
{
  if (!word.empty() && word.back() == 's')
    word.pop_back();
  return word;
}

/// The key of `known` that differs from `word` only in its spelling or by a plural; empty if there is none.
std::string sameKey(const std::string& word, const std::vector<std::string>& known)
{
  for (const std::string& key : known)
    if (singular(plainKey(key)) == singular(plainKey(word)))
      return key;
  return "";
}

/// The key of `known` that was probably meant by `word`: the same in another spelling, one with few typing errors, or
/// one of which `word` is a part (`objects` of `collision_objects`). Empty if no key is near.
std::string nearKey(const std::string& word, const std::vector<std::string>& known)
{
  // Words that are parts of keys, but also keys that people add for themselves.
  static const std::vector<std::string> common = {"name",  "names", "type",  "robot",  "model",   "scene",
                                                  "state", "color", "fixed", "colors", "default", "values"};
  constexpr std::size_t kShortestPart = 4;
  if (std::string same = sameKey(word, known); !same.empty())
    return same;
  if (std::string nearest = nearestSpelling(word, known); !nearest.empty())
    return nearest;
  const std::string letters = plainKey(word);
  if (letters.size() >= kShortestPart && !contains(common, letters))
    for (const std::string& key : known)
      if (plainKey(key).find(singular(letters)) != std::string::npos)
        return key;
  return "";
}

/// The map, for messages, to which a key belongs that stands in the wrong map. Empty if `word` is no key that changes
/// the world.
std::string otherPlace(const std::string& word)
{
  static const std::vector<SceneMap> places = {SceneMap::Scene,           SceneMap::World,      SceneMap::Object,
                                               SceneMap::Primitive,       SceneMap::Mesh,       SceneMap::Plane,
                                               SceneMap::OctomapWithPose, SceneMap::Octomap,    SceneMap::RobotState,
                                               SceneMap::AttachedObject,  SceneMap::Header,     SceneMap::Pose,
                                               SceneMap::FixedFrame,      SceneMap::JointState, SceneMap::LinkPadding};
  // These change no verdict, or are words of daily life.
  static const std::vector<std::string> harmless = {"name",          "robot_model_name", "id",     "type",     "weight",
                                                    "stamp",         "detach_posture",   "effort", "velocity", "seq",
                                                    "scene_revision"};
  for (const SceneMap place : places)
    if (const std::string key = sameKey(word, keysOf(place).known); !key.empty() && !contains(harmless, key))
      return "'" + key + "' is a key of " + keysOf(place).name;
  return "";
}

/// Words for poses, sizes and files in URDF, SDF and other formats.
bool isPlacementOfOtherFormats(const std::string& word)
{
  static const std::vector<std::string> words = {"xyz",    "rpy",    "location", "quaternion", "offset",
                                                 "frame",  "parent", "size",     "radius",     "height",
                                                 "length", "file",   "uri",      "filename"};
  return contains(words, plainKey(word));
}

/// Whether a word is about sizes, distances or pairs that are not checked, as `default_robot_padding` of MoveIt's
/// parameters is.
bool changesChecks(const std::string& word)
{
  static const std::vector<std::string> parts = {"padding", "margin", "clearance", "inflat", "collision",
                                                 "disabl",  "scal",   "distance",  "safety", "ignor",
                                                 "skip",    "exclu",  "enlarg",    "expand", "touch"};
  static const std::vector<std::string> words = {"acm", "unit", "units", "buffer"};
  const std::string letters = plainKey(word);
  return contains(words, letters) ||
         std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return letters.find(part) != std::string::npos; });
}

/// A key inside of `value` that gives objects, shapes or joint values; empty if there is none. A value with an anchor
/// is passed over: it can be used elsewhere in the file.
std::string contentOf(const YamlValue& value)
{
  static const std::vector<std::string> contents = {
      "world",        "robot_state", "collision_objects", "attached_collision_objects", "primitives", "meshes",
      "planes",       "joint_state", "octomap",           "multi_dof_joint_state",      "dimensions", "vertices",
      "link_padding", "link_scale"};
  if (value.hasAnchor())
    return "";
  if (value.kind() == YamlValue::Kind::Sequence)
    for (const YamlValue& item : value.items())
      if (std::string content = contentOf(item); !content.empty())
        return content;
  if (value.kind() == YamlValue::Kind::Map)
    for (const auto& [key, member] : value.members())
    {
      if (contains(contents, key))
        return key;
      if (std::string content = contentOf(member); !content.empty())
        return content;
    }
  return "";
}

/// "'A', 'B' and 'C'"
std::string keyList(const std::vector<std::string>& known)
{
  std::string text;
  for (std::size_t i = 0; i < known.size(); ++i)
    text += (i == 0 ? "'" : i + 1 == known.size() ? " and '" : ", '") + known[i] + "'";
  return text;
}

void refuseMisspelt(const std::string& key, const YamlValue& value, const std::vector<std::string>& known)
{
  if (const std::string near = nearKey(key, known); !near.empty())
    value.failAtKey("unknown key '" + key + "'; did you mean '" + near + "'?");
}
}  // namespace

void refuseMisspeltKeys(const YamlValue& map, SceneMap kind)
{
  const std::vector<std::string>& known = keysOf(kind).known;
  for (const auto& [key, value] : map.members())
    if (!contains(known, key))
      refuseMisspelt(key, value, known);
}

void checkKeys(const YamlValue& map, SceneMap kind, std::vector<std::string>* warnings)
{
  const MapKeys& keys = keysOf(kind);
  for (const auto& [key, value] : map.members())
  {
    if (contains(keys.known, key))
      continue;
    if (key == "<<")
      value.failAtKey("merge keys (<<) are not supported; write out the keys of the map");
    if (keys.further == FurtherKeys::Warning && isPlacementOfOtherFormats(key))
      value.failAtKey("unknown key '" + key + "' in " + keys.name + "; it has " + keyList(keys.known));
    refuseMisspelt(key, value, keys.known);
    if (keys.further == FurtherKeys::Error)
      value.failAtKey("unknown key '" + key + "' in " + keys.name + "; it has " + keyList(keys.known));
    if (const std::string place = otherPlace(key); !place.empty())
      value.failAtKey("unknown key '" + key + "' in " + keys.name + "; " + place);
    if (const std::string content = contentOf(value); !content.empty())
      value.failAtKey("unknown key '" + key + "' in " + keys.name + ": its '" + content + "' would be lost; " +
                      keys.name + " has " + keyList(keys.known));
    if (changesChecks(key) && !value.hasAnchor())
      value.failAtKey("unknown key '" + key + "' in " + keys.name + ": it seems to change what is checked; " +
                      keys.name + " has " + keyList(keys.known));
    if (warnings != nullptr)
      warnings->push_back(value.keyWhere() + ": unknown key '" + key + "' is not used");
  }
}

bool hasKnownKey(const YamlValue& map, SceneMap kind)
{
  const std::vector<std::string>& known = keysOf(kind).known;
  return std::any_of(known.begin(), known.end(), [&](const std::string& key) { return map.find(key) != nullptr; });
}

std::string unknownKey(const YamlValue& map, SceneMap kind)
{
  for (const auto& [key, value] : map.members())
    if (!contains(keysOf(kind).known, key))
      return key;
  return "";
}

const YamlValue* frameOf(const YamlValue* header)
{
  if (header == nullptr)
    return nullptr;
  checkKeys(*header, SceneMap::Header, nullptr);
  if (const YamlValue* stamp = header->find("stamp"); stamp != nullptr && stamp->kind() == YamlValue::Kind::Map)
    checkKeys(*stamp, SceneMap::Time, nullptr);
  const YamlValue* frame = header->find("frame_id");
  return frame != nullptr && frame->text().empty() ? nullptr : frame;
}
}  // namespace gpu_planning_scene::core
