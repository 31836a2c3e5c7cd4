#include "literature/experiment.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "gpu_planning_scene/error.h"
#include "literature/models.h"
#include "literature/samples.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using benchmark::CsvTable;
using benchmark::median;
using benchmark::Stopwatch;
using Answers = std::vector<std::uint8_t>;

constexpr std::size_t kFewPoses = 4;         // of the trial that finds how slow a method is
constexpr double kMostMeasurements = 200.0;  // times Settings::seconds: the longest time for a model
constexpr double kLongestBuild = 100.0;      // the same for making the method
constexpr double kLongestQuery = 50.0;       // times Settings::seconds
constexpr std::size_t kFullRunTriangles = 10000;
constexpr std::size_t kMostRepeats = 5;
constexpr std::size_t kMostQuickTriangles = 5000;  // of a robot's link that --quick measures

struct Measurement
{
  std::size_t poses = 0;
  double us_a_query = 0.0;
  double cpu_us_a_query = 0.0;
  std::size_t missed = 0;
  std::size_t invented = 0;
  WorkCounts work;  ///< a query
};

WorkCounts difference(const WorkCounts& before, const WorkCounts& after, double queries)
{
  WorkCounts work = after;
  for (std::size_t i = 0; i < work.size(); ++i)
    work[i].second = (work[i].second - (i < before.size() ? before[i].second : 0.0)) / queries;
  return work;
}

/// Counts wrong answers to the first poses of the sample. Of several calls, the most wrong one stays in the result.
void countWrong(const Answers& answers, const Sample& sample, Measurement& result)
{
  std::size_t missed = 0;
  std::size_t invented = 0;
  for (std::size_t i = 0; i < answers.size(); ++i)
  {
    missed += sample.truth[i] == oracle::Verdict::Collides && answers[i] == 0 ? 1 : 0;
    invented += sample.truth[i] == oracle::Verdict::Free && answers[i] != 0 ? 1 : 0;
  }
  result.missed = std::max(result.missed, missed);
  result.invented = std::max(result.invented, invented);
}

/// The first poses, as many as take about `seconds`, but at least kFewPoses.
std::vector<Eigen::Isometry3d> affordablePoses(Method& method, const std::vector<Eigen::Isometry3d>& poses,
                                               double seconds)
{
  const auto first = [&](std::size_t count)
  { return std::vector<Eigen::Isometry3d>(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(count)); };
  const std::size_t few = std::min(kFewPoses, poses.size());
  const double trial = benchmark::secondsOf([&] { method.collide(first(few)); });
  const auto affordable = static_cast<std::size_t>(static_cast<double>(few) * seconds / trial);
  return first(std::clamp(affordable, few, poses.size()));
}

/// Measures a method that has answered before, so one-time work is done.
Measurement measure(Method& method, const Sample& sample, double seconds)
{
  Measurement result;
  std::vector<Eigen::Isometry3d> asked = {sample.poses.front()};
  std::vector<double> wall;
  std::vector<double> cpu;
  WorkCounts before = method.work();
  double spent = 0.0;
  const auto repeat = [&]
  {
    const auto queries = static_cast<double>(asked.size());
    const double others = method.otherCpuSeconds();
    const Stopwatch watch;
    const Answers answers = method.collide(asked);
    wall.push_back(1e6 * watch.seconds() / queries);
    cpu.push_back(1e6 * (watch.cpuSeconds() + method.otherCpuSeconds() - others) / queries);
    spent += watch.seconds();
    countWrong(answers, sample, result);
  };
  const auto start = [&](std::vector<Eigen::Isometry3d> poses)
  {
    asked = std::move(poses);
    wall.clear();
    cpu.clear();
    before = method.work();
    spent = 0.0;
  };
  repeat();
  if (spent >= seconds)  // perhaps another program interrupted the query
  {
    start(asked);
    repeat();
  }
  if (spent < seconds)
  {
    start(affordablePoses(method, sample.poses, seconds));
    do
      repeat();
    while (wall.size() < kMostRepeats && spent < seconds);
  }
  result.poses = asked.size();
  const auto queries = static_cast<double>(asked.size());
  result.us_a_query = median(wall);
  result.cpu_us_a_query = median(cpu);
  result.work = difference(before, method.work(), queries * static_cast<double>(wall.size()));
  for (const auto& [part, microseconds] : method.timesOfParts(asked))
    result.work.emplace_back(part, microseconds / queries);
  return result;
}

bool inDomain(const MethodInfo& info, const Model& model)
{
  return (info.domain.concave || model.convex) && (info.domain.open || !model.open);
}

struct Tables
{
  explicit Tables(const std::string& folder)
    : times(folder, "experiment.csv",
            {"protocol", "model", "triangles", "size_m", "distance", "colliding_share", "method", "title", "family",
             "in_domain", "poses", "us_a_query", "cpu_us_a_query", "missed", "false"}),
      work(folder, "work.csv", {"protocol", "model", "triangles", "distance", "method", "what", "a_query"}),
      builds(folder, "builds.csv", {"model", "triangles", "method", "seconds", "failure"})
  {
  }
  CsvTable times;
  CsvTable work;
  CsvTable builds;
};

double collidingShare(const Sample& sample)
{
  return static_cast<double>(std::count(sample.truth.begin(), sample.truth.end(), oracle::Verdict::Collides)) /
         static_cast<double>(sample.truth.size());
}

/// Why a method is not measured with a model.
class LeftOut
{
 public:
  explicit LeftOut(double seconds) : seconds_(seconds) {}

  /// Empty if the method is measured.
  std::string reason(const MethodInfo& info, const Model& model) const
  {
    const std::size_t triangles = model.mesh->triangles.size();
    if (info.scope != Scope::Always && ((model.name != "torus" && model.name != "lump") ||
                                        2 * triangles < kFullRunTriangles || triangles > 2 * kFullRunTriangles))
      return "left out: other resolutions and views are measured with the torus and the lump of about " +
             std::to_string(kFullRunTriangles) + " triangles";
    const auto slow = slow_.find({info.name, model.name});
    return slow == slow_.end() ? "" : slow->second;
  }
  void measured(const MethodInfo& info, const Model& model, double build_seconds, double cpu_seconds)
  {
    if (build_seconds > kLongestBuild * seconds_ || cpu_seconds > kMostMeasurements * seconds_)
      slow_[{info.name, model.name}] = "left out: " + std::to_string(model.mesh->triangles.size()) +
                                       " triangles took " + std::to_string(std::lround(cpu_seconds)) + " s";
  }

 private:
  double seconds_;
  std::map<std::pair<std::string, std::string>, std::string> slow_;  // by method and model
};

/// Returns the number of wrong answers.
std::size_t measureMethod(const MethodInfo& info, const Model& model, const std::vector<Sample>& samples,
                          double seconds, LeftOut& left_out, Tables& tables)
{
  const std::size_t triangles = model.mesh->triangles.size();
  if (const std::string reason = left_out.reason(info, model); !reason.empty())
  {
    tables.builds.add({model.name, triangles, info.name, "", reason});
    return 0;
  }
  const Stopwatch building;
  std::unique_ptr<Method> method;
  try
  {
    method = info.make(model.mesh, model.mesh);
  }
  catch (const Error& error)
  {
    tables.builds.add({model.name, triangles, info.name, building.seconds(), error.what()});
    return 0;
  }
  const double build_seconds = building.cpuSeconds() + method->otherCpuSeconds();
  tables.builds.add({model.name, triangles, info.name, building.seconds(), ""});
  try
  {
    method->collide({Eigen::Isometry3d::Identity()});  // does one-time work
  }
  catch (const Error&)  // two copies at one place are more work than the method can hold
  {
  }
  for (const auto& [what, count] : method->built())
    tables.work.add({"build", model.name, triangles, 0.0, info.name, what, count});
  std::size_t wrong = 0;
  for (const Sample& sample : samples)
  {
    if (sample.poses.empty())
      continue;
    Measurement m;
    try
    {
      m = measure(*method, sample, seconds);
    }
    catch (const Error& error)  // more work than its buffers hold
    {
      tables.builds.add({model.name, triangles, info.name, "",
                         sample.protocol + ", " + benchmark::Cell(sample.distance).text + ": " + error.what()});
      continue;
    }
    tables.times.add({sample.protocol, model.name, triangles, model.size, sample.distance, collidingShare(sample),
                      info.name, info.title, info.family, inDomain(info, model) ? "yes" : "no", m.poses, m.us_a_query,
                      m.cpu_us_a_query, m.missed, m.invented});
    for (const auto& [what, count] : m.work)
      tables.work.add({sample.protocol, model.name, triangles, sample.distance, info.name, what, count});
    wrong += m.missed + m.invented;
    if (1e-6 * m.cpu_us_a_query > kLongestQuery * seconds)
      break;
  }
  left_out.measured(info, model, build_seconds, building.cpuSeconds() + method->otherCpuSeconds());
  return wrong;
}
}  // namespace

std::size_t measureExperiment(const Settings& settings)
{
  Tables tables(settings.out);
  std::vector<Model> models = settings.fixed_models ? fixedModels() : std::vector<Model>();
  if (settings.quick)
    models.erase(std::remove_if(models.begin(), models.end(),
                                [](const Model& model) { return model.mesh->triangles.size() > kMostQuickTriangles; }),
                 models.end());
  for (const std::size_t triangles : settings.triangles)
    for (const std::string& name : settings.models)
      models.push_back(madeModel(name, triangles, settings.seed));
  LeftOut left_out(settings.seconds);
  std::size_t wrong = 0;
  ProgressBar progress("experiment", models.size() * settings.methods.size());
  std::size_t done = 0;
  for (const Model& model : models)
  {
    const std::vector<Sample> samples = samplesOf(model, settings);
    for (const MethodInfo& info : settings.methods)
    {
      progress.update(done++);
      const std::size_t of_method = measureMethod(info, model, samples, settings.seconds, left_out, tables);
      if (info.family == "ours" && of_method > 0)
        std::cerr << model.name << ", " << model.mesh->triangles.size() << " triangles: " << info.title << " gives "
                  << of_method << " wrong answers\n";
      wrong += info.family == "ours" ? of_method : 0;
    }
  }
  return wrong;
}

void writeMethods(const Settings& settings)
{
  CsvTable table(settings.out, "methods.csv",
                 {"method", "title", "source", "family", "concave", "open", "containment"});
  const auto word = [](bool value) { return value ? "yes" : "no"; };
  for (const MethodInfo& info : settings.methods)
    table.add({info.name, info.title, info.source, info.family, word(info.domain.concave), word(info.domain.open),
               word(info.domain.containment)});
}
}  // namespace gpu_planning_scene::core::literature
