#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gpu_planning_scene::core
{
/// Splits the text of a mesh file at white space.
class Words
{
 public:
  /// `first_line`: the line of the file in which the text begins.
  explicit Words(std::string_view text, std::size_t first_line = 1) : text_(text), line_(first_line) {}

  /// The next word; empty at the end of the text.
  std::string_view next();
  /// Goes to the end of the line.
  void skipLine();
  /// The line of the last word.
  std::size_t line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_;
};

/// A text without the mark of UTF-8 that some editors put before it.
std::string_view withoutByteOrderMark(std::string_view text);

/// A word in quotation marks, on one line and shortened, for messages.
std::string inQuotes(std::string_view word);

/// The number that a word is. `line`: its line, for the message. Throws Error if it is not a number, not finite, or too
/// large for a double.
double numberFrom(std::string_view word, std::size_t line);

/// The integer that a word is. Throws Error if it is none.
std::int64_t integerFrom(std::string_view word, std::size_t line);

/// Throws Error: "line LINE: WHAT".
[[noreturn]] void failInLine(std::size_t line, const std::string& what);
}  // namespace gpu_planning_scene::core
