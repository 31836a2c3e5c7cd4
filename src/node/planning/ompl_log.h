#pragma once

#include <ompl/util/Console.h>

namespace gpu_planning_scene::core
{
/// During its lifetime, OMPL's log messages go to rosconsole, under the name "ompl". OMPL's information messages become
/// debug messages.
class OmplLog : public ompl::msg::OutputHandler
{
 public:
  OmplLog();
  ~OmplLog() override;
  OmplLog(const OmplLog&) = delete;
  OmplLog& operator=(const OmplLog&) = delete;

  void log(const std::string& text, ompl::msg::LogLevel level, const char* filename, int line) override;
};
}  // namespace gpu_planning_scene::core
