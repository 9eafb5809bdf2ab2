#include "sysid/fitting/fit_space.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"

namespace softgrip::sysid::fit_space_test {
namespace {

/// When a cause is added, the parameters of a nonlinear envelope are fitted a second time. A linear envelope
/// has no such parameters.
TEST(IsMovable, EnvelopeParametersMoveOnlyIfNonlinear) {
  for (const double end_kpa : {0.0, 50.0}) {
    const model::Model plays = model::with_block(
        {}, {model::block_type<model::PrandtlIshlinskii>(), {10, 0, 0, end_kpa, 0, 0.2, 5, 0.1}});
    const auto moves = [&](const char* name) {
      return is_movable(plays, model::find_path(plays, std::string("prandtl_ishlinskii.") + name).value());
    };
    EXPECT_EQ(moves("envelope_bend"), end_kpa > 0);
    EXPECT_EQ(moves("envelope_skew"), end_kpa > 0);
    EXPECT_TRUE(moves("w2_mm_per_kpa"));
    for (const char* placed : {"trained_kpa", "envelope_kpa", "r2_kpa"})
      EXPECT_FALSE(moves(placed)) << placed;
  }
}

/// Returns a record of 1000 samples.
Record sampled_every(double interval_s) {
  Record record;
  for (int i = 0; i < 1000; ++i) record.time_s.push_back(interval_s * i);
  record.drive_kpa.assign(1000, 1);
  record.reading_mm.assign(1000, 1);
  record.finest_interval_s = interval_s;
  return record;
}

TEST(FitSpace, LimitsALagInUnitsOfTheTimeThatTheRecordsResolve) {
  const model::Model lag = model::with_block({}, {model::block_type<model::ValveLag>(), {0.1}});
  const auto limit_s = [&](double interval_s) {
    return FitSpace(lag, {sampled_every(interval_s)}, {0}).free().front().upper;
  };
  EXPECT_DOUBLE_EQ(limit_s(0.01), 10);
  EXPECT_DOUBLE_EQ(limit_s(0.1), 10);
  EXPECT_NEAR(limit_s(4), 1264, 1);
  EXPECT_NEAR(limit_s(0.0001), 0.0316, 1e-4);
}

/// A log in metres has the limits per span of a log in millimetres. The limits of an ordinary finger are
/// exact.
TEST(FitSpace, LimitsGainsInUnitsOfTheSpanOfTheRecords) {
  const model::Model finger =
      model::with_block({}, {model::block_type<model::BoucWen>(), {0.35, 0.2, 0.03, 0.03, 1}});
  const auto alpha = [&](double span_mm) {
    Record record = sampled_every(0.01);
    record.largest_kpa = 40;
    record.span_mm = span_mm;
    return FitSpace(finger, {record}, {0}).free().front();
  };
  for (const double span_mm : {0.0, 1.0, 20.0, 40.0}) {
    EXPECT_EQ(alpha(span_mm).upper, 10) << span_mm;
    EXPECT_EQ(alpha(span_mm).lower, alpha(1).lower) << span_mm;
    EXPECT_EQ(alpha(span_mm).scale, alpha(1).scale) << span_mm;
  }
  EXPECT_DOUBLE_EQ(alpha(400).upper, 100);
  EXPECT_DOUBLE_EQ(alpha(0.002).upper, 0.02);
  EXPECT_DOUBLE_EQ(alpha(0.002).scale, 0.002 * alpha(1).scale);
  EXPECT_DOUBLE_EQ(alpha(0.002).lower, 0.002 * alpha(1).lower);
}

TEST(FitSpace, LimitsRatesInUnitsOfThePressureOfTheRecords) {
  const model::Model finger =
      model::with_block({}, {model::block_type<model::BoucWen>(), {0.35, 0.2, 0.03, 0.03, 1}});
  const auto limits_of_gamma = [&](double largest_kpa) {
    Record record = sampled_every(0.01);
    record.largest_kpa = largest_kpa;
    const FreeParameter gamma = FitSpace(finger, {record}, {2}).free().front();
    return std::pair(gamma.lower, gamma.upper);
  };
  EXPECT_EQ(limits_of_gamma(100), std::pair(-10.0, 10.0));
  EXPECT_EQ(limits_of_gamma(20), std::pair(-10.0, 10.0));
  EXPECT_NEAR(limits_of_gamma(0.6).second, 333.3, 0.1);
  EXPECT_NEAR(limits_of_gamma(0.6).first, -333.3, 0.1);
  EXPECT_EQ(limits_of_gamma(1e-9).second, 1e4);
}

}  // namespace
}  // namespace softgrip::sysid::fit_space_test
