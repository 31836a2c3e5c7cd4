#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// A value of a YAML file. It keeps its line, so that errors name file and line.
class YamlValue
{
 public:
  enum class Kind
  {
    Null,
    Scalar,
    Sequence,
    Map
  };

  /// Throws Error if the file cannot be read, is not YAML, has a key twice, or does not hold exactly one document.
  static YamlValue loadFile(const std::string& path);
  /// The same for a text. `name` takes the place of the path in messages.
  static YamlValue fromText(const std::string& text, const std::string& name);

  Kind kind() const { return kind_; }
  std::string where() const;     ///< "FILE:LINE"
  std::string keyWhere() const;  ///< of a map's member: "FILE:LINE" of its key
  /// Throws Error with file and line.
  [[noreturn]] void fail(const std::string& what) const;
  /// Of a map's member: throws Error with the place of its key.
  [[noreturn]] void failAtKey(const std::string& what) const;
  /// Whether the value has an anchor (&NAME), or is an alias of one that has.
  bool hasAnchor() const { return has_anchor_; }

  /// A map's member; null if it is missing or empty. Fails if this is not a map.
  const YamlValue* find(const std::string& key) const;
  /// A map's member; fails if it is missing or empty.
  const YamlValue& at(const std::string& key) const;
  /// Fails if this is not a map.
  const std::vector<std::pair<std::string, YamlValue>>& members() const;
  /// Fails if this is not a sequence.
  const std::vector<YamlValue>& items() const;

  double number() const;  ///< fails if it is not a finite number
  long long integer() const;
  bool boolean() const;  ///< true, false, yes, no, 1, 0 (as YAML 1.1 and ROS write them)
  const std::string& text() const;
  /// The items of a list of exactly `count` finite numbers; fails if the value is not one.
  std::vector<double> numbers(std::size_t count) const;

 private:
  friend class YamlTreeBuilder;
  static YamlValue read(std::istream& stream, const std::string& name);

  Kind kind_ = Kind::Null;
  int line_ = 0;
  int key_line_ = 0;  ///< of a map's member: the line of its key
  bool has_anchor_ = false;
  std::shared_ptr<const std::string> file_;
  std::string scalar_;
  std::vector<YamlValue> items_;
  std::vector<std::pair<std::string, YamlValue>> members_;
};
}  // namespace gpu_planning_scene::core
