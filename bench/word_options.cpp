#include "word_options.h"

#include <algorithm>
#include <sstream>

#include "base/text/name_list.h"

namespace gpu_planning_scene::core
{
std::vector<std::string> splitAtCommas(const std::string& text)
{
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');)
    if (!word.empty())
      words.push_back(word);
  return words;
}

std::vector<std::string> chosenWords(const CommandLine& arguments, const std::string& option,
                                     const std::vector<std::string>& known)
{
  if (!arguments.has(option))
    return known;
  std::vector<std::string> words = splitAtCommas(arguments.required(option));
  for (const std::string& word : words)
    if (std::find(known.begin(), known.end(), word) == known.end())
      throw UsageError(option + ": there is no '" + word + "'; known names: " + nameList(known));
  if (words.empty())
    throw UsageError(option + ": the list is empty; known names: " + nameList(known));
  return words;
}
}  // namespace gpu_planning_scene::core
