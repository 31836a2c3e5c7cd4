#pragma once

#include <ompl/util/Console.h>

namespace gpu_planning_scene::core
{
/// While it is there, what OMPL logs goes to rosconsole, as "ompl": what it calls information as debugging.
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
