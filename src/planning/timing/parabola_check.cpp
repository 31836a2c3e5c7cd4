#include "planning/timing/parabola_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gpu_planning_scene/interpolation.h"

// Under MotionRule::Samples, the samples of a parabola are checked. Under MotionRule::Bound, a parabola is cut into
// pieces. In the middle of a piece, a check with margins proves the neighbourhood that contains the piece. A piece
// without a proof is halved, as MotionChecker halves straight segments (Schwarzer, Saha, Latombe 2002).
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kAtOnce = 1024;  // states between two calls of `stop`
// A stop at the waypoint takes the place of a parabola that is not valid, so a long proof is not worth its time.
constexpr std::size_t kMostPieces = 500;
constexpr double kLargestStep = 1.0;     // radians: travel of angles is measured along the shorter arc
constexpr double kAngleRounding = 1e-9;  // radians: four units in the last place of the largest angle that is proven

class ParabolaCheck
{
 public:
  ParabolaCheck(const RobotModel& robot, StateChecker& checker, const std::string& group,
                const MotionCheckerOptions& options, const std::vector<Phase>& parabolas,
                const std::function<bool()>& stop)
    : robot_(robot),
      checker_(checker),
      group_(group),
      options_(options),
      parabolas_(parabolas),
      stop_(stop),
      steps_(stepsOf(robot, options.steps)),
      valid_(parabolas.size(), 1)
  {
  }

  std::vector<std::uint8_t> run()
  {
    if (options_.rule == MotionRule::Samples)
      checkSamples();
    else
      prove();
    return valid_;
  }

 private:
  /// A piece from middle - half to middle + half, in seconds.
  struct Piece
  {
    std::size_t parabola;
    double middle;
    double half;
  };

  static Eigen::ArrayXd stepsOf(const RobotModel& robot, const MotionSteps& steps)
  {
    Eigen::ArrayXd result = Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(robot.variables().size()),
                                                     std::min(kLargestStep, steps.revolute));
    for (const Joint& joint : robot.joints())
    {
      const int lengths = joint.type == JointType::Prismatic  ? 1
                          : joint.type == JointType::Planar   ? 2
                          : joint.type == JointType::Floating ? 3
                                                              : 0;
      if (!joint.mimic && lengths > 0)
        result.segment(joint.first_variable, lengths) = steps.prismatic;
    }
    return result;
  }

  /// Number of steps along the parabola, so that no variable moves by more than its step in one of them.
  double stepCount(const Phase& parabola) const
  {
    const Eigen::ArrayXd speed = parabola.velocity.abs().max(parabola.velocityAt(parabola.seconds).abs());
    return std::max(1.0, std::ceil((parabola.seconds * speed / steps_).maxCoeff()));
  }

  /// Checks the middles of the pieces, with margins or without. Returns one byte per piece.
  std::vector<std::uint8_t> check(const std::vector<Piece>& pieces, bool with_margins)
  {
    const std::size_t width = robot_.variables().size();
    std::vector<std::uint8_t> free;
    for (std::size_t begin = 0; begin < pieces.size(); begin = free.size())
    {
      const std::size_t count = std::min(kAtOnce, pieces.size() - begin);
      if (stop_ && stop_())
      {
        std::fill(valid_.begin(), valid_.end(), 0);
        free.resize(pieces.size());
        return free;
      }
      std::vector<double> states(count * width);
      JointNeighbourhood around;
      for (std::size_t i = 0; i < count; ++i)
      {
        const Piece& piece = pieces[begin + i];
        Eigen::Map<Eigen::ArrayXd>(&states[i * width], static_cast<Eigen::Index>(width)) =
            parabolas_[piece.parabola].positionAt(piece.middle);
        if (with_margins)
          addNeighbourhood(piece, &states[i * width], around);
      }
      const BatchResult result = checker_.check(states.data(), count, group_, with_margins ? &around : nullptr);
      free.insert(free.end(), result.valid.begin(), result.valid.end());
    }
    return free;
  }

  /// The travel of the joints within the piece, from the state in its middle.
  void addNeighbourhood(const Piece& piece, const double* middle, JointNeighbourhood& around) const
  {
    const Phase& parabola = parabolas_[piece.parabola];
    const auto width = static_cast<Eigen::Index>(robot_.variables().size());
    const Eigen::ArrayXd reached =
        Eigen::Map<const Eigen::ArrayXd>(middle, width) +
        piece.half * (parabola.velocityAt(piece.middle).abs() + 0.5 * piece.half * parabola.acceleration.abs());
    for (JointTravel& joint : jointTravel(robot_, middle, reached.data()))
    {
      joint.angle += joint.angle > 0.0 ? kAngleRounding : 0.0;
      around.travel.push_back(joint);
    }
    around.rows.push_back(static_cast<std::uint32_t>(around.rows.size()));
    around.centers.insert(around.centers.end(), middle, middle + width);
  }

  void checkSamples()
  {
    std::vector<Piece> samples;
    for (std::size_t i = 0; i < parabolas_.size(); ++i)
    {
      const double steps = stepCount(parabolas_[i]);
      if (steps >= static_cast<double>(options_.max_samples))
        valid_[i] = 0;
      else
        for (std::size_t k = 0; k <= static_cast<std::size_t>(steps); ++k)
          samples.push_back({i, static_cast<double>(k) / steps * parabolas_[i].seconds, 0.0});
    }
    rejectUnlessFree(samples);
  }

  /// Rejects the parabolas of the pieces whose middles collide.
  void rejectUnlessFree(const std::vector<Piece>& pieces)
  {
    const std::vector<std::uint8_t> free = check(pieces, false);
    for (std::size_t i = 0; i < pieces.size(); ++i)
      if (free[i] == 0)
        valid_[pieces[i].parabola] = 0;
  }

  void prove()
  {
    std::vector<std::size_t> examined(parabolas_.size());
    std::vector<Piece> open;
    for (std::size_t i = 0; i < parabolas_.size(); ++i)
      addPieces(i, open);
    while (!open.empty())
    {
      const std::vector<std::uint8_t> proven = check(open, true);
      std::vector<Piece> near;
      for (std::size_t i = 0; i < open.size(); ++i)
      {
        ++examined[open[i].parabola];
        if (proven[i] == 0)
          near.push_back(open[i]);
      }
      rejectUnlessFree(near);
      open.clear();
      for (const Piece& piece : near)
        if (examined[piece.parabola] >= std::min(kMostPieces, options_.max_samples))
          valid_[piece.parabola] = 0;
      for (const Piece& piece : near)
        if (valid_[piece.parabola] != 0)
          for (const double side : {-0.5, 0.5})
            open.push_back({piece.parabola, piece.middle + side * piece.half, 0.5 * piece.half});
    }
  }

  /// The first pieces of a parabola. They are twice as wide as the steps, because most of them can be proven free.
  void addPieces(std::size_t parabola, std::vector<Piece>& pieces)
  {
    const double count = std::ceil(0.5 * stepCount(parabolas_[parabola]));
    if (count > static_cast<double>(kMostPieces))
    {
      valid_[parabola] = 0;
      return;
    }
    const double half = 0.5 * parabolas_[parabola].seconds / count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      pieces.push_back({parabola, static_cast<double>(2 * k + 1) * half, half});
  }

  const RobotModel& robot_;
  StateChecker& checker_;
  const std::string& group_;
  const MotionCheckerOptions& options_;
  const std::vector<Phase>& parabolas_;
  const std::function<bool()>& stop_;
  const Eigen::ArrayXd steps_;
  std::vector<std::uint8_t> valid_;
};
}  // namespace

std::vector<std::uint8_t> validParabolas(const RobotModel& robot, StateChecker& checker, const std::string& group,
                                         const MotionCheckerOptions& options, const std::vector<Phase>& parabolas,
                                         const std::function<bool()>& stop)
{
  return ParabolaCheck(robot, checker, group, options, parabolas, stop).run();
}
}  // namespace gpu_planning_scene::core
