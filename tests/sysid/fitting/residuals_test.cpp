#include "sysid/fitting/residuals.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/thread_budget.h"
#include "model/blocks/slow_creep.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/each_record.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::residuals_test {
namespace {

using model::Model;

struct World {
  std::string name;
  Model model;
  bool irregular = false;
  bool held = false;
  bool unknown_start = false;
};
std::ostream& operator<<(std::ostream& out, const World& world) {
  return out << world.name;
}

Model bench_twin() {
  return loaded("bench_twin");
}
Model with_delay_only() {
  return model::without_block(bench_twin(), *model::find_block("valve_lag"));
}
Model with_lag_only() {
  return model::without_block(bench_twin(), *model::find_block("transport_delay"));
}
Model three_branches() {
  Model model = loaded("zhang2025");
  auto& kv = model.blocks.back().values;
  kv.insert(kv.end(), {5.0, 0.5});
  return model;
}
/// Returns a model with a negative gamma. While the hysteretic state decreases, the slope of the hysteresis
/// exceeds beta.
Model odd_hysteresis() {
  Model model = loaded("zhang2025");
  model.blocks[0].values[2] = -0.01;
  model.blocks[0].values[3] = 0.06;
  return model;
}

std::vector<World> worlds() {
  return {{"Base", loaded("zhang2025")},
          {"BaseIrregular", loaded("zhang2025"), true},
          {"BaseHeld", loaded("zhang2025"), false, true},
          {"BaseUnknownStart", loaded("zhang2025"), false, false, true},
          {"ThreeBranches", three_branches()},
          {"OddHysteresis", odd_hysteresis()},
          {"Delay", with_delay_only()},
          {"DelayIrregular", with_delay_only(), true},
          {"DelayHeld", with_delay_only(), false, true},
          {"Lag", with_lag_only()},
          {"LagUnknownStart", with_lag_only(), false, false, true},
          {"Twin", bench_twin()},
          {"TwinIrregularUnknownStart", bench_twin(), true, false, true},
          {"TwinHeld", bench_twin(), false, true}};
}

std::vector<Record> records_of(const World& world) {
  std::vector<Log> logs{simulated(world.model, model::SignalName::tp1, 40, 0.05, 1),
                        simulated(world.model, model::SignalName::sp2, 35, 0.05, 2)};
  std::mt19937_64 random(3);
  if (world.irregular) {
    for (Log& log : logs) {
      for (std::size_t i = 1; i + 1 < log.size(); ++i) {
        log.time_s[i] += std::uniform_real_distribution<double>(-0.01, 0.01)(random);
      }
    }
  }
  if (world.unknown_start) {
    for (Log& log : logs) log = slice(log, 300, log.size());
  }
  logs[0].displacement_mm[17] = std::nan("");
  RecordOptions options;
  options.held = world.held;
  options.start = world.unknown_start ? Start::unknown : Start::rest;
  auto records = make_records(logs, options);
  records[1].offset_free = true;
  return records;
}

std::vector<std::size_t> all_but_the_exponent(const Model& model) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i) {
    if (!model::parameter_spec(model, i).whole) free.push_back(i);
  }
  return free;
}

class BothWays : public ::testing::TestWithParam<World> {};

/// The chain with automatic differentiation and the closed form are two implementations of the same
/// equations. Their results must agree.
TEST_P(BothWays, ValuesAndDerivativesAgree) {
  const World& world = GetParam();
  const std::vector<Record> records = records_of(world);
  const FitSpace space(world.model, records, all_but_the_exponent(world.model));
  const auto chain = chain_residuals(records, space);
  const auto separable = separable_residuals(records, space);
  ASSERT_TRUE(separable);
  FitPoint point{world.model, rest_starts(world.model, records)};
  point.starts[1].offset_mm = 0.3;
  if (world.unknown_start) {
    point.starts[0].peak_before_kpa = 55;
    point.starts[1].peak_before_kpa = 52;
    for (double& u : point.starts[0].unsettled_mm) u = 0.4;
  }
  const std::vector<double> z = space.z(point);
  const std::size_t rows = chain->count();
  ASSERT_EQ(rows, records[0].size() + records[1].size() - 1);
  std::vector<double> r1(rows), r2(rows), j1(rows * z.size()), j2(rows * z.size());
  ASSERT_TRUE(chain->evaluate(z, r1, j1));
  ASSERT_TRUE(separable->evaluate(z, r2, j2));
  double worst = 0;
  for (std::size_t i = 0; i < rows; ++i) worst = std::max(worst, std::abs(r1[i] - r2[i]));
  // If the output of a lag reverses within a sample, the chain computes the creep with two parabolas. The
  // closed form uses one parabola, so the results differ slightly.
  const bool lagged = model::position_of(world.model, "valve_lag").has_value();
  EXPECT_LT(worst, lagged ? 1e-6 : 1e-9) << "largest difference [mm]";
  for (std::size_t c = 0; c < z.size(); ++c) {
    double largest = 0;
    double difference = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      largest += j1[i * z.size() + c] * j1[i * z.size() + c];
      const double d = j1[i * z.size() + c] - j2[i * z.size() + c];
      difference += d * d;
    }
    EXPECT_LT(std::sqrt(difference), 1e-4 * std::sqrt(largest)) << space.free()[c].name;
    EXPECT_GT(largest, 0) << space.free()[c].name;
  }
}

TEST_P(BothWays, ValuesWithoutDerivativesAreTheSame) {
  const World& world = GetParam();
  const std::vector<Record> records = records_of(world);
  const FitSpace space(world.model, records, all_but_the_exponent(world.model));
  for (const auto& residuals : {chain_residuals(records, space), separable_residuals(records, space)}) {
    const std::vector<double> z = space.z({world.model, rest_starts(world.model, records)});
    std::vector<double> r1(residuals->count()), r2(r1.size()), j(r1.size() * z.size());
    ASSERT_TRUE(residuals->evaluate(z, r1, {}));
    ASSERT_TRUE(residuals->evaluate(z, r2, j));
    for (std::size_t i = 0; i < r1.size(); ++i) ASSERT_NEAR(r1[i], r2[i], 1e-9);
  }
}

// The function evaluates records and groups of derivatives in parallel. The number of threads must not change
// the result.
TEST_P(BothWays, AreBitForBitTheSameOnMoreThreads) {
  const World& world = GetParam();
  const std::vector<Record> records = records_of(world);
  ASSERT_TRUE(are_worth_threads(records));
  const FitSpace space(world.model, records, all_but_the_exponent(world.model));
  for (const auto& residuals : {chain_residuals(records, space), separable_residuals(records, space)}) {
    const std::vector<double> z = space.z({world.model, rest_starts(world.model, records)});
    std::vector<double> r1(residuals->count()), r4(r1.size()), r(r1.size());
    std::vector<double> j1(r1.size() * z.size()), j4(j1.size());
    ASSERT_TRUE(residuals->evaluate(z, r1, j1));
    const ThreadBudget budget(4);
    ASSERT_TRUE(residuals->evaluate(z, r4, j4));
    EXPECT_EQ(r1, r4);
    EXPECT_EQ(j1, j4);
    ASSERT_TRUE(residuals->evaluate(z, r, {}));
    for (std::size_t i = 0; i < r.size(); ++i) ASSERT_NEAR(r[i], r1[i], 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, BothWays, testing::ValuesIn(worlds()),
                         [](const auto& world) { return world.param.name; });

/// Compares the derivatives with central differences of the prediction of the model.
void expect_central_differences(const World& world) {
  const std::vector<Record> records = records_of(world);
  const FitSpace space(world.model, records, all_but_the_exponent(world.model));
  const auto residuals = chain_residuals(records, space);
  FitPoint point{world.model, rest_starts(world.model, records)};
  for (auto& start : point.starts) start.peak_before_kpa = 55;
  for (double& u : point.starts[0].unsettled_mm) u = 0.4;
  ASSERT_EQ(point.starts[0].unsettled_mm.size(), creep_branches(world.model).size());
  const std::vector<double> z = space.z(point);
  const std::size_t rows = residuals->count();
  Jacobian jacobian(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(z.size()));
  std::vector<double> up(rows), down(rows);
  ASSERT_TRUE(residuals->evaluate(z, {}, {jacobian.data(), rows * z.size()}));
  for (std::size_t c = 0; c < z.size(); ++c) {
    std::vector<double> moved = z;
    const double step = 1e-6 * std::max(1.0, std::abs(z[c]));
    moved[c] = z[c] + step;
    ASSERT_TRUE(residuals->evaluate(moved, up, {}));
    moved[c] = z[c] - step;
    ASSERT_TRUE(residuals->evaluate(moved, down, {}));
    double difference = 0;
    double largest = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      const double by_difference = (up[i] - down[i]) / (2 * step);
      difference = std::max(difference, std::abs(by_difference - jacobian(static_cast<Eigen::Index>(i),
                                                                          static_cast<Eigen::Index>(c))));
      largest = std::max(largest, std::abs(by_difference));
    }
    EXPECT_LT(difference, 2e-3 * largest) << space.free()[c].name;
    EXPECT_GT(largest, 0) << space.free()[c].name;
  }
}

TEST(ChainResiduals, DerivativesMatchCentralDifferences) {
  expect_central_differences({"TwinUnknownStart", bench_twin(), true, false, true});
}

/// The slow creep is a further branch, whose unsettled creep decays with its own time constant.
TEST(ChainResiduals, DerivativesOfUnsettledSlowCreepMatchCentralDifferences) {
  const Model slow = model::with_block(bench_twin(), {model::block_type<model::SlowCreep>(), {0.1, 40}});
  ASSERT_EQ(creep_branches(slow).size(), creep_branches(bench_twin()).size() + 1);
  EXPECT_EQ(creep_branches(slow).back().time_constant_s, 40);
  EXPECT_EQ(creep_branches(slow).back().gain_mm_per_kpa, 0.1);
  expect_central_differences({"SlowCreepUnknownStart", slow, true, false, true});
}

/// The measured pressure begins slightly below zero. At this pressure, the rest position of a soft spring is
/// far from zero.
TEST(SeparableResiduals, MatchTheModelForABranchWithNearZeroStiffness) {
  for (const double stiffness : {1e-3, 1e-9, 1e-14, 0.0}) {
    Model model = loaded("zhang2025");
    model.blocks.back().values[1] = stiffness;
    model.blocks.back().values[2] = 1e8;
    std::vector<Record> records = records_of({"", loaded("zhang2025")});
    for (Record& record : records) {
      for (double& kpa : record.drive_kpa) kpa -= 0.03;
    }
    const FitSpace space(model, records, all_but_the_exponent(model));
    const FitPoint point{model, rest_starts(model, records)};
    const auto closed = residuals_for(records, space);
    std::vector<double> r(closed->count());
    const std::vector<double> z = space.z(point);
    ASSERT_TRUE(closed->evaluate(z, r, {}));
    std::size_t row = 0;
    for (std::size_t k = 0; k < records.size(); ++k) {
      const FitPoint at = space.point(z);
      for (const double expected : residual(records[k], predict(at.model, records[k], at.starts[k]))) {
        if (std::isnan(expected)) continue;
        EXPECT_NEAR(r[row++], -expected, 1e-6 * (1 + std::abs(expected))) << stiffness;
        if (HasFailure()) return;
      }
    }
    EXPECT_EQ(row, r.size());
  }
}

TEST(SeparableResiduals, AreUnavailableForUnsupportedModels) {
  const World world{"Base", loaded("zhang2025")};
  const std::vector<Record> records = records_of(world);
  Model model = world.model;
  model.blocks[0].values[4] = 2;
  EXPECT_FALSE(separable_residuals(records, FitSpace(model, records, {0})));
  model = model::with_block(world.model, model::default_block(*model::find_block("contact")));
  EXPECT_FALSE(separable_residuals(records, FitSpace(model, records, {0})));
}

}  // namespace
}  // namespace softgrip::sysid::residuals_test
