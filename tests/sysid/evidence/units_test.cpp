#include "sysid/evidence/units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sysid/limits/limits.h"
#include "sysid/logs/division.h"

namespace softgrip::sysid::units_test {
namespace {

Record record_of(std::size_t samples, double first_s = 0) {
  Record record;
  for (std::size_t i = 0; i < samples; ++i) {
    record.time_s.push_back(first_s + static_cast<double>(i));
    record.duration_s.push_back(i > 0 ? 1 : 0);
    record.drive_kpa.push_back(0);
    record.reading_mm.push_back(1);
  }
  record.readings = samples;
  return record;
}

TEST(Units, EachOfSeveralRunsIsOneUnit) {
  const std::vector<Record> records{record_of(10), record_of(20), record_of(30)};
  const Units units(records);
  EXPECT_TRUE(units.are_runs());
  ASSERT_EQ(units.count(), 3U);
  for (std::size_t unit = 0; unit < 3; ++unit) {
    std::vector<std::size_t> kept;
    const std::vector<Record> rest = units.without(records, unit, &kept);
    ASSERT_EQ(rest.size(), 2U);
    ASSERT_EQ(kept.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NE(kept[k], unit);
      EXPECT_EQ(rest[k].size(), records[kept[k]].size());
      EXPECT_EQ(rest[k].readings, records[kept[k]].readings);
    }
  }
}

TEST(Units, OneRunIsDividedIntoTwoHalves) {
  const std::vector<Record> records{record_of(11, 5)};
  const Units units(records);
  EXPECT_FALSE(units.are_runs());
  ASSERT_EQ(units.count(), 2U);
  EXPECT_EQ(units.unit_of(0, 4.9), 0U);
  EXPECT_EQ(units.unit_of(0, 5), 1U);
  std::size_t readings = 0;
  for (std::size_t unit = 0; unit < 2; ++unit) {
    const Record rest = units.without(records, unit).at(0);
    EXPECT_EQ(rest.size(), 11U);
    std::size_t finite = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const bool left_out = units.unit_of(0, rest.time_s[i] - 5) == unit;
      EXPECT_EQ(std::isfinite(rest.reading_mm[i]), !left_out) << i;
      if (std::isfinite(rest.reading_mm[i])) ++finite;
    }
    EXPECT_EQ(finite, rest.readings);
    readings += finite;
  }
  EXPECT_EQ(readings, 11U);
}

TEST(Units, LeavingOutNoUnitKeepsAllRecords) {
  const std::vector<Record> one{record_of(11)}, two{record_of(4), record_of(4)};
  EXPECT_EQ(Units(one).without(one, Units(one).count()).at(0).readings, 11U);
  EXPECT_EQ(Units(two).without(two, Units(two).count()).size(), 2U);
}

TEST(Units, ManyRunsAreGroupedAndEachIsLeftOutOnce) {
  const std::vector<Record> records(14, record_of(3));
  const Units units(records);
  EXPECT_EQ(units.count(), limits::most_units);
  std::size_t left_out = 0;
  for (std::size_t unit = 0; unit < units.count(); ++unit)
    left_out += records.size() - units.without(records, unit).size();
  EXPECT_EQ(left_out, records.size());
}

TEST(Units, EachFoldHoldsOutOneWholeUnit) {
  for (const std::size_t runs : {1U, 3U, 8U}) {
    std::vector<Record> records;
    for (std::size_t r = 0; r < runs; ++r) records.push_back(record_of(41 + r, 100));
    const Units units(records);
    const Division division = divide_by_unit(records);
    EXPECT_EQ(division.folds, units.count());
    for (std::size_t unit = 0; unit < units.count(); ++unit) {
      const std::vector<Record> rest = without_fold(records, division, unit);
      std::size_t left_out = 0;
      for (std::size_t r = 0; r < runs; ++r) {
        left_out += records[r].readings - rest[r].readings;
        const std::size_t own = r % units.count() == unit ? 0 : records[r].readings;
        if (units.are_runs()) {
          EXPECT_EQ(rest[r].readings, own);
        }
      }
      EXPECT_GT(left_out, 0U) << "unit " << unit << ", " << runs << " runs";
    }
  }
}

Record sampled_every(double interval_s) {
  Record record = record_of(1000);
  for (double& t : record.time_s) t *= interval_s;
  for (double& t : record.duration_s) t *= interval_s;
  record.finest_interval_s = interval_s;
  return record;
}

TEST(Units, ABlockLastsLongerInASlowLog) {
  EXPECT_EQ(Units({sampled_every(0.01)}).block_s(), 5);
  const double slow_s = Units({sampled_every(10)}).block_s();
  EXPECT_GT(slow_s, 100 * 10) << "at least 100 samples";
  EXPECT_NEAR(Units({sampled_every(1000)}).block_s(), 100 * slow_s, 1e-6 * slow_s);
  EXPECT_EQ(divide_by_unit({sampled_every(10)}).blocks.size(),
            divide_by_unit({sampled_every(1000)}).blocks.size());
}

}  // namespace
}  // namespace softgrip::sysid::units_test
