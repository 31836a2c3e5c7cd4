#include "model/meshes/ply_values.h"

#include <cstdint>
#include <limits>

#include "gpu_planning_scene/error.h"
#include "model/meshes/byte_order.h"
#include "model/meshes/words.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kTooShort[] = "the file ends before the last of the values that its header announces";
constexpr char kTooLong[] = "the file goes on after the last of the values that its header announces";

class AsciiValues : public PlyValues
{
 public:
  AsciiValues(std::string_view text, std::size_t first_line) : words_(text, first_line) {}

  double next(PlyType type) override
  {
    const std::string_view word = nextWord();
    switch (type)
    {
      case PlyType::Int8:
        return integer<std::int8_t>(word);
      case PlyType::Uint8:
        return integer<std::uint8_t>(word);
      case PlyType::Int16:
        return integer<std::int16_t>(word);
      case PlyType::Uint16:
        return integer<std::uint16_t>(word);
      case PlyType::Int32:
        return integer<std::int32_t>(word);
      case PlyType::Uint32:
        return integer<std::uint32_t>(word);
      case PlyType::Float32:
      case PlyType::Float64:
        break;
    }
    return numberFrom(word, words_.line());
  }

  void skip(PlyType) override { nextWord(); }

  void requireEnd() override
  {
    if (!words_.next().empty())
      failInLine(words_.line(), kTooLong);
  }

  std::string place() const override { return "line " + std::to_string(words_.line()); }

 private:
  std::string_view nextWord()
  {
    const std::string_view word = words_.next();
    if (word.empty())
      failInLine(words_.line(), kTooShort);
    return word;
  }

  template <typename Integer>
  double integer(std::string_view word) const
  {
    const std::int64_t value = integerFrom(word, words_.line());
    if (value < std::numeric_limits<Integer>::min() || value > std::numeric_limits<Integer>::max())
      failInLine(words_.line(), inQuotes(word) + " is out of the range of its type");
    return static_cast<double>(value);
  }

  Words words_;
};

class BinaryValues : public PlyValues
{
 public:
  BinaryValues(std::string_view content, std::size_t begin, bool big_endian)
    : content_(content), at_(begin), big_endian_(big_endian)
  {
  }

  double next(PlyType type) override
  {
    switch (type)
    {
      case PlyType::Int8:
        return value<std::int8_t>();
      case PlyType::Uint8:
        return value<std::uint8_t>();
      case PlyType::Int16:
        return value<std::int16_t>();
      case PlyType::Uint16:
        return value<std::uint16_t>();
      case PlyType::Int32:
        return value<std::int32_t>();
      case PlyType::Uint32:
        return value<std::uint32_t>();
      case PlyType::Float32:
        return value<float>();
      case PlyType::Float64:
        break;
    }
    return value<double>();
  }

  void skip(PlyType type) override { next(type); }

  void requireEnd() override
  {
    if (at_ != content_.size())
      throw Error(std::string(kTooLong) + ", by " + std::to_string(content_.size() - at_) + " bytes");
  }

  std::string place() const override { return "before byte " + std::to_string(at_); }

 private:
  template <typename Value>
  double value()
  {
    if (content_.size() - at_ < sizeof(Value))
      throw Error(kTooShort);
    const char* bytes = content_.data() + at_;
    at_ += sizeof(Value);
    return static_cast<double>(valueOf<Value>(bytes, big_endian_));
  }

  std::string_view content_;
  std::size_t at_;
  bool big_endian_;
};
}  // namespace

std::unique_ptr<PlyValues> plyValues(std::string_view content, const PlyHeader& header)
{
  if (header.format == PlyFormat::Ascii)
    return std::make_unique<AsciiValues>(content.substr(header.bytes), header.lines + 1);
  return std::make_unique<BinaryValues>(content, header.bytes, header.format == PlyFormat::BigEndian);
}
}  // namespace gpu_planning_scene::core
