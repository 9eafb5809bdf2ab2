#include "sysid/fitting/start_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/statistics.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/sensor_drift.h"
#include "model/blocks/transport_delay.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/root_mean_square.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::start_estimate_test {
namespace {

using test::rms;

using model::SignalName;

constexpr double noise_mm = 0.05, rate_hz = 50;

/// Returns a finger with play operators and a dead time. Its creep has time constants of 0.3 s and 10 s.
model::Model play_finger() {
  model::Model m;
  m.name = "play_finger";
  m.source = "model made for this test";
  m = model::with_block(std::move(m), {model::block_type<model::TransportDelay>(), {0.06}});
  m = model::with_block(std::move(m), {model::block_type<model::PrandtlIshlinskii>(),
                                       {0, 0, 0, 0, 0, 0.2, 1.3, 0.06, 4.1, 0.05, 9.7, 0.04, 17, 0.03}});
  m = model::with_block(std::move(m), {model::block_type<model::KelvinVoigt>(), {1e9, 25, 7.5, 30, 300}});
  return model::with_block(std::move(m), {model::block_type<model::Characteristic>(), {0.3, 25}});
}

std::vector<model::Model> fingers() {
  return {loaded("bench_twin"), loaded("zhang2025"), play_finger()};
}

Record whole(const model::Model& finger, SignalName signal, RecordOptions options = {}) {
  return make_records({simulated(finger, signal, rate_hz, noise_mm, 11)}, options).front();
}

/// Returns a separate log with the samples of a run from sample `first` on.
Record cut(const model::Model& finger, SignalName signal, std::size_t first, RecordOptions options = {}) {
  const Log log = simulated(finger, signal, rate_hz, noise_mm, 11);
  return make_records({slice(log, first, log.size())}, options).front();
}

double error_mm(const model::Model& finger, const Record& record, const StartState& start) {
  return rms(residual(record, predict(finger, record, start)));
}

/// Returns the indices of the samples at which a record can be cut. Ten of these samples are at equal
/// distances. At each of the other samples, the pressure returns to 0, and at least 3 s of the record follow.
std::vector<std::size_t> moments_to_cut(const Record& record) {
  constexpr std::size_t cuts = 10;
  std::vector<std::size_t> moments;
  for (std::size_t k = 1; k <= cuts; ++k) moments.push_back(record.size() * k / (cuts + 3));
  for (std::size_t i = 1; record.time_s[i] + 3 < record.time_s.back(); ++i) {
    if (record.drive_kpa[i] <= 0 && record.drive_kpa[i - 1] > 0) moments.push_back(i);
  }
  EXPECT_GT(moments.size(), cuts) << "the pressure must return to 0 at least once";
  return moments;
}

TEST(SamplesForStart, CoverFivePercentTwoSecondsOrHalfTheRecord) {
  Record record = whole(loaded("bench_twin"), SignalName::tp1);
  const auto used_s = [&](double length_s) {
    for (std::size_t i = 0; i < record.size(); ++i)
      record.time_s[i] = length_s * static_cast<double>(i) / static_cast<double>(record.size() - 1);
    return record.time_s[samples_for_start(record) - 1];
  };
  EXPECT_NEAR(used_s(100), 5, 0.05);
  EXPECT_NEAR(used_s(20), 2, 0.01);
  EXPECT_NEAR(used_s(3), 1.5, 0.01);
}

TEST(EstimatedStart, IgnoresReadingsAfterTheInitialInterval) {
  for (const model::Model& finger : fingers()) {
    for (const Start known : {Start::automatic, Start::rest, Start::unknown}) {
      for (const std::size_t first : {0U, 700U}) {
        const Record record = cut(finger, SignalName::tp1, first, {.start = known});
        const StartState start = estimated_start(finger, record);
        Record other = record;
        for (std::size_t i = samples_for_start(record); i < record.size(); ++i)
          other.reading_mm[i] = i % 3 == 0 ? std::nan("") : 100 - 3 * record.reading_mm[i];
        EXPECT_EQ(estimated_start(finger, other), start) << finger.name << ' ' << first;
        other.reading_mm[samples_for_start(record) - 1] += 1;
        EXPECT_NE(estimated_start(finger, other), start)
            << "the estimate must use the last reading of the initial interval";
      }
    }
  }
}

/// No start state then has a finite prediction.
TEST(EstimatedStart, AnUnknownDriveHasAStartState) {
  const model::Model finger = play_finger();
  Record record = cut(finger, SignalName::tp1, 300);
  record.start_unknown = true;
  std::fill(record.drive_kpa.begin(), record.drive_kpa.end(), std::nan(""));
  EXPECT_EQ(estimated_start(finger, record).unsettled_mm.size(), 2U);
}

TEST(EstimatedStart, ShiftOfAllReadingsChangesOnlyTheOffset) {
  for (const model::Model& finger : fingers()) {
    for (const std::size_t first : {0U, 700U, 1100U}) {
      const Record record = cut(finger, SignalName::tp1, first);
      Record shifted = record;
      for (double& y : shifted.reading_mm) y += 5;
      const StartState before = estimated_start(finger, record), after = estimated_start(finger, shifted);
      EXPECT_NEAR(after.offset_mm, before.offset_mm + 5, 1e-6) << finger.name << ' ' << first;
      EXPECT_NEAR(error_mm(finger, shifted, after), error_mm(finger, record, before), 1e-6);
    }
  }
}

TEST(EstimatedStart, RunFromRestIsEstimatedAtRest) {
  for (const model::Model& finger : fingers()) {
    for (const SignalName signal : {SignalName::tp1, SignalName::steps, SignalName::sp2}) {
      const Record record = whole(finger, signal);
      const StartState start = estimated_start(finger, record);
      EXPECT_TRUE(is_at_rest(start, record)) << finger.name << ' ' << record.name;
      EXPECT_LT(error_mm(finger, record, start), 1.05 * noise_mm) << finger.name << ' ' << record.name;
    }
  }
}

/// An unknown start has ten fitted numbers for this finger. They follow the noise of the first readings.
TEST(EstimatedStart, NoiseOfTheFirstReadingsIsNotAttributedToTheStart) {
  model::Model finger = play_finger();
  finger.blocks[*model::position_of<model::KelvinVoigt>(finger)].values = {
      1e9, 25, 2, 30, 5, 30, 12, 30, 30, 30, 80, 30, 200, 30, 500, 30, 1200};
  constexpr int logs = 200;
  int moving = 0;
  for (int seed = 1; seed <= logs; ++seed) {
    Log log;
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0, 1);
    for (int i = 0; i < 1000; ++i) {
      log.time_s.push_back(i / rate_hz);
      log.pressure_command_kpa.push_back(i < 200 ? 0.2 * std::exp(-0.1 * i) : 60);
      log.displacement_mm.push_back(noise_mm * noise(random));
    }
    const Record record = make_records({log}, {}).front();
    moving += is_at_rest(estimated_start(finger, record), record) ? 0 : 1;
  }
  EXPECT_LE(moving, 2) << "of " << logs << " logs, seeds 1 .. " << logs;
}

/// The pressure cycles between two values, and the hysteresis of this finger needs many cycles to settle. The
/// model has an error that a wrong initial state could explain. Therefore the first half cycle of the log
/// does not suffice to estimate the initial state.
TEST(EstimatedStart, CyclicHysteresisIsPredictedFromAMidCycleStart) {
  model::Model finger;
  finger.name = "slow_to_cycle";
  finger.source = "model made for this test";
  finger = model::with_block(std::move(finger),
                             {model::block_type<model::BoucWen>(), {5.57, 7.83, 0.0135, 0.00195, 1}});
  Log log;
  log.name = "strokes";
  for (int i = 0; i < 12000; ++i) {
    const double phase_s = std::fmod(0.05 * i, 20);
    log.time_s.push_back(0.05 * i);
    log.pressure_command_kpa.push_back(100 * std::clamp(phase_s, 0.0, 1.0) -
                                       100 * std::clamp(phase_s - 10, 0.0, 1.0));
    log.displacement_mm.push_back(0);
  }
  Record record = make_records({log}, {}).front();
  log.displacement_mm = predict(finger, record, StartState{});
  // The log starts at 35 kPa in the thirteenth cycle. The readings have a lag, but the model has none.
  Log late = slice(log, 4807, log.size());
  double lagging = late.displacement_mm.front();
  for (double& y : late.displacement_mm) y = lagging += 0.2 * (y - lagging);
  record = make_records({late}, {}).front();
  const StartState start = estimated_start(finger, record);
  EXPECT_FALSE(is_at_rest(start, record));
  const double span_mm = *std::max_element(late.displacement_mm.begin() + 400, late.displacement_mm.end()) -
                         *std::min_element(late.displacement_mm.begin() + 400, late.displacement_mm.end());
  EXPECT_LT(error_mm(finger, record, start), 0.15 * span_mm);
}

/// A model without the delay has an error on a ramp. The estimate must not explain this error by another
/// start state.
TEST(EstimatedStart, ModelErrorIsNotAttributedToTheStart) {
  const model::Model finger = loaded("bench_twin");
  model::Model without_delay = finger;
  std::erase_if(without_delay.blocks,
                [](const model::BlockSpec& block) { return model::is<model::TransportDelay>(block); });
  const Record record = whole(finger, SignalName::tp1);
  EXPECT_TRUE(is_at_rest(estimated_start(without_delay, record), record));
}

TEST(EstimatedStart, KnownRestHasNoHysteresisOrCreep) {
  const model::Model finger = loaded("bench_twin");
  const Record record = cut(finger, SignalName::tp1, 700, {.start = Start::rest});
  EXPECT_TRUE(is_at_rest(estimated_start(finger, record), record));
  const Record unknown = cut(finger, SignalName::tp1, 700, {.start = Start::unknown});
  EXPECT_FALSE(is_at_rest(estimated_start(finger, unknown), unknown));
}

/// A log may be cut at any time, even during a motion or between two cycles. After a cut, the error of the
/// prediction may be larger than for the same readings in the complete log. The increase may be at most 3 %
/// of the span as RMS over all cuts, and at most 8 % for a single cut. The model is exact, so the estimated
/// start state is the only cause of the increase.
TEST(EstimatedStart, CutLogIsPredictedNearlyAsWellAsAWholeLog) {
  for (const model::Model& finger : fingers()) {
    for (const SignalName signal : {SignalName::tp1, SignalName::sp2}) {
      const Record record = whole(finger, signal);
      const std::vector<double> complete =
          residual(record, predict(finger, record, estimated_start(finger, record)));
      double more = 0, most = 0;
      const std::vector<std::size_t> moments = moments_to_cut(record);
      for (const std::size_t first : moments) {
        const Record part = cut(finger, signal, first);
        const double of_complete = rms(std::span(complete).subspan(first));
        const double of_part = error_mm(finger, part, estimated_start(finger, part));
        const double percent =
            100 * std::sqrt(std::max(0.0, square(of_part) - square(of_complete))) / record.span_mm;
        more += square(percent) / static_cast<double>(moments.size());
        most = std::max(most, percent);
      }
      EXPECT_LT(std::sqrt(more), 3) << finger.name << ' ' << record.name;
      EXPECT_LT(most, 8) << finger.name << ' ' << record.name;
    }
  }
}

TEST(EstimatedStart, RecordWithoutReadingsStartsAtRest) {
  const model::Model finger = loaded("bench_twin");
  Record record = cut(finger, SignalName::tp1, 700);
  for (double& y : record.reading_mm) y = std::nan("");
  const StartState start = estimated_start(finger, record);
  EXPECT_TRUE(is_at_rest(start, record));
  EXPECT_EQ(start.offset_mm, 0);
}

/// A log that begins under pressure is simulated from an earlier time. The drift of the sensor must not be
/// simulated for this time.
TEST(StartEstimate, ADriftHasItsValueAtTheFirstSample) {
  const model::Model finger = loaded("bench_twin");
  const model::Model drifting =
      model::with_block(finger, model::block_of<model::SensorDrift>({{"rate_mm_per_h", 60}}));
  const Record record = cut(finger, SignalName::tp1, 900, {.start = Start::unknown});
  const StartState start = estimated_start(finger, record);
  const std::vector<double> still = predict(finger, record, start), moving = predict(drifting, record, start);
  for (std::size_t i = 0; i < record.size(); i += 100)
    EXPECT_NEAR(moving[i] - still[i], record.time_s[i] / 60, 1e-3) << i;
}

/// Returns a log of the finger with an oscillation of 0.3 mm and 1.7 Hz, and with the harmonic of 3.4 Hz.
Record oscillating(const model::Model& finger, double phase_s) {
  Log log = simulated(finger, SignalName::tp1, rate_hz, noise_mm, 11);
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double angle = 2 * std::numbers::pi * 1.7 * (log.time_s[i] + phase_s);
    log.displacement_mm[i] += 0.3 * std::sin(angle) + 0.1 * std::cos(2 * angle);
  }
  return make_records({log}, {}).front();
}

model::Model with_oscillation(model::Model finger) {
  const auto line = [](double sine_mm, double cosine_mm, double frequency_hz) {
    return model::block_of<model::PeriodicDisturbance>(
        {{"sine_mm", sine_mm}, {"cosine_mm", cosine_mm}, {"frequency_hz", frequency_hz}});
  };
  finger = model::with_block(std::move(finger), line(0.3, 0, 1.7));
  return model::with_block(std::move(finger), line(0, 0.1, 3.4));
}

TEST(StartEstimate, ThePhaseOfAnOscillationIsEstimatedForEachLog) {
  const model::Model finger = loaded("bench_twin"), model = with_oscillation(finger);
  for (const double phase_s : {0.0, 0.11, 0.29, 0.45}) {
    SCOPED_TRACE(phase_s);
    const Record record = oscillating(finger, phase_s);
    EXPECT_LT(error_mm(model, record, estimated_start(model, record)), 1.1 * noise_mm);
  }
}

TEST(StartEstimate, APhaseThatNoReadingShowsIsNotShifted) {
  const model::Model finger = loaded("bench_twin");
  const Record still = whole(finger, SignalName::tp1);
  EXPECT_EQ(estimated_start(finger, still).oscillation_shift_s, 0);
  const model::Model tiny =
      model::with_block(finger, model::block_of<model::PeriodicDisturbance>(
                                    {{"sine_mm", 1e-6}, {"cosine_mm", 0}, {"frequency_hz", 1.7}}));
  EXPECT_EQ(estimated_start(tiny, still).oscillation_shift_s, 0);
}

}  // namespace
}  // namespace softgrip::sysid::start_estimate_test
