// Tests which conclusions a gauge check draws about a sensor, and in which cases it draws no conclusion. The
// sensors are simulated with separate formulas, not with the blocks of the catalogue.

#include "sysid/diagnosis/gauge/gauge_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "model/catalogue.h"

namespace softgrip::sysid::gauge_check_test {
namespace {

constexpr double span_mm = 24;
constexpr double noise_mm = 0.04;
const GaugeScales scales{noise_mm, -0.1, span_mm};

using Sensor = std::function<double(double)>;

double straight(double y) {
  return y;
}
Sensor bent(double bow_mm) {
  return [=](double y) { return y + 4 * bow_mm * (y / span_mm) * (1 - y / span_mm); };
}
Sensor ending(double at_mm) {
  return [=](double y) { return std::min(y, at_mm); };
}

SensorShape bend_of_logs(double bow_mm) {
  return {{{*model::find_block("sensor_nonlinearity"), {bow_mm, 0, span_mm}}}, 0};
}
SensorShape end_of_logs(double at_mm) {
  return {{{*model::find_block("sensor_saturation"), {-1e4, at_mm}}}, 0};
}

/// Returns the readings of gauge and sensor at the given positions. `gauge_zero_mm` and `gauge_scale` are the
/// zero offset and the scale of the gauge; the gauge check does not know them.
std::vector<GaugeReading> read(const Sensor& sensor, double noise, std::vector<double> positions,
                               double gauge_zero_mm = 3, double gauge_scale = 1.01) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, noise);
  std::vector<GaugeReading> readings;
  for (const double y : positions)
    readings.push_back({gauge_zero_mm + gauge_scale * y, sensor(y) + normal(random), 1});
  return readings;
}
std::vector<GaugeReading> read(const Sensor& sensor, double noise) {
  return read(sensor, noise, planned_positions(span_mm));
}

const GaugeFit& of(const GaugeCheck& check, const std::string& id) {
  return *std::find_if(check.fits.begin(), check.fits.end(),
                       [&](const GaugeFit& fit) { return fit.shape.id() == id; });
}

TEST(GaugeCheck, ConfirmsTheNonlinearityPredictedFromTheLogs) {
  const GaugeCheck check = check_gauge(read(bent(0.4), noise_mm), {{}, bend_of_logs(0.4)}, scales);
  EXPECT_EQ(check.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(check, "straight").ruled_out);
  EXPECT_FALSE(of(check, "sensor_nonlinearity").ruled_out);
  EXPECT_GT(check.log_likelihood_ratio, gauge_log_likelihood_needed);
  EXPECT_NEAR(of(check, "sensor_nonlinearity").rms_mm, noise_mm, 0.02);
}

TEST(GaugeCheck, RulesOutNonlinearityForALinearSensor) {
  for (const double bow_mm : {0.4, -0.4}) {
    const GaugeCheck check = check_gauge(read(straight, noise_mm), {bend_of_logs(bow_mm), {}}, scales);
    EXPECT_EQ(check.outcome, GaugeOutcome::decided);
    EXPECT_TRUE(of(check, "sensor_nonlinearity").ruled_out);
    EXPECT_FALSE(of(check, "straight").ruled_out);
    EXPECT_FALSE(check.departure().clear);
  }
}

TEST(GaugeCheck, FindsSaturationOnlyIfThePositionsReachTheLimit) {
  const std::vector<SensorShape> hypotheses{{}, end_of_logs(23)};
  const GaugeScales until_end{noise_mm, 0, 23.1};
  const GaugeCheck reached = check_gauge(read(ending(23), noise_mm), hypotheses, until_end);
  EXPECT_EQ(reached.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(reached, "straight").ruled_out);
  EXPECT_TRUE(reached.departure().clips);

  const std::vector<double> short_of_it{0, 5, 10, 15, 20, 20, 15, 10, 5, 0};
  const GaugeCheck missed = check_gauge(read(ending(23), noise_mm, short_of_it), hypotheses, until_end);
  EXPECT_EQ(missed.outcome, GaugeOutcome::undecided);
  EXPECT_FALSE(of(missed, "straight").ruled_out);
}

TEST(GaugeCheck, LinearReadingBeyondTheLimitRulesOutSaturation) {
  const GaugeCheck check =
      check_gauge(read(straight, noise_mm), {end_of_logs(23), {}}, GaugeScales{noise_mm, 0, 23.1});
  EXPECT_EQ(check.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(check, "sensor_saturation").ruled_out);
}

TEST(GaugeCheck, SaturationBeyondTheRangeOfTheLogsIsIgnored) {
  const Sensor sensor = [](double y) { return std::min(y, 1.15 * span_mm); };
  const GaugeCheck check = check_gauge(read(sensor, noise_mm), {{}, bend_of_logs(0.4)}, scales);
  EXPECT_EQ(check.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(check, "sensor_nonlinearity").ruled_out);
}

TEST(GaugeCheck, ConstantReadingsOrSmallRangeAreUncovered) {
  const std::vector<double> low{0, 2, 4, 6, 8, 10, 8, 6, 4, 2, 0};
  for (const auto& readings : {read([](double) { return 7; }, noise_mm), read(straight, 0.001, low)}) {
    const GaugeCheck check = check_gauge(readings, {{}, bend_of_logs(2)}, scales);
    EXPECT_EQ(check.outcome, GaugeOutcome::uncovered);
    for (const GaugeFit& fit : check.fits) EXPECT_FALSE(fit.ruled_out);
  }
}

TEST(GaugeCheck, HighNoiseLeavesTheOutcomeUndecided) {
  for (const Sensor& sensor : {Sensor(straight), bent(0.1)}) {
    const GaugeCheck check = check_gauge(read(sensor, 0.4), {{}, bend_of_logs(0.1)}, scales);
    EXPECT_EQ(check.outcome, GaugeOutcome::undecided);
    EXPECT_GT(check.noise_mm, 0.25) << "the noise must include the scatter of the readings at one position";
  }
}

TEST(GaugeCheck, LogNoiseAppliesToSingleSampleReadings) {
  std::vector<GaugeReading> readings = read(bent(0.06), 0);
  EXPECT_EQ(check_gauge(readings, {{}, bend_of_logs(0.06)}, scales).outcome, GaugeOutcome::undecided);
  for (GaugeReading& r : readings) r.samples = 200;
  EXPECT_EQ(check_gauge(readings, {{}, bend_of_logs(0.06)}, scales).outcome, GaugeOutcome::decided);
}

TEST(GaugeCheck, NonlinearityOfADifferentSizeIsUnexplained) {
  for (const double really_mm : {0.2, 0.8, -0.4}) {
    const GaugeCheck check =
        check_gauge(read(bent(really_mm), 0.01), {{}, bend_of_logs(0.4)}, GaugeScales{0.01, -0.1, span_mm});
    EXPECT_EQ(check.outcome, GaugeOutcome::unexplained) << really_mm;
    EXPECT_FALSE(of(check, "straight").ruled_out);
    EXPECT_FALSE(of(check, "sensor_nonlinearity").ruled_out);
    EXPECT_TRUE(check.departure().clear);
    EXPECT_NEAR(check.free_bend.shape.blocks[0].values[0], really_mm, 0.03);
  }
}

TEST(GaugeCheck, NonlinearityFarFromBothHypothesesIsUnexplained) {
  const auto check_of = [](double share) {
    return check_gauge(read(bent(0.4 * share), 0.002), {{}, bend_of_logs(0.4)},
                       GaugeScales{0.002, -0.1, span_mm});
  };
  for (const double share : {-0.2, 0.0, 0.1, 0.2})
    EXPECT_TRUE(of(check_of(share), "sensor_nonlinearity").ruled_out) << share;
  for (const double share : {0.8, 0.9, 1.0, 1.1, 1.2})
    EXPECT_TRUE(of(check_of(share), "straight").ruled_out) << share;
  for (const double share : {-0.4, 0.35, 0.5, 0.65, 1.4})
    EXPECT_EQ(check_of(share).outcome, GaugeOutcome::unexplained) << share;
}

TEST(GaugeCheck, SeparatesSaturationFromNonlinearity) {
  const std::vector<SensorShape> hypotheses{{}, bend_of_logs(0.4), end_of_logs(22)};
  const GaugeScales until_end{noise_mm, 0, 22.1};
  const GaugeCheck check = check_gauge(read(ending(22), noise_mm), hypotheses, until_end);
  EXPECT_EQ(check.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(check, "straight").ruled_out);
  EXPECT_TRUE(of(check, "sensor_nonlinearity").ruled_out);
  EXPECT_FALSE(of(check, "sensor_saturation").ruled_out);
}

/// The check gets three hypotheses. One of them is implausible and must be ruled out. The decision between
/// the other two hypotheses must be the same as without the implausible one.
TEST(GaugeCheck, ImplausibleHypothesisDoesNotChangeTheDecision) {
  const std::vector<SensorShape> hypotheses{{}, bend_of_logs(0.4), end_of_logs(15)};
  const GaugeScales fine{0.01, -0.1, span_mm};
  const GaugeCheck half = check_gauge(read(bent(0.2), 0.01), hypotheses, fine);
  EXPECT_EQ(half.outcome, GaugeOutcome::unexplained);
  EXPECT_TRUE(of(half, "sensor_saturation").ruled_out);
  EXPECT_FALSE(of(half, "straight").ruled_out);
  EXPECT_FALSE(of(half, "sensor_nonlinearity").ruled_out);
  const GaugeCheck whole = check_gauge(read(bent(0.4), 0.01), hypotheses, fine);
  EXPECT_EQ(whole.outcome, GaugeOutcome::decided);
  EXPECT_TRUE(of(whole, "straight").ruled_out);
  EXPECT_TRUE(of(whole, "sensor_saturation").ruled_out);
}

/// The only hypothesis is a linear sensor. The check must not reject this hypothesis because of a
/// nonlinearity that is too small to be visible in the logs.
TEST(GaugeCheck, NonlinearityBelowLogResolutionCountsAsLinear) {
  for (const double bow_mm : {0.02, 0.3}) {
    std::vector<GaugeReading> readings = read(bent(bow_mm), 0.001);
    for (GaugeReading& r : readings) r.samples = 200;
    const GaugeCheck check = check_gauge(readings, {SensorShape{}}, GaugeScales{0.04, 0, span_mm});
    EXPECT_EQ(check.outcome, bow_mm < 0.1 ? GaugeOutcome::decided : GaugeOutcome::unexplained) << bow_mm;
  }
}

TEST(GaugeCheck, ResultIsIndependentOfGaugeDirectionAndUnit) {
  for (const double scale : {-1.0, 1 / 25.4}) {
    const auto readings = read(bent(0.4), 0.01, planned_positions(span_mm), 7 * scale, scale);
    const GaugeCheck check = check_gauge(readings, {{}, bend_of_logs(0.4)}, scales);
    EXPECT_TRUE(of(check, "straight").ruled_out) << scale;
    EXPECT_NEAR(of(check, "sensor_nonlinearity").scale, 1 / scale, 0.02 / std::abs(scale));
  }
}

/// In readings with random noise, the check must rule out the true hypothesis in at most 1 of 300 cases.
TEST(GaugeCheck, TrueHypothesisIsRuledOutInAtMost1Of300) {
  int wrong = 0, decided = 0;
  for (int draw = 0; draw < 300; ++draw) {
    std::mt19937_64 random(static_cast<std::uint64_t>(draw) + 1000);
    std::normal_distribution<double> normal(0, 0.05);
    const bool is_bent = draw % 2 == 0;
    std::vector<GaugeReading> readings = read(is_bent ? bent(0.12) : Sensor(straight), 0);
    for (GaugeReading& r : readings) r.reading_mm += normal(random);
    const GaugeCheck check = check_gauge(readings, {{}, bend_of_logs(0.12)}, scales);
    wrong += of(check, is_bent ? "sensor_nonlinearity" : "straight").ruled_out ? 1 : 0;
    decided += check.outcome == GaugeOutcome::decided ? 1 : 0;
  }
  EXPECT_LE(wrong, 1);
  EXPECT_GT(decided, 200);
}

}  // namespace
}  // namespace softgrip::sysid::gauge_check_test
