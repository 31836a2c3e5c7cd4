#pragma once

#include <map>
#include <memory>
#include <optional>

#include "literature/method.h"
#include "oracle/oracle.h"
#include "stability/case.h"
#include "stability/table.h"

namespace gpu_planning_scene::core::stability
{
/// Methods of bench/literature. They check meshes and boxes without a required distance. Thread-safe.
class LiteratureMethods
{
 public:
  LiteratureMethods();
  ~LiteratureMethods();

  /// Whether one of them has this column of the table.
  bool has(Method method) const { return methods_.count(method) != 0; }
  /// Some of them render, which takes milliseconds without a GPU. They check one case in kCasesPerPicture.
  bool renders(Method method) const;
  static constexpr std::size_t kCasesPerPicture = 16;

  /// No value if the method cannot check the case.
  std::optional<bool> collides(Method method, const Case& c) const;

  /// Whether the authors of the method claim a correct answer for the case, whose true answer is `truth`.
  bool inDomain(Method method, const Case& c, oracle::Verdict truth) const;

 private:
  std::map<Method, literature::MethodInfo> methods_;
  std::shared_ptr<void> device_;  // without a holder, it would be made anew for each case
};
}  // namespace gpu_planning_scene::core::stability
