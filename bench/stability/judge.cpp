#include "stability/judge.h"

#include <cmath>
#include <exception>
#include <mutex>
#include <sstream>

#include "base/parallel_for.h"
#include "gpu_planning_scene/error.h"
#include "oracle/oracle.h"
#include "stability/peers.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
constexpr double kKnownTo = 2e-11;  // metres: covers the roundings of the construction far from the origin

struct Judged
{
  Case made;
  oracle::Verdict truth = oracle::Verdict::Either;
  std::array<bool, MethodCount> applies{};
  std::array<bool, MethodCount> collides{};
  std::array<bool, MethodCount> outside{};  ///< the case is outside the method's domain; only for wrong answers
};

struct Places
{
  explicit Places(const Case& c)
    : a(c.true_a.value_or(c.a)),
      b(c.true_b.value_or(c.b)),
      pose_a(oracle::Motion(c.link_a) * oracle::Motion(c.a_in_link)),
      pose_b(c.pose_b)
  {
  }
  oracle::PreparedShape a;
  oracle::PreparedShape b;
  oracle::Motion pose_a;
  oracle::Motion pose_b;
};

void checkConstruction(const Case& c, const Places& places)
{
  if (!c.known)
    return;
  const double distance = oracle::distance(places.a, places.pose_a, places.b, places.pose_b);
  if (std::abs(distance - *c.known) > kKnownTo)
  {
    std::ostringstream message;
    message << "the oracle finds a distance of " << distance << " m where a case was made with " << *c.known << " m";
    throw Error(message.str());
  }
}

void askPeers(const Family& family, Judged& judged)
{
  const auto answer = [&](Method method, std::optional<bool> collides)
  {
    judged.applies[method] = collides.has_value();
    judged.collides[method] = collides.value_or(false);
  };
  answer(FclDefault, fclCollides(judged.made, false));
  answer(FclOwn, fclCollides(judged.made, true));
  if (family.triangles)
    answer(PlainFloat, floatCollides(judged.made));
  if (family.convex)
    answer(BulletHulls, bulletCollides(judged.made));
}

/// `renders`: whether methods that render check this case.
void askLiterature(const Family& family, const LiteratureMethods& literature, bool renders, Judged& judged)
{
  for (std::size_t m = 0; family.triangles && m < MethodCount; ++m)
  {
    const auto method = static_cast<Method>(m);
    if (!literature.has(method) || (literature.renders(method) && !renders))
      continue;
    const std::optional<bool> collides = literature.collides(method, judged.made);
    judged.applies[m] = collides.has_value();
    judged.collides[m] = collides.value_or(false);
    const oracle::Verdict wrong = judged.collides[m] ? oracle::Verdict::Free : oracle::Verdict::Collides;
    judged.outside[m] =
        judged.applies[m] && judged.truth == wrong && !literature.inDomain(method, judged.made, judged.truth);
  }
}

Judged judgeOne(const Family& family, std::uint64_t seed, std::size_t index, const LiteratureMethods& literature,
                bool renders)
{
  Judged judged;
  judged.made = family.make(seed, index);
  const Places places(judged.made);
  checkConstruction(judged.made, places);
  judged.truth = oracle::verdict(places.a, places.pose_a, places.b, places.pose_b, requiredDistance(judged.made));
  askPeers(family, judged);
  askLiterature(family, literature, renders, judged);
  return judged;
}

std::string describe(const Judged& judged, Method method)
{
  const Places places(judged.made);
  std::ostringstream text;
  text.precision(12);
  text << "says " << (judged.collides[method] ? "collision" : "free") << ", true distance "
       << oracle::distance(places.a, places.pose_a, places.b, places.pose_b) << " m, required "
       << requiredDistance(judged.made) << " m";
  return text.str();
}
}  // namespace

Row judge(const Family& family, std::uint64_t seed, std::size_t count, Ours& ours, const LiteratureMethods& literature,
          const std::function<void(const Failure&)>& report)
{
  std::vector<Judged> all(count);
  std::exception_ptr error;
  std::mutex mutex;
  const std::size_t pictures = (count + LiteratureMethods::kCasesPerPicture - 1) / LiteratureMethods::kCasesPerPicture;
  parallelFor(count, 4,
              [&](std::size_t begin, std::size_t end)
              {
                for (std::size_t i = begin; i < end; ++i)
                {
                  try
                  {
                    all[i] = judgeOne(family, seed, i, literature, i < pictures);
                  }
                  catch (...)
                  {
                    const std::lock_guard<std::mutex> lock(mutex);
                    error = std::current_exception();
                  }
                }
              });
  if (error)
    std::rethrow_exception(error);

  std::vector<Case> cases;
  for (const Judged& judged : all)
    cases.push_back(judged.made);
  const Ours::Answers answers = ours.check(cases, family.origin);
  Row row;
  row.family = family.name;
  row.undecided = answers.undecided;
  row.proven = answers.proven;
  for (std::size_t i = 0; i < count; ++i)
  {
    Judged& judged = all[i];
    row.colliding += judged.truth == oracle::Verdict::Collides ? 1 : 0;
    row.free += judged.truth == oracle::Verdict::Free ? 1 : 0;
    row.either += judged.truth == oracle::Verdict::Either ? 1 : 0;
    const bool exact_of_first = answers.exact[i - i % family.copies] != 0;
    for (std::size_t m = 0; m < MethodCount; ++m)
    {
      const auto method = static_cast<Method>(m);
      const bool own = methodNames()[m].ours;
      if (own)
      {
        const std::vector<std::uint8_t>& answer = method == WorkQueues     ? answers.work_queue
                                                  : method == BreadthFirst ? answers.breadth_first
                                                  : method == ExactChecker ? answers.exact
                                                                           : answers.proofs;
        judged.applies[m] = i < answer.size();
        judged.collides[m] = judged.applies[m] && answer[i] != 0;
      }
      if (!judged.applies[m])
        continue;
      Cell& cell = row.cells[m];
      const std::size_t wrong_before = cell.wrong();
      stability::count(cell, judged.truth, judged.collides[m]);
      cell.outside += judged.outside[m] ? 1 : 0;
      if (own && judged.truth == oracle::Verdict::Either && judged.collides[m] != exact_of_first)
        ++cell.inconsistent;
      if (own && cell.wrong() > wrong_before)
        report({family.name, i, method, describe(judged, method)});
    }
  }
  return row;
}
}  // namespace gpu_planning_scene::core::stability
