// Tests the noise model, the quantiles, the bounded least squares and the scores of a model.

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/QR>

#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "sysid/fitting/bounded_solve.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/score.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/identify.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/identification/validate.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::statistics_test {
namespace {

std::vector<double> autoregressive(double correlation, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  double e = normal(random);
  for (std::size_t i = 0; i < count; ++i) {
    e = correlation * e + std::sqrt(1 - correlation * correlation) * normal(random);
    values.push_back(e);
  }
  return values;
}

TEST(NoiseModel, EffectiveSamplesDecreaseWithCorrelation) {
  for (const double correlation : {0.0, 0.5, 0.9, 0.98}) {
    const auto values = autoregressive(correlation, 60'000, 1);
    const NoiseModel noise = fit_noise(autocovariance_of({values}));
    EXPECT_NEAR(noise.lag1_correlation, correlation, 0.02);
    EXPECT_NEAR(noise.deviation_mm, 1, 0.15);
    const double expected = 60'000 * (1 - correlation) / (1 + correlation);
    EXPECT_NEAR(noise.effective_samples / expected, 1, 0.25) << correlation;
  }
}

TEST(NoiseModel, GapsAndSeriesBoundariesDoNotBiasTheCorrelation) {
  auto first = autoregressive(0.8, 20'000, 2);
  first[777] = std::nan("");
  const auto second = autoregressive(0.8, 20'000, 3);
  EXPECT_NEAR(fit_noise(autocovariance_of({first, second})).lag1_correlation, 0.8, 0.02);
}

TEST(Uncertainty, IsEmptyWithoutFreeParameters) {
  const model::Model model = loaded("bench_twin");
  const auto records = make_records({simulated(model, model::SignalName::tp1, 50, 0.05, 1)}, {});
  const auto residuals = residuals_for(records, FitSpace(model, records, {}));
  ASSERT_EQ(residuals->space().size(), 0U);
  const Uncertainty uncertainty = uncertainty_at(*residuals, {}, HUGE_VAL);
  EXPECT_EQ(uncertainty.root.size(), 0);
  EXPECT_NEAR(uncertainty.noise.deviation_mm, 0.05, 0.005);
}

/// Returns the covariance of autoregressive noise in several series: s^2 (A'A)^-1 for the whitening matrix A
/// of each series.
Eigen::MatrixXd covariance_of(const NoiseModel& noise, const std::vector<Record>& records) {
  Eigen::Index rows = 0, first = 0;
  for (const Record& record : records) rows += static_cast<Eigen::Index>(record.readings);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
  for (const Record& record : records) {
    const auto n = static_cast<Eigen::Index>(record.readings);
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Identity(n, n);
    for (std::size_t lag = 1; lag <= noise.coefficients.size(); ++lag)
      whitening.diagonal(-static_cast<Eigen::Index>(lag)).setConstant(-noise.coefficients[lag - 1]);
    const Eigen::MatrixXd inverse =
        whitening.triangularView<Eigen::UnitLower>().solve(Eigen::MatrixXd::Identity(n, n));
    covariance.block(first, first, n, n) =
        noise.innovation_mm * noise.innovation_mm * inverse * inverse.transpose();
    first += n;
  }
  return covariance;
}

/// The reference multiplies complete matrices. One record is longer than the groups of rows that
/// uncertainty_at() processes together, and the other one is shorter.
TEST(Uncertainty, AgreesWithMatrixAlgebraForCorrelatedNoise) {
  const model::Model truth = loaded("bench_twin");
  std::vector<Log> logs{slice(simulated(truth, model::SignalName::tp1, 25, 0.02, 1), 0, 1100),
                        slice(simulated(truth, model::SignalName::sp2, 25, 0.02, 2), 0, 300)};
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const std::vector<double> error = autoregressive(0.9, logs[k].size(), 11 + k);
    for (std::size_t i = 0; i < error.size(); ++i) logs[k].displacement_mm[i] += 0.1 * error[i];
  }
  const std::vector<Record> records = make_records(logs, {});
  ASSERT_EQ(records[0].readings, 1100U);
  const std::vector<std::size_t> free{0, 1, 2, 3, 4, 8, 9, 10, 11};  // more than a group of columns
  const auto residuals = residuals_for(records, FitSpace(truth, records, free));
  const std::vector<double> z = residuals->space().z({truth, rest_starts(truth, records)});
  const Uncertainty found = uncertainty_at(*residuals, z, HUGE_VAL);

  const auto rows = static_cast<Eigen::Index>(residuals->count());
  Jacobian jacobian(rows, static_cast<Eigen::Index>(z.size()));
  std::vector<double> r(residuals->count());
  ASSERT_TRUE(residuals->evaluate(z, r, {jacobian.data(), static_cast<std::size_t>(jacobian.size())}));
  for (std::size_t i = 0; i < z.size(); ++i) ASSERT_FALSE(found.at_bound[i] || found.without_effect[i]) << i;
  std::vector<std::span<const double>> series;
  std::size_t first = 0;
  for (const Record& record : records) {
    series.emplace_back(&r[first], record.readings);
    first += record.readings;
  }
  const Autocovariance observed = autocovariance_of(series);
  NoiseModel noise = fit_noise(observed);
  const Eigen::MatrixXd inverse = jacobian.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXd hat = jacobian * inverse;
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::MatrixXd c = covariance_of(noise, records), ch = c * hat;
    const Eigen::MatrixXd absorbed = ch + ch.transpose() - hat * ch;
    Autocovariance whole = observed;
    whole.lags.resize(std::min(whole.lags.size(), noise.coefficients.size() + 5));
    for (std::size_t lag = 0; lag < whole.lags.size(); ++lag) {
      Eigen::Index from = 0;
      for (const Record& record : records) {
        const auto n = static_cast<Eigen::Index>(record.readings);
        whole.lags[lag] += absorbed.block(from, from, n, n).diagonal(static_cast<Eigen::Index>(lag)).sum() /
                           static_cast<double>(whole.samples);
        from += n;
      }
    }
    noise = fit_noise(whole);
  }
  ASSERT_GT(noise.coefficients.size(), 0U);
  EXPECT_NEAR(found.noise.deviation_mm, noise.deviation_mm, 1e-9);
  const Eigen::MatrixXd expected = inverse * covariance_of(noise, records) * inverse.transpose();
  const Eigen::MatrixXd covariance = found.root * found.root.transpose();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    EXPECT_NEAR(covariance(i, i) / expected(i, i), 1, 1e-6) << i;
}

/// Residuals whose column `index` of the Jacobian is multiplied by a factor.
class MultipliedColumn : public Residuals {
 public:
  MultipliedColumn(const Residuals& of, std::size_t index, double factor)
      : Residuals(of.records(), of.space()), of_(of), index_(index), factor_(factor) {}

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    if (!of_.evaluate(z, r, jacobian)) return false;
    for (std::size_t i = index_; i < jacobian.size(); i += z.size()) jacobian[i] *= factor_;
    return true;
  }

 private:
  const Residuals& of_;
  std::size_t index_;
  double factor_;
};

TEST(Uncertainty, TheEffectOfAParameterDoesNotDependOnOtherParameters) {
  const model::Model truth = loaded("bench_twin");
  const std::vector<Record> records =
      make_records({simulated(truth, model::SignalName::tp1, 25, 0.02, 1)}, {});
  const auto residuals = residuals_for(records, FitSpace(truth, records, {0, 1, 2, 3, 8, 9}));
  const std::vector<double> z = residuals->space().z({truth, rest_starts(truth, records)});
  for (const double factor : {0.0, 1e-12, 1e12}) {
    const Uncertainty found = uncertainty_at(MultipliedColumn(*residuals, 0, factor), z, HUGE_VAL);
    EXPECT_EQ(found.without_effect[0], factor < 1) << factor;
    for (std::size_t i = 1; i < z.size(); ++i) EXPECT_FALSE(found.without_effect[i]) << factor << " " << i;
  }
}

// The noise is too large for an estimate of the delay, so some of the estimates are at the lower bound.
TEST(Profile, ContainsASmallDelayIfTheEstimateIsAtItsBound) {
  constexpr double true_delay_s = 0.002;
  model::Model truth = loaded("bench_twin");
  truth.blocks[*model::position_of<model::TransportDelay>(truth)].values[0] = true_delay_s;
  IdentifyOptions options;
  options.free = {"transport_delay.delay_s"};
  options.profile = true;
  options.starts = 1;
  int at_bound = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto result = identify({simulated(truth, model::SignalName::tp1, 10, 4, seed)}, truth, options);
    ASSERT_TRUE(result);
    const auto delay = std::find_if(result->parameters.begin(), result->parameters.end(),
                                    [](const Estimate& e) { return e.name == "transport_delay.delay_s"; });
    ASSERT_TRUE(delay != result->parameters.end() && delay->profile95) << seed;
    at_bound += delay->ci95 ? 0 : 1;
    EXPECT_LE(delay->profile95->lower, true_delay_s) << seed;
    EXPECT_GE(delay->profile95->upper, true_delay_s) << seed;
    EXPECT_LT(delay->profile95->upper, 0.5) << seed;
  }
  EXPECT_GE(at_bound, 2);
}

TEST(Identify, IsRefusedIfNothingRemainsToBeFitted) {
  const model::Model truth = loaded("bench_twin");
  const std::vector<Log> logs{simulated(truth, model::SignalName::tp1, 20, 0, 1)};
  IdentifyOptions options;
  options.fixed = {"kelvin_voigt.k0_kpa_per_mm"};
  options.free = options.fixed;
  const auto result = identify(logs, truth, options);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().find("nothing can be fitted"), std::string::npos) << result.error();
}

/// Compares the result with the result of a search on a fine grid.
TEST(BoundedSolve, FindsTheConstrainedMinimum) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd a(8, 2);
    Eigen::VectorXd y(8);
    for (Eigen::Index i = 0; i < 8; ++i) {
      y(i) = normal(random);
      for (Eigen::Index j = 0; j < 2; ++j) a(i, j) = normal(random);
    }
    const Eigen::MatrixXd gram = a.transpose() * a;
    const Eigen::VectorXd right = a.transpose() * y;
    const Eigen::Vector2d lower(-0.2, 0.0);
    const Eigen::Vector2d upper(0.2, 0.3);
    const auto solution = solve_bounded(gram, right, lower, upper);
    const auto cost = [&](const Eigen::VectorXd& x) { return 0.5 * x.dot(gram * x) - right.dot(x); };
    double best = 1e9;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200; ++j) {
        const Eigen::Vector2d x(-0.2 + 0.4 * i / 200.0, 0.3 * j / 200.0);
        best = std::min(best, cost(x));
      }
    }
    EXPECT_LE(cost(solution.x), best + 1e-9) << "trial " << trial;
    EXPECT_TRUE((solution.x.array() >= lower.array() - 1e-12).all());
    EXPECT_TRUE((solution.x.array() <= upper.array() + 1e-12).all());
  }
}

TEST(BoundedSolve, SolvesASystemWithTwoEqualColumns) {
  Eigen::MatrixXd gram(2, 2);
  gram << 1, 1, 1, 1;
  const Eigen::Vector2d wide(1e6, 1e6);
  const auto solution = solve_bounded(gram, Eigen::Vector2d(1, 1), -wide, wide);
  EXPECT_NEAR(solution.x.sum(), 1, 1e-6);
}

TEST(Cycles, AreFoundOnlyInARepeatedCommand) {
  const model::Model model = loaded("zhang2025");
  const auto tp1 = make_records({simulated(model, model::SignalName::tp1, 50, 0, 1)}, {});
  const auto starts = cycle_starts(tp1.front());
  ASSERT_EQ(starts.size(), 2U);
  EXPECT_NEAR(tp1.front().time_s[starts[1]], 25, 0.5);
  const auto hold = make_records({simulated(model, model::SignalName::hold, 50, 0, 1)}, {});
  EXPECT_EQ(cycle_starts(hold.front()).size(), 1U);
  EXPECT_TRUE(std::isnan(score_of(model, hold.front(), {}, hold.front().reading_mm).settled_rmse_mm));
}

TEST(Score, ErrorOfTheTrueModelEqualsTheNoise) {
  const model::Model model = loaded("bench_twin");
  const auto records = make_records({simulated(model, model::SignalName::sp1, 50, 0.05, 1)}, {});
  const Score score = score_of(model, records[0], rest_starts(model, records)[0], records[0].reading_mm);
  EXPECT_NEAR(score.rmse_mm, 0.05, 0.002);
  EXPECT_NEAR(score.rmse_percent_of_span, 100 * score.rmse_mm / records[0].span_mm, 1e-9);
  EXPECT_NEAR(fast_noise_mm(records[0]), 0.05, 0.003);
}

TEST(Score, MissingReadingsDoNotCount) {
  const model::Model model = loaded("bench_twin");
  auto records = make_records({simulated(model, model::SignalName::sp1, 50, 0.05, 1)}, {});
  const std::vector<StartState> starts = rest_starts(model, records);
  records[0].reading_mm[7] = records[0].reading_mm[100] = std::nan("");
  EXPECT_NEAR(score_of(model, records[0], starts[0], records[0].reading_mm).rmse_mm, 0.05, 0.002);
  EXPECT_NEAR(rmse_of(model, starts, records), 0.05, 0.002);
}

TEST(Score, ErrorIsInfiniteIfThePredictionIsNotFinite) {
  const model::Model model = loaded("bench_twin");
  const Log log = simulated(model, model::SignalName::tp1, 50, 0.05, 1);
  const auto records = make_records({log}, {});
  for (const double value : {std::nan(""), HUGE_VAL}) {
    std::vector<StartState> starts = rest_starts(model, records);
    starts[0].offset_mm = value;
    const Score score = score_of(model, records[0], starts[0], records[0].reading_mm);
    for (const double error : {score.rmse_mm, score.rmse_percent_of_span, score.largest_error_mm,
                               score.first_cycle_rmse_mm, score.settled_rmse_mm})
      EXPECT_EQ(error, HUGE_VAL) << value;
    EXPECT_TRUE(score.diverges) << value;
    EXPECT_EQ(rmse_of(model, starts, records), HUGE_VAL) << value;
    Validation validation = validate_logs(model, {log}, {});
    validation.scores = {score};
    EXPECT_NE(verdict_of(validation).find("a predicted value is not finite"), std::string::npos)
        << verdict_of(validation);
  }
}

TEST(Score, ACycleWithoutReadingsHasNoError) {
  const model::Model model = loaded("bench_twin");
  Log log = simulated(model, model::SignalName::tp1, 50, 0.05, 1);
  Record record = make_records({log}, {}).front();
  const std::vector<std::size_t> cycles = cycle_starts(record);
  ASSERT_GT(cycles.size(), 1U);
  std::fill_n(record.reading_mm.begin(), cycles[1], std::nan(""));
  const Score score = score_of(model, record, StartState{}, record.reading_mm);
  EXPECT_TRUE(std::isnan(score.first_cycle_rmse_mm)) << score.first_cycle_rmse_mm;
  EXPECT_GT(score.settled_rmse_mm, 0);
}

TEST(Score, ErrorIsInfiniteIfASinglePredictionIsNotFinite) {
  const std::vector<double> readings{0, std::nan(""), 1}, errors{0.1, std::nan(""), std::nan("")};
  EXPECT_EQ(rms_error(readings, errors), HUGE_VAL);
  EXPECT_NEAR(rms_error(std::span(readings).first(2), std::span(errors).first(2)), 0.1, 1e-12);
}

TEST(Score, ScaledReadingsAreNoDivergence) {
  const model::Model model = loaded("bench_twin");
  Log log = simulated(model, model::SignalName::sp1, 50, 0.05, 1);
  const auto diverges_at = [&](double factor, double alternating_mm) {
    Log other = log;
    for (std::size_t i = 0; i < other.size(); ++i) {
      other.displacement_mm[i] *= factor;
      other.displacement_mm[i] += alternating_mm * static_cast<double>(i % 2);
    }
    const std::vector<Record> records = make_records({other}, {});
    const Score score = score_of(model, records[0], rest_starts(model, records)[0], records[0].reading_mm);
    EXPECT_EQ(divergences_of({score}).size(), score.diverges ? 1U : 0U);
    return score.diverges;
  };
  for (const double factor : {1.0, -1.0, 1e-3, 0.1, 1e3}) EXPECT_FALSE(diverges_at(factor, 0)) << factor;
  EXPECT_TRUE(diverges_at(0, 0.1));  // the readings alternate by 0.1 mm and do not follow the command, so the
                                     // prediction diverges from them
}

TEST(Validate, EstimatesTheOffsetOfLogsThatStartAtRest) {
  const model::Model model = loaded("bench_twin");
  std::vector<Log> logs{simulated(model, model::SignalName::sp1, 50, 0.05, 1),
                        simulated(model, model::SignalName::tp2, 50, 0.05, 2)};
  for (double& y : logs[1].displacement_mm) y += 2;
  const Validation v = validate_logs(model, logs);
  EXPECT_NEAR(v.scores[0].start.offset_mm, 0, 0.01);
  EXPECT_NEAR(v.scores[1].start.offset_mm, 2, 0.01);
  for (std::size_t k = 0; k < logs.size(); ++k) EXPECT_TRUE(is_at_rest(v.scores[k].start, v.records[k]));
  for (const Score& s : v.scores) EXPECT_NEAR(s.rmse_mm, 0.05, 0.002);
}

TEST(Validation, TheSentenceAboutOneLogNamesNoOtherLogs) {
  const model::Model model = loaded("bench_twin");
  const std::vector<Log> logs{simulated(model, model::SignalName::sp1, 50, 0.05, 1),
                              simulated(model, model::SignalName::tp2, 50, 0.05, 2)};
  Validation one = validate_logs(model, {logs.front()});
  one.at_most_percent = 1e-6;
  EXPECT_NE(verdict_of(one).find(" % of the span of the log: above the permitted 1e-06 %."),
            std::string::npos)
      << verdict_of(one);
  EXPECT_EQ(verdict_of(one).find("at most"), std::string::npos) << verdict_of(one);
  EXPECT_NE(verdict_of(validate_logs(model, logs)).find(" % of the span of each log."), std::string::npos);
}

TEST(Records, MissingPressuresAreFilledButReadingsAreNot) {
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 1);
  log.pressure_kpa = log.pressure_command_kpa;
  for (const std::size_t i : {std::size_t{0}, std::size_t{40}, std::size_t{41}, log.size() - 1}) {
    log.pressure_kpa[i] = std::nan("");
    log.displacement_mm[i] = std::nan("");
  }
  RecordOptions options;
  options.drive = Drive::measured;
  const Record record = make_records({log}, options).front();
  EXPECT_EQ(record.readings, log.size() - 4);
  EXPECT_NEAR(record.drive_kpa[40], log.pressure_command_kpa[40], 1e-9);
  EXPECT_EQ(record.drive_kpa[0], log.pressure_command_kpa[1]);
  EXPECT_TRUE(std::isfinite(record.drive_kpa.back()));
}

}  // namespace
}  // namespace softgrip::sysid::statistics_test
