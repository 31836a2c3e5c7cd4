// Each method agrees with the oracle in easy cases of its domain, and fails where its authors say.

#include <gtest/gtest.h>

#include "literature/method.h"
#include "literature/models.h"
#include "literature/pair_truth.h"
#include "literature/poses.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Answers = std::vector<std::uint8_t>;

constexpr std::size_t kPoses = 40;  // at each distance

std::vector<MethodInfo> allMethods()
{
  std::vector<MethodInfo> methods = ourMethods();
  for (const auto& others : {deviceMethods(), treeMethods(), libraryMethods()})
    methods.insert(methods.end(), others.begin(), others.end());
  return methods;
}

/// For meshes of about a metre.
std::vector<Isometry3d> easyPoses()
{
  std::vector<Isometry3d> poses;
  for (const double distance : {0.4, 0.7, 0.8, 0.95})
    for (const Isometry3d& pose : posesAt(distance, kPoses, 1))
      poses.push_back(pose);
  return poses;
}

/// 1 for each pose at which the surfaces meet, 0 if they are apart, -1 within a hundredth of a millimetre of contact.
std::vector<int> trueAnswers(const Model& a, const Model& b, const std::vector<Isometry3d>& poses)
{
  constexpr double kEasy = 1e-5;  // metres
  const PairTruth truth(a.mesh, b.mesh);
  std::vector<int> answers;
  for (const Isometry3d& pose : poses)
  {
    const double distance = truth.surfaces(pose, kEasy);
    answers.push_back(distance >= kEasy ? 0 : distance > 0.0 ? -1 : 1);
  }
  return answers;
}

std::shared_ptr<const Mesh> scaled(const Mesh& mesh, double factor)
{
  auto made = std::make_shared<Mesh>(mesh);
  for (Vector3d& vertex : made->vertices)
    vertex *= factor;
  return made;
}

std::vector<Isometry3d> scaled(std::vector<Isometry3d> poses, double factor)
{
  for (Isometry3d& pose : poses)
    pose.translation() *= factor;
  return poses;
}

Answers answersOf(const MethodInfo& info, const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                  const std::vector<Isometry3d>& poses)
{
  return info.make(a, b)->collide(poses);
}

const MethodInfo& methodNamed(const std::vector<MethodInfo>& methods, const std::string& name)
{
  return *std::find_if(
      methods.begin(), methods.end(), [&](const MethodInfo& info) { return info.name == name; });
}
}  // namespace

// The meshes differ. With two copies of one mesh, the inverse of a pose would get the same answer.
TEST(LiteratureMethods, AgreeWithTheOracleInEasyCases)
{
  const std::vector<Isometry3d> poses = easyPoses();
  const Model torus = madeModel("torus", 500, 1);
  for (const char* name : {"lump", "car"})
  {
    const Model other = madeModel(name, 500, 1);
    const std::vector<int> expected = trueAnswers(torus, other, poses);
    EXPECT_GT(std::count(expected.begin(), expected.end(), 1), static_cast<std::ptrdiff_t>(kPoses / 2)) << name;
    EXPECT_GT(std::count(expected.begin(), expected.end(), 0), static_cast<std::ptrdiff_t>(kPoses / 2)) << name;
    for (const MethodInfo& info : allMethods())
    {
      // The car has needles, for which GImpact invents contacts: one or two in a hundred free poses.
      if (info.name == "gimpact" && name == std::string("car"))
        continue;
      const Answers answers = answersOf(info, torus.mesh, other.mesh, poses);
      ASSERT_EQ(answers.size(), poses.size());
      for (std::size_t i = 0; i < poses.size(); ++i)
        EXPECT_TRUE(expected[i] < 0 || answers[i] == expected[i]) << info.name << ", " << name << ", pose " << i;
    }
  }
}

TEST(LiteratureMethods, AMeshInsideAnotherIsFoundByThoseThatClaimIt)
{
  const Model model = madeModel("sphere", 500, 1);
  const auto inner = scaled(*model.mesh, 0.3);
  for (const MethodInfo& info : allMethods())
    EXPECT_EQ(answersOf(info, model.mesh, inner, posesAt(0.05, 5, 1)), Answers(5, info.domain.containment ? 1 : 0))
        << info.name;
}

// RAPID's epsilon is added to a rotation, which has no unit. So it fails at no unit.
TEST(LiteratureMethods, OrientedBoxesGiveTheSameAnswersInEveryUnit)
{
  const std::vector<MethodInfo> methods = treeMethods();
  const Model model = madeModel("torus", 500, 1);
  const std::vector<Isometry3d> poses = easyPoses();
  const Answers expected = answersOf(methodNamed(methods, "rapid"), model.mesh, model.mesh, poses);
  for (const double unit : {1e-6, 1e6})
  {
    const auto mesh = scaled(*model.mesh, unit);
    EXPECT_EQ(answersOf(methodNamed(methods, "rapid"), mesh, mesh, scaled(poses, unit)), expected) << unit;
  }
}

TEST(LiteratureMethods, WorkIsCountedForTheTrees)
{
  const Model model = madeModel("torus", 500, 1);
  for (const MethodInfo& info : treeMethods())
  {
    const auto method = info.make(model.mesh, model.mesh);
    method->collide(posesAt(0.7, 10, 1));
    const WorkCounts work = method->work();
    ASSERT_GE(work.size(), 2U);
    EXPECT_EQ(work[0].first, "volume tests");
    EXPECT_GT(work[0].second, 10.0);
    EXPECT_EQ(work[1].first, "triangle tests");
    EXPECT_GT(work[1].second, 0.0);
  }
}
}  // namespace gpu_planning_scene::core::literature
