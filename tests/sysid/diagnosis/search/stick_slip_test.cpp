#include "sysid/diagnosis/search/stick_slip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/diagnosis/search/jump_tracking.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/limits/limits.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::stick_slip_test {
namespace {

constexpr double noise_mm = 0.03;
constexpr int substeps = 50;

// Returns a model with a gain and one Kelvin-Voigt branch. It describes the finger behind the valve exactly.
model::Model plain_model() {
  model::Model model;
  model.name = "plain";
  model.source = "test";
  model::BlockSpec branch = model::default_block(*model::find_block("kelvin_voigt"));
  branch.values = {2.5, 8.0, 6.4};
  return model::with_block(model, branch);
}

// Computes the readings of this finger behind a valve. Uses Euler's method with 50 steps per sample. The
// computation shares no code with the function under test.
template <class Valve>
std::vector<Record> answered(std::vector<Record> records, Valve&& valve, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, noise_mm);
  for (Record& r : records) {
    double pressure = 0, creep = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
      const double before = i == 0 ? 0 : r.drive_kpa[i - 1];
      for (int part = 1; part <= substeps && i > 0; ++part) {
        const double command = before + (r.drive_kpa[i] - before) * part / substeps;
        pressure = valve(pressure, command, r.duration_s[i] / substeps);
        creep += r.duration_s[i] / substeps * (pressure - 8.0 * creep) / 6.4;
      }
      r.reading_mm[i] = pressure / 2.5 + creep + noise(random);
    }
  }
  return records;
}

StructureFit behind(const std::vector<Record>& records) {
  const model::Model model = plain_model();
  return evaluate_structure(records, {}, {model, rest_starts(model, records)});
}

double sticking(double band_kpa, double pressure, double command) {
  return std::abs(command - pressure) > band_kpa ? command : pressure;
}

TEST(StickSlip, FindsTheBandOfAStickSlipValve) {
  for (const double band_kpa : {1.3, 3.1}) {
    SCOPED_TRACE(band_kpa);
    const auto records = answered(
        known_campaign(2), [&](double p, double u, double) { return sticking(band_kpa, p, u); }, 11);
    const auto found = find_stick_slip(records, behind(records), noise_mm, 2);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->band_kpa, band_kpa, 0.02 * band_kpa);
    EXPECT_LT(found->band_ci95.lower, found->band_kpa);
    EXPECT_LT(found->band_ci95.upper - found->band_ci95.lower, 0.05 * band_kpa);
    EXPECT_GE(found->jumps, limits::fewest_events);
    // The input of the fit is the valve position that the search has found. The residual must then contain
    // almost only the noise of the readings.
    EXPECT_LT(std::sqrt(found->fit.mean_square_mm2), 1.2 * noise_mm);
  }
}

// Of more than 10,000 samples, only the first part is searched at the beginning.
TEST(StickSlip, FindsTheBandInAllSamplesOfLongRecords) {
  constexpr double band_kpa = 3.1;
  const auto valve = [&](double p, double u, double) { return sticking(band_kpa, p, u); };
  std::vector<Record> quiet_at_first = known_campaign(5);
  for (Record& r : quiet_at_first) std::fill_n(r.drive_kpa.begin(), 2000, 0.0);
  for (const auto& commands : {known_campaign(5), quiet_at_first}) {
    const auto records = answered(commands, valve, 17);
    const auto found = find_stick_slip(records, behind(records), noise_mm, 2);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->band_kpa, band_kpa, 0.02 * band_kpa);
    EXPECT_LT(std::sqrt(found->fit.mean_square_mm2), 1.2 * noise_mm);
    ASSERT_EQ(found->records.size(), 5U);
    for (const Record& r : found->records) EXPECT_EQ(r.size(), 3000U);
  }
}

// The delay is 17.5 samples long, so a jump of the valve is visible in the readings only after 17 or 18
// samples.
TEST(StickSlip, StickBandIsFoundDespiteALongDelay) {
  constexpr double band_kpa = 3.1, delay_s = 0.35;
  std::vector<Record> early = known_campaign(2);
  for (Record& r : early) {  // delays the command by `delay_s`; the valve in the simulation follows the
                             // delayed command
    const std::vector<double> sent = r.drive_kpa;
    const auto samples = static_cast<std::size_t>(std::floor(delay_s / r.sample_time_s));
    const double rest = delay_s / r.sample_time_s - static_cast<double>(samples);
    for (std::size_t i = 0; i < r.size(); ++i) {
      const double after = i < samples ? sent.front() : sent[i - samples];
      const double before = i < samples + 1 ? sent.front() : sent[i - samples - 1];
      r.drive_kpa[i] = after + rest * (before - after);
    }
  }
  const auto answers = answered(
      early, [&](double p, double u, double) { return sticking(band_kpa, p, u); }, 16);
  std::vector<Record> records = known_campaign(2);
  for (std::size_t k = 0; k < records.size(); ++k) records[k].reading_mm = answers[k].reading_mm;

  const model::Model model =
      model::with_block(plain_model(), model::block_of<model::TransportDelay>({{"delay_s", delay_s}}));
  const auto found = find_stick_slip(
      records, evaluate_structure(records, {}, {model, rest_starts(model, records)}), noise_mm, 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->band_kpa, band_kpa, 0.02 * band_kpa);
  EXPECT_LT(std::sqrt(found->fit.mean_square_mm2), 1.5 * noise_mm);
}

TEST(StickSlip, PathSearchStopsAboveTheErrorLimit) {
  const auto records = answered(
      known_campaign(2), [](double p, double u, double) { return sticking(3.1, p, u); }, 11);
  const StructureFit model = behind(records);
  const auto followed = [&](double band_kpa, double worth_mm2) {
    return track_jumps(records[0], 0, model.point, band_kpa, 0.05, worth_mm2);
  };
  const ValvePath right = track_jumps(records[0], 0, model.point, 3.1, 0.05);
  EXPECT_EQ(followed(3.1, right.sum_of_squares_mm2).held_kpa, right.held_kpa);
  const ValvePath wrong = track_jumps(records[0], 0, model.point, 8.0, 0.05);
  ASSERT_GT(wrong.sum_of_squares_mm2, 2 * right.sum_of_squares_mm2);
  const ValvePath given_up = followed(8.0, right.sum_of_squares_mm2);
  EXPECT_EQ(given_up.sum_of_squares_mm2, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(given_up.held_kpa.empty());
}

TEST(StickSlip, RandomJumpDistancesAreNoStickSlip) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(0.5, 4.0);
  double band_kpa = any(random);
  const auto records = answered(
      known_campaign(2),
      [&](double p, double u, double) {
        const double next = sticking(band_kpa, p, u);
        if (next != p) band_kpa = any(random);
        return next;
      },
      12);
  EXPECT_FALSE(find_stick_slip(records, behind(records), noise_mm, 2));
}

// Returns 80 jump distances of a valve with a stick band of 1 kPa. Four of five distances have a random error
// of 1 %. Every fifth distance is 3 % to 30 % too short.
std::vector<double> partly_short(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> read(1.0, 0.01);
  std::uniform_real_distribution<double> too_short(0.7, 0.97);
  std::vector<double> distances_kpa;
  for (int i = 0; i < 80; ++i) distances_kpa.push_back(i % 5 == 0 ? too_short(random) : read(random));
  std::ranges::sort(distances_kpa);
  return distances_kpa;
}

TEST(StickSlip, ShortJumpsDoNotBiasTheStickBand) {
  double sum_kpa = 0;
  constexpr int seeds = 200;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) sum_kpa += band_of_jumps(partly_short(seed)).band_kpa;
  // 20 % of the distances are too short, but they must not change the estimate of the band. The mean of the
  // central 90 % of the distances would be too small by 2.3 %.
  EXPECT_NEAR(sum_kpa / seeds, 1.0, 0.006);
}

TEST(StickSlip, BandIntervalCoversTheTrueBandIn95Percent) {
  int held = 0;
  constexpr int seeds = 1000;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> read(1.0, 0.01);
    std::vector<double> distances_kpa(60);
    for (double& d : distances_kpa) d = read(random);
    std::ranges::sort(distances_kpa);
    const Interval interval = band_of_jumps(distances_kpa).band_ci95;
    held += interval.lower < 1.0 && 1.0 < interval.upper ? 1 : 0;
  }
  EXPECT_NEAR(held, 0.95 * seeds, 0.02 * seeds);
}

TEST(StickSlip, PlayLagAndIdealValveAreNoStickSlip) {
  const auto play = [](double p, double u, double) { return std::clamp(p, u - 1.0, u + 1.0); };
  const auto lag = [](double p, double u, double dt) { return p + (u - p) * dt / 0.15; };
  const auto faithful = [](double, double u, double) { return u; };
  for (const auto& records : {answered(known_campaign(2), play, 13), answered(known_campaign(2), lag, 14),
                              answered(known_campaign(2), faithful, 15)}) {
    const auto found = find_stick_slip(records, behind(records), noise_mm, 2);
    if (found) ADD_FAILURE() << "band " << found->band_kpa << " scatter " << found->scatter;
  }
}

}  // namespace
}  // namespace softgrip::sysid::stick_slip_test
