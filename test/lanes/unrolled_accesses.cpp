#include "lanes/unrolled_accesses.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

// Reads the text of a shader as tokens. In each scope it knows the names whose values a compiler knows after it has
// unrolled the loops: counters of loops with constant bounds, and constants that are computed from them. Names of
// capital letters are macros with constant values. Own method.
namespace gpu_planning_scene::core
{
namespace
{
struct Token
{
  std::string text;
  int line;
};
using Tokens = std::vector<Token>;
using Names = std::set<std::string>;

bool isName(const std::string& text)
{
  return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_';
}

/// Also fills `aliases` with the macros that stand for one name.
Tokens tokensOf(const std::string& shader, std::map<std::string, std::string>& aliases)
{
  static const std::regex alias("^\\s*#\\s*define\\s+(\\w+)\\s+([A-Za-z_]\\w*)\\s*$");
  static const std::regex token("[A-Za-z_]\\w*|[0-9][\\w.]*|[-+*/%&|^<>=!]=|<<|>>|\\+\\+|--|&&|\\|\\||\\S");
  Tokens tokens;
  std::istringstream lines(shader);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
  {
    line = line.substr(0, line.find("//"));
    std::smatch match;
    if (std::regex_match(line, match, alias))
      aliases[match[1]] = match[2];
    if (line.find_first_not_of(' ') == std::string::npos || line[line.find_first_not_of(' ')] == '#')
      continue;
    for (auto i = std::sregex_iterator(line.begin(), line.end(), token); i != std::sregex_iterator(); ++i)
      tokens.push_back({i->str(), number});
  }
  return tokens;
}

class Reader
{
 public:
  explicit Reader(const std::string& shader) : tokens_(tokensOf(shader, aliases_))
  {
    for (std::size_t i = 0; i + 3 < tokens_.size(); ++i)
      if (isName(text(i)) && text(i + 1) == "[" && text(i + 2) == "]" && text(i + 3) == ";")
        unsized_.insert(text(i));
  }

  std::vector<std::string> read()
  {
    for (std::size_t i = 0; i + 2 < tokens_.size(); ++i)
      if (isName(text(i)) && isName(text(i + 1)) && text(i + 2) == "(" && text(closing(i + 2) + 1) == "{")
        i = readFunction(i + 1);
    return found_;
  }

 private:
  /// The names of a scope.
  struct Scope
  {
    Names known;       // constant after unrolling: counters, and constants that are computed from them
    Names counters;    // of `known`: depend on a counter
    Names starting;    // variables whose first value is constant: a loop without an initialiser may count with them
    Names parameters;  // of the function
  };

  const std::string& text(std::size_t i) const
  {
    static const std::string none;
    return i < tokens_.size() ? tokens_[i].text : none;
  }

  /// The place of the bracket that closes the one at `open`.
  std::size_t closing(std::size_t open) const
  {
    int depth = 0;
    for (std::size_t i = open; i < tokens_.size(); ++i)
      if (text(i) == "(" || text(i) == "[" || text(i) == "{")
        ++depth;
      else if ((text(i) == ")" || text(i) == "]" || text(i) == "}") && --depth == 0)
        return i;
    return tokens_.size();
  }

  std::size_t next(std::size_t i, const std::string& wanted, std::size_t end) const
  {
    while (i < end && text(i) != wanted)
      i = (text(i) == "(" || text(i) == "[" || text(i) == "{") ? closing(i) + 1 : i + 1;
    return i;
  }

  /// The names in an expression, without macros, conversions and members.
  Names namesIn(std::size_t begin, std::size_t end) const
  {
    static const Names conversions = {"int", "uint", "true", "false"};
    Names names;
    for (std::size_t i = begin; i < end; ++i)
      if (isName(text(i)) && text(i - 1) != "." && conversions.count(text(i)) == 0 &&
          std::any_of(text(i).begin(), text(i).end(), [](unsigned char c) { return std::islower(c) != 0; }))
        names.insert(text(i));
    return names;
  }

  static bool isWithin(const Names& names, const Names& all)
  {
    return std::includes(all.begin(), all.end(), names.begin(), names.end());
  }

  static bool meets(const Names& names, const Names& others)
  {
    return std::any_of(
        names.begin(), names.end(), [&others](const std::string& name) { return others.count(name) > 0; });
  }

  /// Returns the place of the function's last bracket.
  std::size_t readFunction(std::size_t name)
  {
    const std::size_t end_of_parameters = closing(name + 1);
    Scope scope;
    std::vector<std::string> parameters;
    for (std::size_t i = name + 2; i < end_of_parameters;)
    {
      const std::size_t end = next(i, ",", end_of_parameters);
      const std::size_t bracket = next(i, "[", end);
      parameters.push_back(text(bracket - 1));
      scope.parameters.insert(text(bracket - 1));
      i = end + 1;
    }
    function_ = text(name);
    of_function_ = parameters;
    const std::size_t body = end_of_parameters + 1;
    readStatements(body + 1, closing(body), scope);
    return closing(body);
  }

  void readStatements(std::size_t begin, std::size_t end, Scope scope)
  {
    for (std::size_t i = begin; i < end;)
      i = readStatement(i, end, scope);
  }

  /// Returns the place after the statement.
  std::size_t readStatement(std::size_t i, std::size_t end, Scope& scope)
  {
    if (text(i) == "{")
    {
      readStatements(i + 1, closing(i), scope);
      return closing(i) + 1;
    }
    if (text(i) == "for")
      return readFor(i, end, scope);
    if (text(i) == "while")
    {
      Scope inner = scope;
      startLoop(i + 2, closing(i + 1), inner);
      return readStatement(closing(i + 1) + 1, end, inner);
    }
    if (text(i) == "do")
    {
      const std::size_t condition = next(text(i + 1) == "{" ? closing(i + 1) : i, "while", end) + 1;
      Scope inner = scope;
      startLoop(condition + 1, closing(condition), inner);
      readStatement(i + 1, end, inner);
      return closing(condition) + 2;
    }
    if (text(i) == "if")
    {
      readExpression(i + 2, closing(i + 1), scope);
      return readStatement(closing(i + 1) + 1, end, scope);
    }
    if (text(i) == "else")
      return readStatement(i + 1, end, scope);
    const std::size_t stop = next(i, ";", end);
    readExpression(i, stop, scope);
    declare(i, stop, scope);
    return stop + 1;
  }

  /// Notes a declaration "type name = value".
  void declare(std::size_t begin, std::size_t end, Scope& scope) const
  {
    std::size_t i = begin;
    const bool is_constant = text(i) == "const" || text(i + 1) == "const";
    while (text(i) == "const" || text(i) == "precise")
      ++i;
    if (!isName(text(i)) || !isName(text(i + 1)) || text(i + 2) != "=")
      return;
    const std::string& name = text(i + 1);
    const Names value = namesIn(i + 3, end);
    scope.known.erase(name);
    scope.counters.erase(name);
    if (!isWithin(value, scope.known))
      return;
    if (!is_constant)
      scope.starting.insert(name);
    else
    {
      scope.known.insert(name);
      if (meets(value, scope.counters))
        scope.counters.insert(name);
    }
  }

  std::size_t readFor(std::size_t i, std::size_t end, Scope scope)
  {
    const std::size_t close = closing(i + 1);
    const std::size_t condition = next(i + 2, ";", close) + 1;
    const std::size_t step = next(condition, ";", close) + 1;
    declare(i + 2, condition - 1, scope);
    startLoop(condition, step - 1, scope);
    return readStatement(close + 1, end, scope);
  }

  /// If the condition has only constants and variables whose first value is constant, these variables are counters.
  static void count(const Names& condition, Scope& scope)
  {
    Names all = scope.known;
    all.insert(scope.starting.begin(), scope.starting.end());
    if (!isWithin(condition, all))
      return;
    for (const std::string& name : condition)
      if (scope.starting.count(name) > 0)
      {
        scope.known.insert(name);
        scope.counters.insert(name);
      }
  }
  void startLoop(std::size_t begin, std::size_t end, Scope& scope) const { count(namesIn(begin, end), scope); }

  void readExpression(std::size_t begin, std::size_t end, const Scope& scope)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const auto alias = aliases_.find(text(i));
      const std::string& name = alias == aliases_.end() ? text(i) : alias->second;
      if (text(i + 1) == "[" && unsized_.count(name) > 0)
        readAccess(i, name, {namesIn(i + 2, closing(i + 1))}, scope);
      else if (text(i + 1) == "(" && places_.count(name) > 0)
        readCall(i, name, scope);
    }
  }

  void readCall(std::size_t i, const std::string& name, const Scope& scope)
  {
    std::vector<Names> arguments;
    const std::size_t close = closing(i + 1);
    for (std::size_t k = i + 2; k < close;)
    {
      const std::size_t stop = next(k, ",", close);
      arguments.push_back(namesIn(k, stop));
      k = stop + 1;
    }
    for (const std::vector<std::size_t>& parameters : places_.at(name))
    {
      Names index;
      for (const std::size_t parameter : parameters)
        if (parameter < arguments.size())
          index.insert(arguments[parameter].begin(), arguments[parameter].end());
      readAccess(i, name, index, scope);
    }
  }

  /// An access at a place that is computed from the names of `index`.
  void readAccess(std::size_t i, const std::string& name, const Names& index, const Scope& scope)
  {
    if (isWithin(index, scope.known) && meets(index, scope.counters))
    {
      std::string line = "line " + std::to_string(tokens_[i].line) + ": " + name;
      for (std::size_t k = i + 1; k <= closing(i + 1); ++k)
        line += (text(k) == "+" || text(k) == "*" ? " " + text(k) + " " : text(k)) + (text(k) == "," ? " " : "");
      found_.push_back(line);
    }
    Names all = scope.known;
    all.insert(scope.parameters.begin(), scope.parameters.end());
    if (!isWithin(index, all) || !meets(index, scope.parameters))
      return;
    std::vector<std::size_t> parameters;
    for (std::size_t k = 0; k < of_function_.size(); ++k)
      if (index.count(of_function_[k]) > 0)
        parameters.push_back(k);
    places_[function_].insert(parameters);
  }

  std::map<std::string, std::string> aliases_;
  Tokens tokens_;
  Names unsized_;
  std::string function_;
  std::vector<std::string> of_function_;  // its parameters
  // By function: the numbers of the parameters from which an index is computed, one entry for each access.
  std::map<std::string, std::set<std::vector<std::size_t>>> places_;
  std::vector<std::string> found_;
};
}  // namespace

std::vector<std::string> unrolledAccesses(const std::string& shader)
{
  return Reader(shader).read();
}
}  // namespace gpu_planning_scene::core
