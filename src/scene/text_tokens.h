#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// A text of words between blanks, read from its beginning, that knows where it stands, so that what is wrong can be
/// said with file and line.
class TextTokens
{
 public:
  /// `file` is the name for messages.
  TextTokens(std::string text, std::string file);

  /// Throws Error with file and line.
  [[noreturn]] void fail(const std::string& what) const;

  /// The next word, left where it is; empty at the end.
  std::string_view peek();
  /// Fails at the end.
  std::string word(const char* what);
  /// What is left of the line, without blanks around it.
  std::string restOfLine();
  /// Whether the next line that is not empty has more than one word.
  bool nextLineHasSeveralWords();

  double number(const char* what);           ///< fails if it is not a finite number
  std::size_t index(const char* what);       ///< fails if it is not a whole number from 0 on
  std::size_t count(const char* what);       ///< an index; fails if there are not as many characters left
  Eigen::Vector3d vector(const char* what);  ///< x y z
  Eigen::Isometry3d pose();                  ///< x y z and a quaternion x y z w, which is normalised

 private:
  std::string text_;
  std::string file_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};
}  // namespace gpu_planning_scene::core
