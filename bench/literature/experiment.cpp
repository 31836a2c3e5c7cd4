#include "literature/experiment.h"

#include <algorithm>
#include <iostream>
#include <memory>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "gpu_planning_scene/error.h"
#include "literature/exact_pair.h"
#include "literature/models.h"
#include "literature/pair_truth.h"
#include "literature/poses.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using benchmark::CsvTable;
using benchmark::median;
using benchmark::Stopwatch;
using Answers = std::vector<std::uint8_t>;

constexpr std::size_t kFewPoses = 4;  // of the trial that finds how slow a method is
constexpr std::size_t kMostRepeats = 5;
constexpr std::size_t kClearancePoses = 60;
constexpr std::size_t kMostQuickTriangles = 5000;  // of a robot's link that --quick measures

/// Poses of one protocol at one distance, with the true answers.
struct Sample
{
  std::string protocol;
  double distance;  ///< of the centres ("turning") or of the surfaces ("clearance"), divided by the model's size
  std::vector<Eigen::Isometry3d> poses;
  Answers truth;  ///< of the exact checker
};

/// The contract allows both answers for distances of up to 1e-9 m, and the exact checker reports a collision for some
/// of them. If a method gives another answer, the oracle decides whether the pose is such a case. Its trees are made
/// for the first such pose of a model.
class Referee
{
 public:
  explicit Referee(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)) {}

  bool eitherAnswerIsRight(const Eigen::Isometry3d& pose)
  {
    if (!truth_)
      truth_ = std::make_unique<PairTruth>(mesh_, mesh_);
    const double distance = truth_->solids(pose, 2.0 * oracle::kTolerance);
    return distance > 0.0 && distance <= oracle::kTolerance;
  }

 private:
  std::shared_ptr<const Mesh> mesh_;
  std::unique_ptr<PairTruth> truth_;
};

/// Distances of the centres, from just apart to deep overlap.
std::vector<double> turningDistances(bool quick)
{
  return quick ? std::vector<double>{0.99, 0.7}
               : std::vector<double>{1.1, 1.05, 1.01, 0.99, 0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5};
}

std::vector<double> clearances(bool quick)
{
  return quick ? std::vector<double>{0.01} : std::vector<double>{1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4};
}

std::vector<Sample> samplesOf(const Model& model, const Settings& settings)
{
  std::vector<Sample> samples;
  for (const std::string& protocol : settings.protocols)
  {
    if (protocol == "turning")
      for (const double distance : turningDistances(settings.quick))
        samples.push_back({protocol, distance, turningPoses(distance * model.size, settings.seed), {}});
    else
      for (const double clearance : clearances(settings.quick))
        samples.push_back({protocol,
                           clearance,
                           posesWithClearance(*model.mesh, *model.mesh, model.size, clearance * model.size,
                                              kClearancePoses, settings.seed),
                           {}});
  }
  const ExactPair exact(pairProblem(model.mesh, model.mesh));
  for (Sample& sample : samples)
    sample.truth = exact.collide(sample.poses);
  return samples;
}

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
void countWrong(const Answers& answers, const Sample& sample, Referee& referee, Measurement& result)
{
  std::size_t missed = 0;
  std::size_t invented = 0;
  for (std::size_t i = 0; i < answers.size(); ++i)
    if ((answers[i] != 0) != (sample.truth[i] != 0) && !referee.eitherAnswerIsRight(sample.poses[i]))
      ++(answers[i] != 0 ? invented : missed);
  result.missed = std::max(result.missed, missed);
  result.invented = std::max(result.invented, invented);
}

Measurement measure(Method& method, const Sample& sample, double seconds, Referee& referee)
{
  const std::size_t few_count = std::min(kFewPoses, sample.poses.size());
  const std::vector<Eigen::Isometry3d> few(sample.poses.begin(),
                                           sample.poses.begin() + static_cast<std::ptrdiff_t>(few_count));
  const double trial = benchmark::secondsOf([&] { method.collide(few); });
  const auto affordable = static_cast<std::size_t>(static_cast<double>(few_count) * seconds / trial);
  const std::vector<Eigen::Isometry3d> asked(
      sample.poses.begin(),
      sample.poses.begin() + static_cast<std::ptrdiff_t>(std::clamp(affordable, few_count, sample.poses.size())));

  Measurement result;
  result.poses = asked.size();
  const auto queries = static_cast<double>(asked.size());
  std::vector<double> wall;
  std::vector<double> cpu;
  double spent = 0.0;
  const WorkCounts before = method.work();
  for (std::size_t repeat = 0; repeat < kMostRepeats && (repeat == 0 || spent < seconds); ++repeat)
  {
    const Stopwatch watch;
    const Answers answers = method.collide(asked);
    wall.push_back(1e6 * watch.seconds() / queries);
    cpu.push_back(1e6 * watch.cpuSeconds() / queries);
    spent += watch.seconds();
    countWrong(answers, sample, referee, result);
  }
  result.us_a_query = median(wall);
  result.cpu_us_a_query = median(cpu);
  result.work = difference(before, method.work(), queries * static_cast<double>(wall.size()));
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
  return static_cast<double>(std::count(sample.truth.begin(), sample.truth.end(), 1)) /
         static_cast<double>(sample.truth.size());
}

/// Returns the number of wrong answers.
std::size_t measureMethod(const MethodInfo& info, const Model& model, const std::vector<Sample>& samples,
                          double seconds, Referee& referee, Tables& tables)
{
  const std::size_t triangles = model.mesh->triangles.size();
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
  tables.builds.add({model.name, triangles, info.name, building.seconds(), ""});
  std::size_t wrong = 0;
  for (const Sample& sample : samples)
  {
    if (sample.poses.empty())
      continue;
    const Measurement m = measure(*method, sample, seconds, referee);
    tables.times.add({sample.protocol, model.name, triangles, model.size, sample.distance, collidingShare(sample),
                      info.name, info.title, info.family, inDomain(info, model) ? "yes" : "no", m.poses, m.us_a_query,
                      m.cpu_us_a_query, m.missed, m.invented});
    for (const auto& [what, count] : m.work)
      tables.work.add({sample.protocol, model.name, triangles, sample.distance, info.name, what, count});
    wrong += m.missed + m.invented;
  }
  return wrong;
}
}  // namespace

std::size_t measureExperiment(const Settings& settings)
{
  Tables tables(settings.out);
  std::vector<Model> models = settings.robot_links ? robotLinks() : std::vector<Model>();
  if (settings.quick)
    models.erase(std::remove_if(models.begin(), models.end(),
                                [](const Model& model) { return model.mesh->triangles.size() > kMostQuickTriangles; }),
                 models.end());
  for (const std::string& name : settings.models)
    for (const std::size_t triangles : settings.triangles)
      models.push_back(madeModel(name, triangles, settings.seed));
  std::size_t wrong = 0;
  ProgressBar progress("experiment", models.size() * settings.methods.size());
  std::size_t done = 0;
  for (const Model& model : models)
  {
    const std::vector<Sample> samples = samplesOf(model, settings);
    Referee referee(model.mesh);
    for (const MethodInfo& info : settings.methods)
    {
      progress.update(done++);
      const std::size_t of_method = measureMethod(info, model, samples, settings.seconds, referee, tables);
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
