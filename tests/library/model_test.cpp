#include "library/include/softgrip/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "library/include/softgrip/error.h"
#include "library/include/softgrip/export.h"
#include "library/include/softgrip/version.h"
#include "tests/library/finger.h"

namespace softgrip::model_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Calls `call`. Returns the name of the argument that `call` refuses, or "" if `call` accepts all arguments.
template <class Call>
std::string refused_argument(Call call) {
  try {
    call();
  } catch (const InvalidArgument& error) {
    return error.argument();
  }
  return "";
}

TEST(LibraryModel, AWrittenModelIsReadBackUnchanged) {
  const Model model = bench_twin();
  EXPECT_EQ(model.name(), "bench_twin");
  EXPECT_EQ(model.unit(), Unit::mm);
  EXPECT_EQ(Model::parse(model.yaml()).hash(), model.hash());
  const Model other = model.with("transport_delay.delay_s", 0.2);
  EXPECT_NE(other.hash(), model.hash());
  EXPECT_EQ(other.parameters().front().name, "transport_delay.delay_s");
  EXPECT_EQ(other.parameters().front().value, 0.2);
  EXPECT_EQ(other.parameters().front().unit, "s");
}

TEST(LibraryModel, NamesTheLineOfAMalformedFile) {
  try {
    (void)Model::parse("name: x\nactuator:\n  - bouc_wenn: {}\n", "my.yaml");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("my.yaml:3:"), std::string::npos) << error.what();
  }
  try {
    (void)Model::load("/no/such/file.yaml");
    FAIL() << "reading a file that does not exist must throw";
  } catch (const FileError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("/no/such/file.yaml:1:1: the file cannot be read"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "the message must not quote the file: " << message;
  }
  EXPECT_THROW((void)Model::parse(std::string("\0\xff", 2)), FileError);
}

TEST(LibraryModel, StepwiseSimulationEqualsTheSimulationOfALog) {
  const Model model = bench_twin();
  const Course course = sine(0, 40, 0.2, 1000, 0.01);
  const std::vector<double> at_once = model.simulate(course.time_s, course.value);
  Simulator simulator(model, 0.01);
  simulator.reset(course.value.front());
  double worst = 0;
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    const double duration_s = i == 0 ? 0 : course.time_s[i] - course.time_s[i - 1];
    worst = std::max(worst, std::abs(simulator.step(duration_s, course.value[i]) - at_once[i]));
  }
  // The duration of a step is the difference of two floating-point times, so it deviates from 0.01 s by a
  // rounding error.
  EXPECT_LT(worst, 1e-10);
  EXPECT_GT(*std::max_element(at_once.begin(), at_once.end()), 5);
}

TEST(LibraryModel, AHeldCommandActsBetweenItsSampleAndTheNext) {
  const Model model = bench_twin();
  const std::vector<double> time_s{0, 1, 2, 3};
  const std::vector<double> pressure_kpa{0, 30, 30, 30};
  SimulateOptions held;
  held.held = true;
  const std::vector<double> moved = model.simulate(time_s, pressure_kpa, held);
  EXPECT_EQ(moved[1], moved[0]);
  Simulator simulator(model);
  (void)simulator.step(0, 30);
  EXPECT_DOUBLE_EQ(moved[2], simulator.step(1, 30));
}

TEST(LibraryModel, TheInverseLeadsToTheReference) {
  const Model model = bench_twin();
  const Course wanted = sine(4, 8, 0.1, 4000, 0.005);
  InverseOptions limits;
  limits.pressure_max_kpa = 80;
  const Inverse inverse = model.inverse(wanted.time_s, wanted.value, limits);
  SimulateOptions held;
  held.held = true;
  const std::vector<double> moved = model.simulate(wanted.time_s, inverse.pressure_kpa, held);
  std::size_t compared = 0;
  for (std::size_t i = 600; i < moved.size(); ++i, ++compared) {
    ASSERT_EQ(inverse.out_of_reach[i], 0) << i;
    ASSERT_NEAR(moved[i], wanted.value[i], 1e-3) << i;
  }
  EXPECT_EQ(compared, moved.size() - 600);
}

/// Returns bench_twin in degrees, with a motion that is ten times larger.
Model turning_twin() {
  Model model = bench_twin();
  for (const Parameter& one : model.parameters()) {
    if (one.name == "bouc_wen.alpha_mm_per_kpa" || one.name == "bouc_wen.beta_mm_per_kpa")
      model = model.with(one.name, 10 * one.value);
    if (one.name.starts_with("kelvin_voigt.")) model = model.with(one.name, 0.1 * one.value);
  }
  return Model::parse("output_unit: deg\n" + model.yaml());
}

/// Returns the largest error of the displacement that a finger reaches with the inverse of `wanted`. The
/// first 10 s do not count, because the initial difference decays in them.
double inverse_error(const Model& model, const Course& wanted) {
  SimulateOptions held;
  held.held = true;
  const std::vector<double> moved =
      model.simulate(wanted.time_s, model.inverse(wanted.time_s, wanted.value).pressure_kpa, held);
  double worst = 0;
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (wanted.time_s[i] > 10) worst = std::max(worst, std::abs(moved[i] - wanted.value[i]));
  return worst;
}

// Between two samples, the command is constant. The finger can therefore differ from the reference by a part
// of the change of the reference in one step.
TEST(LibraryModel, TheInverseFollowsTheReferenceWithAnyStep) {
  struct Motion {
    const char* name;
    Model model;
    double low, high, frequency_hz;
  };
  for (const Motion& motion :
       {Motion{"mm", bench_twin(), 3, 9, 0.15}, Motion{"deg", turning_twin(), 75, 125, 0.25}}) {
    for (const double step_s : {0.005, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0}) {
      const auto samples = static_cast<std::size_t>(60 / step_s);
      const Course wanted = sine(motion.low, motion.high, motion.frequency_hz, samples, step_s);
      const double fastest = std::numbers::pi * (motion.high - motion.low) * motion.frequency_hz;
      EXPECT_LT(inverse_error(motion.model, wanted), 0.5 * fastest * step_s) << motion.name << " " << step_s;
    }
  }
}

TEST(LibraryModel, TheInverseFollowsANoisyReference) {
  for (const double step_s : {0.001, 0.005, 0.01, 0.05}) {
    Course wanted = sine(3, 9, 0.05, static_cast<std::size_t>(40 / step_s), step_s);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.3);
    for (double& value : wanted.value) value += noise(random);
    EXPECT_LT(inverse_error(bench_twin(), wanted), 2.5) << step_s;
  }
}

TEST(LibraryModel, StatesThatAReferenceIsOutOfReach) {
  const Course wanted = sine(0, 20, 0.1, 2000, 0.01);
  InverseOptions limits;
  limits.pressure_max_kpa = 20;
  const Inverse inverse = bench_twin().inverse(wanted.time_s, wanted.value, limits);
  EXPECT_LE(*std::max_element(inverse.pressure_kpa.begin(), inverse.pressure_kpa.end()), 20);
  EXPECT_GT(std::count(inverse.out_of_reach.begin(), inverse.out_of_reach.end(), 1), 100);
}

TEST(LibraryModel, ErrorNamesTheInvalidArgument) {
  const Model model = bench_twin();
  const std::vector<double> two{0, 1};
  const std::vector<double> three{0, 1, 2};
  const std::vector<double> bad{0, nan};
  const std::vector<double> huge{0, infinity};
  const std::vector<double> back{0, -1};
  const std::vector<double> none;
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(two, three); }), "pressure_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(two, bad); }), "pressure_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(two, huge); }), "pressure_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(back, two); }), "time_s");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(none, none); }), "time_s");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(two, two, {.noise = -1}); }), "noise");
  EXPECT_EQ(refused_argument([&] { (void)model.simulate(two, two, {.supply_kpa = three}); }), "supply_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(std::vector<double>{0, 1, 3}, three); }), "time_s");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(two, bad); }), "displacement");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(std::vector<double>{0, 2}, two); }), "time_s");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(two, two, {.pressure_max_kpa = nan}); }),
            "pressure_max_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(two, two, {.slew_up_kpa_per_s = 0}); }),
            "slew_up_kpa_per_s");
  EXPECT_EQ(refused_argument([&] { (void)model.inverse(two, two, {.start_kpa = 101}); }), "start_kpa");
  EXPECT_EQ(refused_argument([&] { (void)model.with("no.such", 1); }), "parameter");
  EXPECT_EQ(refused_argument([&] { (void)model.with("transport_delay.delay_s", nan); }), "value");
  EXPECT_EQ(refused_argument([&] { Simulator(model, nan); }), "sample_time_s");
}

TEST(LibraryModel, ErrorStatesLengthsAndUnit) {
  const std::vector<double> two{0, 1};
  const std::vector<double> one{0};
  try {
    (void)bench_twin().simulate(two, one);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(),
                 "pressure_kpa: 1 values, but there are 2 times. One value per time is required, in kPa");
  }
}

TEST(LibraryModel, AStepIgnoresInvalidArguments) {
  Simulator simulator(bench_twin(), 0.01);
  const double before = simulator.step(0.01, 10);
  EXPECT_TRUE(std::isnan(simulator.step(-1, 10)));
  EXPECT_TRUE(std::isnan(simulator.step(nan, 10)));
  EXPECT_TRUE(std::isnan(simulator.step(0.01, infinity)));
  simulator.reset(nan);
  EXPECT_EQ(simulator.step(0, 10), before);
}

TEST(LibraryModel, HasAVersion) {
  EXPECT_EQ(version().find("0."), 0U);
}

}  // namespace
}  // namespace softgrip::model_test
