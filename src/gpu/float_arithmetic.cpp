#include "gpu/float_arithmetic.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include "base/seconds_since.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "shader_constants.h"

// Runs kernels on known numbers and compares their results with those of the CPU in double, in which the sum and the
// product of two of the floats are exact. Two-sum (D. E. Knuth: The Art of Computer Programming, volume 2, 1969) and
// two-product (T. J. Dekker: A floating-point technique for extending the available precision. Numerische Mathematik
// 18, 1971) give the right errors only if the device rounds properly and the compiler keeps the operations as written.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kCases = 4096;

// Of self_test/double_size.comp. A multiplication and an addition add 8 to 16 bytes to a program of Mesa's drivers, and
// 8,600 where they are emulated (docs/gpu.md). Their compilation takes less than 1 ms, or else over 30 ms.
constexpr int kMultiplyAdds = 4;
constexpr std::size_t kEmulatedBytes = 1000;
constexpr double kEmulatedSeconds = 0.005;

struct Outcome
{
  float sum, sum_error, product, product_error;
  float left, length, comparison_holds, dot;
};
static_assert(sizeof(Outcome) == OUTCOME_TEXELS * TexelBuffer::kTexelBytes, "the layout of the shader");

/// Numbers of 24 random bits, most of them between 2^-12 and 2^12. The sum and the product of two are exact in double.
std::vector<std::array<float, 2>> someNumbers()
{
  std::mt19937 generator(20031);
  const auto number = [&]
  {
    const auto bits = static_cast<float>(generator() >> 8U | 1U);
    const int exponent = static_cast<int>(generator() % 24) - 35;
    return std::ldexp(generator() % 2 == 0 ? bits : -bits, exponent);
  };
  std::vector<std::array<float, 2>> numbers(kCases);
  for (auto& pair : numbers)
    pair = {number(), number()};
  return numbers;
}

/// The fault of the outcome for x and y; nullptr if there is none.
const char* faultOf(double x, double y, const Outcome& found)
{
  const double sum = x + y;
  const double product = x * y;
  const double length = std::sqrt(2.0 * x * x + y * y);
  if (!(std::abs(found.sum - sum) <= UNIT_ROUNDOFF * std::abs(sum)))
    return "a sum is not rounded properly";
  if (static_cast<double>(found.sum) + found.sum_error != sum)
    return "two-sum does not give the rounding error of a sum";
  if (!(std::abs(found.product - product) <= UNIT_ROUNDOFF * std::abs(product)))
    return "a product is not rounded properly";
  if (static_cast<double>(found.product) + found.product_error != product)
    return "two-product does not give the rounding error of a product";
  if (found.left != 0.0F)
    return "a product and a difference are contracted where `precise` forbids it";
  if (!(std::abs(found.length - length) <= 4.0 * UNIT_ROUNDOFF * length))
    return "a length has a relative error above 2^-21";
  if (!(std::abs(found.dot - (x * y + y * y + x * x)) <= 3.0 * UNIT_ROUNDOFF * (std::abs(x * y) + y * y + x * x)))
    return "a dot product is off by more than 3 units of 2^-23 of its terms";
  if (found.comparison_holds != 0.0F)
    return "a comparison with NaN is true";
  return nullptr;
}
Program doubleProgram(const std::string& shader_folder, int multiply_adds)
{
  return Program(shader_folder, "self_test/double_size.comp",
                 "#define MULTIPLY_ADDS " + std::to_string(multiply_adds) + "\n");
}

/// The least time of three compilations, so that other work on the machine matters less.
double secondsToCompile(const std::string& shader_folder, int multiply_adds)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
  {
    const auto start = std::chrono::steady_clock::now();
    doubleProgram(shader_folder, multiply_adds);
    least = std::min(least, secondsSince(start));
  }
  return least;
}
}  // namespace

std::string findFloatFault(const std::string& shader_folder)
{
  std::vector<std::array<float, 2>> numbers = someNumbers();
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  numbers.push_back({kNoNumber, kNoNumber});
  Buffer input(numbers.size() * sizeof(numbers.front()));
  input.write(numbers);
  Buffer output(kCases * sizeof(Outcome));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_A);
  const Program program(shader_folder, "self_test/float_arithmetic.comp");
  program.set(LOCATION_CASE_COUNT, kCases);
  program.dispatch(kCases / GROUP_SIZE);
  std::vector<Outcome> outcomes(kCases);
  output.read(outcomes.data(), kCases * sizeof(Outcome));
  for (std::size_t i = 0; i < kCases; ++i)
    if (const char* fault = faultOf(numbers[i][0], numbers[i][1], outcomes[i]))
    {
      std::ostringstream line;
      line.precision(9);
      line << "float32 arithmetic: " << fault << " (for " << numbers[i][0] << " and " << numbers[i][1]
           << "); the CPU decides every pair whose boxes overlap";
      return line.str();
    }
  return {};
}

std::string findDoubleFault(const std::string& shader_folder)
{
  constexpr double kRelative = 0x1p-50;
  std::vector<std::array<double, 2>> numbers;
  std::mt19937_64 generator(20032);
  std::uniform_real_distribution<double> uniform(-8.0, 8.0);
  for (std::size_t i = 0; i < kCases; ++i)
    numbers.push_back({uniform(generator), uniform(generator)});
  Buffer input(kCases * sizeof(numbers.front()));
  input.write(numbers);
  Buffer output(kCases * 4 * sizeof(double));
  Buffer rounded(kCases * sizeof(float));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_A);
  rounded.bindStorage(BINDING_B);
  const Program program(shader_folder, "self_test/double_arithmetic.comp");
  program.set(LOCATION_CASE_COUNT, kCases);
  program.dispatch(kCases / GROUP_SIZE);
  std::vector<std::array<double, 4>> results(kCases);
  std::vector<float> floats(kCases);
  output.read(results.data(), kCases * sizeof(results.front()));
  rounded.read(floats.data(), kCases * sizeof(float));
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const auto [x, y] = numbers[i];
    const std::array<double, 4> expected = {x + y, x * y, x / y, std::sqrt(std::abs(x * y))};
    for (std::size_t k = 0; k < 4; ++k)
      if (!(std::abs(results[i][k] - expected[k]) <= kRelative * std::abs(expected[k])))
        return "double precision: an operation has a relative error above 2^-50; the CPU computes the link poses";
    if (!(std::abs(floats[i] - expected[1]) <= (0x1p-24 + kRelative) * std::abs(expected[1])))
      return "double precision: numbers are not rounded to the nearest float; the CPU computes the link poses";
  }
  return {};
}

std::string findEmulatedDouble(const std::string& shader_folder)
{
  const std::size_t without = doubleProgram(shader_folder, 0).binaryBytes();
  const std::size_t bytes = doubleProgram(shader_folder, kMultiplyAdds).binaryBytes();
  // A driver without program binaries keeps no compiled programs either, so the time to compile is a measure.
  const bool emulated = without > 0 ? bytes > without + kMultiplyAdds * kEmulatedBytes
                                    : secondsToCompile(shader_folder, kMultiplyAdds) >
                                          secondsToCompile(shader_folder, 0) + kMultiplyAdds * kEmulatedSeconds;
  return emulated ? "double precision: the driver emulates it; the CPU computes the link poses" : "";
}
}  // namespace gpu_planning_scene::core
