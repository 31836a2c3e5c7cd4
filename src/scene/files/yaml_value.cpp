#include "scene/files/yaml_value.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "base/text/parse_number.h"
#include "base/text/utf8.h"
#include "gpu_planning_scene/error.h"
#include "model/files/open_file.h"

namespace gpu_planning_scene::core
{
/// Builds the values from the parser's events. yaml-cpp's own node tree would be several times slower for large meshes,
/// and it accepts a key that is given twice without an error.
class YamlTreeBuilder : public YAML::EventHandler
{
 public:
  explicit YamlTreeBuilder(std::shared_ptr<const std::string> file) : file_(std::move(file)) {}

  YamlValue takeDocument() { return std::move(document_); }

  void OnDocumentStart(const YAML::Mark& mark) override
  {
    document_ = makeValue(YamlValue::Kind::Null, mark);
    // On some broken texts the parser returns one empty document after the other and never ends.
    if (mark.pos == document_start_)
      document_.fail("not YAML: the document is empty");
    document_start_ = mark.pos;
  }
  void OnDocumentEnd() override { anchors_.clear(); }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override
  {
    complete(makeValue(YamlValue::Kind::Null, mark), anchor, 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override
  {
    const auto target = anchors_.find(anchor);
    if (target == anchors_.end())
      makeValue(YamlValue::Kind::Null, mark).fail("an alias refers to the value that contains it");
    // Each use of an alias is a copy. A few lines of aliases of aliases would take all memory.
    copied_ += target->second.size;
    if (copied_ > kMaxCopied)
      target->second.value.fail("aliases stand for more than " + std::to_string(kMaxCopied) + " values");
    complete(target->second.value, 0, target->second.size);
  }

  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& value) override
  {
    YamlValue scalar = makeValue(YamlValue::Kind::Scalar, mark);
    scalar.scalar_ = value;
    complete(std::move(scalar), anchor, 1);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override
  {
    open_.push_back({makeValue(YamlValue::Kind::Sequence, mark), anchor, {}});
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override
  {
    open_.push_back({makeValue(YamlValue::Kind::Map, mark), anchor, {}});
  }
  void OnMapEnd() override { close(); }

 private:
  struct OpenValue
  {
    YamlValue value;
    YAML::anchor_t anchor;
    std::unique_ptr<YamlValue> key;  ///< of a map: a key whose value has not been read yet
    std::size_t size = 1;            ///< number of values in it, itself included
  };
  struct Anchored
  {
    YamlValue value;
    std::size_t size;
  };
  static constexpr std::size_t kMaxCopied = 1000000;

  YamlValue makeValue(YamlValue::Kind kind, const YAML::Mark& mark) const
  {
    YamlValue value;
    value.kind_ = kind;
    value.line_ = mark.line + 1;
    value.file_ = file_;
    return value;
  }

  void close()
  {
    OpenValue closed = std::move(open_.back());
    open_.pop_back();
    complete(std::move(closed.value), closed.anchor, closed.size);
  }

  void complete(YamlValue value, YAML::anchor_t anchor, std::size_t size)
  {
    if (anchor != 0)
    {
      value.has_anchor_ = true;
      anchors_[anchor] = {value, size};
    }
    if (open_.empty())
    {
      document_ = std::move(value);
      return;
    }
    OpenValue& parent = open_.back();
    parent.size += size;
    if (parent.value.kind_ == YamlValue::Kind::Sequence)
    {
      parent.value.items_.push_back(std::move(value));
      return;
    }
    if (!parent.key)
    {
      if (value.kind_ != YamlValue::Kind::Scalar)
        value.fail("a key must be plain text");
      for (const auto& member : parent.value.members_)
        if (member.first == value.scalar_)
          value.fail("key '" + value.scalar_ + "' is given twice");
      parent.key = std::make_unique<YamlValue>(std::move(value));
      return;
    }
    value.key_line_ = parent.key->line_;
    parent.value.members_.emplace_back(parent.key->scalar_, std::move(value));
    parent.key.reset();
  }

  std::shared_ptr<const std::string> file_;
  YamlValue document_;
  std::vector<OpenValue> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  std::size_t copied_ = 0;
  int document_start_ = -1;
};

YamlValue YamlValue::loadFile(const std::string& path)
{
  std::ifstream file = openFile(path);
  return fromText(std::string(std::istreambuf_iterator<char>(file), {}), path);
}

YamlValue YamlValue::fromText(const std::string& text, const std::string& name)
{
  const bool is_utf_16 = text.find('\0') != std::string::npos;  // or UTF-32; yaml-cpp reads both
  std::istringstream stream(is_utf_16 ? text : inUtf8(text));
  return read(stream, name);
}

YamlValue YamlValue::read(std::istream& stream, const std::string& name)
{
  YamlTreeBuilder builder(std::make_shared<const std::string>(name));
  YamlValue document;
  try
  {
    // `rostopic echo` ends each message with "---", which begins another, empty document.
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder))
    {
      YamlValue next = builder.takeDocument();
      if (next.kind_ == Kind::Null)
        continue;
      if (document.kind_ != Kind::Null)
        next.fail("the file has a second document; give one document per file");
      document = std::move(next);
    }
  }
  catch (const YAML::Exception& error)
  {
    const bool is_star = error.msg == YAML::ErrorMsg::ALIAS_NOT_FOUND;
    throw Error(name + ":" + std::to_string(error.mark.line + 1) + ": not YAML: " + error.msg +
                (is_star ? "; \"*\" needs quotation marks" : ""));
  }
  if (document.kind_ == Kind::Null)
    throw Error(name + ": the file holds no YAML value");
  return document;
}

std::string YamlValue::where() const
{
  return *file_ + ":" + std::to_string(line_);
}

std::string YamlValue::keyWhere() const
{
  return *file_ + ":" + std::to_string(key_line_);
}

void YamlValue::fail(const std::string& what) const
{
  throw Error(where() + ": " + what);
}

void YamlValue::failAtKey(const std::string& what) const
{
  throw Error(keyWhere() + ": " + what);
}

const YamlValue* YamlValue::find(const std::string& key) const
{
  for (const auto& member : members())
    if (member.first == key)
      return member.second.kind_ == Kind::Null ? nullptr : &member.second;
  return nullptr;
}

const YamlValue& YamlValue::at(const std::string& key) const
{
  const YamlValue* member = find(key);
  if (!member)
    fail("'" + key + "' is missing");
  return *member;
}

const std::vector<std::pair<std::string, YamlValue>>& YamlValue::members() const
{
  if (kind_ != Kind::Map)
    fail("expected 'key: value' pairs");
  return members_;
}

const std::vector<YamlValue>& YamlValue::items() const
{
  if (kind_ != Kind::Sequence)
    fail("expected a list");
  return items_;
}

const std::string& YamlValue::text() const
{
  if (kind_ != Kind::Scalar)
    fail("expected a single value");
  return scalar_;
}

double YamlValue::number() const
{
  // YAML allows .nan and .inf, and C allows nan and inf. None of them is accepted.
  const std::optional<double> value = parseNumber(text());
  if (!value || !std::isfinite(*value))
    fail("'" + scalar_ + "' is not a finite number");
  return *value;
}

long long YamlValue::integer() const
{
  const std::optional<long long> value = parseInteger(text());
  if (!value)
    fail("'" + scalar_ + "' is not an integer");
  return *value;
}

bool YamlValue::boolean() const
{
  std::string lower = text();
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  if (lower == "true" || lower == "yes" || lower == "1")
    return true;
  if (lower != "false" && lower != "no" && lower != "0")
    fail("'" + scalar_ + "' is neither true nor false");
  return false;
}

std::vector<double> YamlValue::numbers(std::size_t count) const
{
  if (items().size() != count)
    fail("expected a list of " + std::to_string(count) + " numbers, found " + std::to_string(items_.size()));
  std::vector<double> values;
  for (const YamlValue& item : items_)
    values.push_back(item.number());
  return values;
}
}  // namespace gpu_planning_scene::core
