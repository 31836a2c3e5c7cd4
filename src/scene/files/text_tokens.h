#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Reads a text word by word; blanks separate words. It counts lines, so that errors name file and line.
class TextTokens
{
 public:
  /// `file` is the name for messages.
  TextTokens(std::string text, std::string file);

  /// Throws Error with file and line.
  [[noreturn]] void fail(const std::string& what) const;

  /// The next word, which stays unread; empty at the end.
  std::string_view peek();
  /// Reads the next word. Fails at the end of the text. `what` describes the word in messages.
  std::string word(const char* what);
  /// Reads the rest of the line, without blanks around it.
  std::string restOfLine();
  /// Returns true if the next line that is not empty has more than one word.
  bool nextLineHasSeveralWords();

  double number(const char* what);           ///< fails if it is not a finite number
  std::size_t index(const char* what);       ///< fails if it is not a whole number from 0 on
  std::size_t count(const char* what);       ///< an index; fails if the text has fewer characters left
  Eigen::Vector3d vector(const char* what);  ///< x y z
  Eigen::Isometry3d pose();                  ///< x y z and a quaternion x y z w, which is normalised

 private:
  std::string text_;
  std::string file_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};
}  // namespace gpu_planning_scene::core
