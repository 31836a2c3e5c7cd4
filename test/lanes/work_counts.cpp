#include "lanes/work_counts.h"

#include <algorithm>
#include <ostream>
#include <utility>

namespace lanes
{
namespace
{
constexpr std::pair<const char*, std::uint64_t Work::*> kColumns[] = {
    {"floats", &Work::floats},   {"doubles", &Work::doubles}, {"quotients", &Work::quotients},
    {"fetches", &Work::fetches}, {"loads", &Work::loads},     {"stores", &Work::stores},
    {"atomics", &Work::atomics}, {"shared", &Work::shared},   {"barriers", &Work::barriers},
    {"bytes", &Work::bytes}};

std::uint64_t operationsOf(const Work& work)
{
  return work.floats + work.doubles + work.quotients;
}

std::uint64_t accessesOf(const Work& work)
{
  return work.fetches + work.loads + work.stores + work.atomics;
}

std::uint64_t stepsOf(const Work& work)
{
  return operationsOf(work) + accessesOf(work) + work.shared;
}

void printRow(std::ostream& out, const std::string& name, const ProgramWork& row)
{
  out << name << '\t' << row.dispatches << '\t' << row.invocations;
  for (const auto& [column, member] : kColumns)
    out << '\t' << row.work.*member;
  out << '\t' << row.sectors << '\t' << row.steps << '\t' << row.steps_of_warps << '\t' << row.longest.operations
      << '\t' << row.longest.accesses << '\n';
}
}  // namespace

LongestPath& LongestPath::operator+=(const LongestPath& other)
{
  operations += other.operations;
  accesses += other.accesses;
  return *this;
}

ProgramWork& ProgramWork::operator+=(const ProgramWork& other)
{
  dispatches += other.dispatches;
  invocations += other.invocations;
  for (const auto& [column, member] : kColumns)
    work.*member += other.work.*member;
  sectors += other.sectors;
  steps += other.steps;
  steps_of_warps += other.steps_of_warps;
  longest += other.longest;
  return *this;
}

void WorkCounts::begin(const std::string& program)
{
  endDispatch();
  current_ = &programs_[program];
  ++current_->dispatches;
}

void WorkCounts::add(const std::vector<Work>& invocations, std::size_t sectors, LongestPath& path)
{
  current_->sectors += sectors;
  LongestPath slowest;
  for (std::size_t first = 0; first < invocations.size(); first += kWarp)
  {
    std::uint64_t most = 0;
    for (std::size_t i = first; i < std::min(first + kWarp, invocations.size()); ++i)
    {
      const Work& work = invocations[i];
      for (const auto& [column, member] : kColumns)
        current_->work.*member += work.*member;
      current_->steps += stepsOf(work);
      most = std::max(most, stepsOf(work));
      slowest.operations = std::max(slowest.operations, operationsOf(work));
      slowest.accesses = std::max(slowest.accesses, accessesOf(work));
    }
    current_->steps_of_warps += kWarp * most;
  }
  path += slowest;
}

void WorkCounts::endGroup(std::size_t invocations, const LongestPath& path)
{
  current_->invocations += invocations;
  longest_.operations = std::max(longest_.operations, path.operations);
  longest_.accesses = std::max(longest_.accesses, path.accesses);
}

void WorkCounts::endDispatch()
{
  if (current_)
    current_->longest += longest_;
  current_ = nullptr;
  longest_ = {};
}

const std::map<std::string, ProgramWork>& WorkCounts::programs()
{
  endDispatch();
  return programs_;
}

void WorkCounts::print(std::ostream& out)
{
  out << "program\tdispatches\tinvocations";
  for (const auto& [column, member] : kColumns)
    out << '\t' << column;
  out << "\tsectors\tsteps\tsteps of warps\tlongest operations\tlongest accesses\n";
  ProgramWork all;
  for (const auto& [name, row] : programs())
  {
    printRow(out, name, row);
    all += row;
  }
  printRow(out, "all programs", all);
  out << "\nhost calls\tuploads\tuploaded bytes\tdownloads\tdownloaded bytes\twaits\n"
      << host.calls << '\t' << host.uploads << '\t' << host.uploaded_bytes << '\t' << host.downloads << '\t'
      << host.downloaded_bytes << '\t' << host.waits << '\n';
}
}  // namespace lanes
