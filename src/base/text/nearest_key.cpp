#include "base/text/nearest_key.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

// The known word with the least optimal string alignment distance: the smallest number of insertions, deletions,
// replacements and swaps of neighbouring letters that turn one word into the other (F. J. Damerau: A technique for
// computer detection and correction of spelling errors. Communications of the ACM 7(3), 1964). Own method: at most one
// error for each three letters.
namespace gpu_planning_scene::core
{
namespace
{
/// The optimal string alignment distance of two words.
std::size_t typingErrors(const std::string& a, const std::string& b)
{
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> errors((a.size() + 1) * width);  // [letters of a][letters of b]
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j)
    {
      std::size_t& least = errors[i * width + j];
      if (i == 0 || j == 0)
      {
        least = i + j;
        continue;
      }
      const std::size_t above = (i - 1) * width + j;
      least = std::min(
          {errors[above] + 1, errors[i * width + j - 1] + 1, errors[above - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        least = std::min(least, errors[(i - 2) * width + j - 2] + 1);
    }
  return errors.back();
}
}  // namespace

std::string nearestKey(const std::string& word, const std::vector<std::string>& known)
{
  constexpr std::size_t kLettersPerError = 3;
  constexpr std::size_t kLongest = 64;  // a file or request may hold words of any length
  if (word.size() > kLongest)
    return "";
  std::string nearest;
  std::size_t least = word.size() / kLettersPerError + 1;
  for (const std::string& key : known)
  {
    if (key.size() >= word.size() + least)
      continue;  // each further letter is an error
    if (const std::size_t errors = typingErrors(word, key); errors < least)
    {
      nearest = key;
      least = errors;
    }
  }
  return nearest;
}

std::string plainKey(const std::string& key)
{
  std::string result;
  for (const char c : key)
    if (std::isalnum(static_cast<unsigned char>(c)))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string nearestSpelling(const std::string& word, const std::vector<std::string>& known)
{
  std::vector<std::string> plain_keys;
  for (const std::string& key : known)
    plain_keys.push_back(plainKey(key));
  const std::string nearest = nearestKey(plainKey(word), plain_keys);
  const auto found = std::find(plain_keys.begin(), plain_keys.end(), nearest);
  return found == plain_keys.end() ? "" : known[static_cast<std::size_t>(found - plain_keys.begin())];
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known)
{
  const std::string nearest = nearestKey(word, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}
}  // namespace gpu_planning_scene::core
