#include "sysid/fitting/start_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include "base/statistics.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/fitting/trajectory_walk.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/each_record.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

constexpr double used_share = 0.05, used_at_least_s = 2, used_at_most_share = 0.5;
/// Prior standard deviation of the unsettled creep of a branch, divided by the settled creep of this branch
/// over the range of the drive.
constexpr double unsettled_share = 0.3;
/// Number of standard deviations by which the fit of an unknown start must be better than the simpler
/// assumption (a start at rest, or the steady cycle).
constexpr double rejected_at = 3;
/// Numbers of an unknown start apart from the creep of the branches: the last peak and the last valley.
constexpr double reversals = 2;
/// Duration after the first sample from which the speed of the drive is computed [s].
constexpr double speed_over_s = 0.1;
/// Two numbers of the search for the last reversals of the pressure: the number of steps of the first grid,
/// and how often the grid step is halved afterwards.
constexpr int grid_steps = 5, halvings = 4;
/// The autocorrelation is summed up to the first lag at which it is below this limit.
constexpr double least_correlation = 0.05;
/// Number of independent readings that is assumed before a residual has been computed.
constexpr double independent_at_first = 5;
/// Number of shifts that are tried within a period of the largest oscillation. The best of them is then
/// refined.
constexpr int tried_shifts = 16;
/// Accuracy of the shift, as a share of the period. The resulting error is below 0.1 % of the amplitude.
constexpr double shift_accuracy = 1e-4;

Record beginning_of(const Record& unit) {
  std::vector<std::size_t> kept(samples_for_start(unit));
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  Record beginning = thinned_record(unit, kept);
  beginning.sample_time_s = unit.sample_time_s;
  return beginning;
}

/// Returns the effective number of independent residuals, computed from the sum of their autocorrelation.
double independent_among(const Eigen::VectorXd& residual) {
  const Eigen::Index n = residual.size();
  const double squares = residual.squaredNorm();
  double sum = 0;
  for (Eigen::Index lag = 1; lag < n / 2 && squares > 0; ++lag) {
    const double correlation = residual.head(n - lag).dot(residual.tail(n - lag)) / squares;
    if (correlation < least_correlation) break;
    sum += correlation;
  }
  return std::max(1.0, static_cast<double>(n) / (1 + 2 * sum));
}

/// Weight of the readings relative to the priors. This weight depends on the mean square of the residual and
/// on the effective number of independent readings.
struct Trust {
  double mean_square_mm2 = 0;
  double independent = 1;
};

/// A trial of an initial state, and the residual of the first readings with this state.
struct Trial {
  StartState start;
  double cost = std::numeric_limits<double>::infinity();  ///< -2 times the logarithm of the posterior
                                                          ///< probability
  Trust left;
};

class StartSearch {
 public:
  StartSearch(const model::Model& model, const Record& unit)
      : model_(model),
        beginning_(beginning_of(unit)),
        branches_(creep_branches(model)),
        first_kpa_(unit.drive_kpa.front()),
        under_pressure_(unit.start_unknown && unit.start == Start::automatic) {
    const auto [lowest, highest] = std::minmax_element(unit.drive_kpa.begin(), unit.drive_kpa.end());
    lowest_kpa_ = *lowest;
    highest_kpa_ = *highest;
    for (std::size_t i = 0; i < beginning_.size(); ++i) {
      if (std::isfinite(beginning_.reading_mm[i])) rows_.push_back(i);
    }
  }

  StartState run(const Record& unit) {
    StartState rest = at_rest();
    if (rows_.empty()) return rest;
    rest.oscillation_shift_s = oscillation_shift_s(unexplained(rest));
    const Trial resting = with_offset(rest);
    if (unit.start == Start::rest) return resting.start;
    const Trial moving = anywhere(rest);
    return unit.start_unknown || is_rejected(resting, moving) ? moving.start : resting.start;
  }

 private:
  [[nodiscard]] StartState at_rest() const {
    StartState rest;
    rest.peak_before_kpa = first_kpa_;
    rest.unsettled_mm.assign(branches_.size(), 0);
    return rest;
  }

  /// Returns the readings minus the prediction. The prediction begins at the state `start`, with zero offset
  /// and settled creep.
  [[nodiscard]] Eigen::VectorXd unexplained(StartState start) const {
    start.offset_mm = 0;
    std::fill(start.unsettled_mm.begin(), start.unsettled_mm.end(), 0.0);
    const std::vector<double> predicted = predict(model_, beginning_, start);
    Eigen::VectorXd left(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t r = 0; r < rows_.size(); ++r)
      left[static_cast<Eigen::Index>(r)] = beginning_.reading_mm[rows_[r]] - predicted[rows_[r]];
    return left;
  }

  [[nodiscard]] Trial with_offset(StartState start) const {
    const Eigen::VectorXd y = unexplained(start);
    Trial trial;
    trial.start = std::move(start);
    trial.start.offset_mm = y.mean();
    const Eigen::VectorXd left = y.array() - y.mean();
    trial.left = {left.squaredNorm() / static_cast<double>(y.size()), independent_among(left)};
    return trial;
  }

  /// Estimates the offset and the unsettled creep by least squares. The unsettled creep has a prior, and the
  /// offset has none. The reversals of the pressure before the log are those in `start`.
  [[nodiscard]] Trial with_creep(StartState start, const Trust& trust) const {
    const Eigen::VectorXd y = unexplained(start);
    const double weight = trust.independent / (static_cast<double>(y.size()) * trust.mean_square_mm2);
    Eigen::MatrixXd normal = weight * columns_.transpose() * columns_;
    normal.diagonal() += precision_;
    const Eigen::VectorXd numbers = normal.ldlt().solve(weight * columns_.transpose() * y);
    const Eigen::VectorXd left = y - columns_ * numbers;
    Trial trial;
    trial.start = std::move(start);
    trial.start.offset_mm = numbers[0];
    for (std::size_t b = 0; b < branches_.size(); ++b)
      trial.start.unsettled_mm[b] = numbers[static_cast<Eigen::Index>(b + 1)];
    trial.left = {std::max(left.squaredNorm() / static_cast<double>(y.size()), smallest_mm2),
                  independent_among(left)};
    const double cost = weight * left.squaredNorm() + (precision_.array() * numbers.array().square()).sum();
    if (std::isfinite(cost)) trial.cost = cost;
    return trial;
  }

  [[nodiscard]] Trial best_of(const std::vector<StartState>& starts, const Trust& trust) const {
    Trial best = with_creep(starts.front(), trust);
    for (std::size_t i = 1; i < starts.size(); ++i) {
      Trial trial = with_creep(starts[i], trust);
      if (trial.cost < best.cost) best = std::move(trial);
    }
    return best;
  }

  /// Returns the initial state whose posterior probability is highest, given the first readings and the
  /// priors.
  [[nodiscard]] Trial anywhere(const StartState& rest) {
    prepare_creep();
    const std::vector<StartState> starts = grid(rest);
    const Eigen::VectorXd y = unexplained(rest);
    const double spread_mm2 = (y.array() - y.mean()).square().mean();
    Trial best = best_of(starts, {std::max(spread_mm2, smallest_mm2), independent_at_first});
    // The weight of the priors depends on the residual, and the residual depends on the priors. Therefore the
    // estimate is repeated.
    for (int pass = 0; pass < 2; ++pass) best = best_of(starts, best.left);
    double peak_step = (highest_kpa_ - first_kpa_) / grid_steps;
    double valley_step = (first_kpa_ - lowest_kpa_) / grid_steps;
    for (int halving = 0; halving < halvings; ++halving) {
      peak_step /= 2;
      valley_step /= 2;
      best = best_of(around(best.start, peak_step, valley_step), best.left);
    }
    if (!under_pressure_) return best;
    // A single stroke may not contain enough information to determine the initial state. The noise would then
    // select a state. Therefore the steady cycle over the range of the drive is preferred.
    const Trial usual = with_creep(turned(rest, highest_kpa_, lowest_kpa_), best.left);
    return usual.cost < best.cost + square(rejected_at) ? usual : best;
  }

  /// Returns the sum of all oscillations of the model at each reading.
  [[nodiscard]] Eigen::VectorXd oscillations_mm(double shift_s) const {
    Eigen::VectorXd sum_mm = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows_.size()));
    for (const model::BlockSpec& block : model_.blocks) {
      if (!model::is<model::PeriodicDisturbance>(block)) continue;
      model::PeriodicDisturbance<double> oscillation(block.values, {});
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (rows_[r] == 0) continue;  // a simulation begins with the first step after this sample
        model::Surroundings around = surroundings_at(beginning_, rows_[r]);
        around.oscillation_shift_s += shift_s;
        sum_mm[static_cast<Eigen::Index>(r)] += oscillation.sample(0, 0, around);
      }
    }
    return sum_mm;
  }

  /// Returns the period of the largest oscillation of the model [s], or 0 if the model has no oscillation.
  [[nodiscard]] double oscillation_period_s() const {
    double period_s = 0, largest_mm = 0;
    for (const model::BlockSpec& block : model_.blocks) {
      if (!model::is<model::PeriodicDisturbance>(block)) continue;
      const double amplitude_mm = std::hypot(model::value<model::PeriodicDisturbance>(block, "sine_mm"),
                                             model::value<model::PeriodicDisturbance>(block, "cosine_mm"));
      if (!(amplitude_mm > largest_mm)) continue;
      largest_mm = amplitude_mm;
      period_s = 1 / model::value<model::PeriodicDisturbance>(block, "frequency_hz");
    }
    return period_s;
  }

  /// Returns the shift of the oscillations for which the residual is smallest, after a straight line is
  /// subtracted from the residual. Returns 0 if the reduction could be noise.
  /// @param unshifted_mm  readings minus the prediction without a shift.
  [[nodiscard]] double oscillation_shift_s(const Eigen::VectorXd& unshifted_mm) const {
    const double period_s = oscillation_period_s();
    if (period_s <= 0) return 0;
    Eigen::MatrixXd line = Eigen::MatrixXd::Ones(unshifted_mm.size(), 2);
    for (std::size_t r = 0; r < rows_.size(); ++r)
      line(static_cast<Eigen::Index>(r), 1) = beginning_.time_s[rows_[r]] - beginning_.time_s[0];
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(line);
    const Eigen::VectorXd others_mm = unshifted_mm + oscillations_mm(0);
    const auto left_with = [&](double shift_s) -> Eigen::VectorXd {
      const Eigen::VectorXd left = others_mm - oscillations_mm(shift_s);
      return left - line * qr.solve(left);
    };
    double best_s = 0, step_s = period_s / tried_shifts;
    const double unshifted_mm2 = left_with(0).squaredNorm();
    double best_mm2 = unshifted_mm2;
    const auto attempt = [&](double shift_s) {
      const double squares_mm2 = left_with(shift_s).squaredNorm();
      if (!(squares_mm2 < best_mm2)) return;
      best_mm2 = squares_mm2;
      best_s = shift_s;
    };
    for (int i = 1; i < tried_shifts; ++i) attempt(std::remainder(i * step_s, period_s));
    for (; step_s > shift_accuracy * period_s; step_s /= 2) {
      const double centre_s = best_s;
      attempt(centre_s - step_s / 2);
      attempt(centre_s + step_s / 2);
    }
    const Eigen::VectorXd left = left_with(best_s);
    const double noise_mm2 = best_mm2 / independent_among(left);
    return unshifted_mm2 - best_mm2 > square(rejected_at) * noise_mm2 ? best_s : 0;
  }

  void prepare_creep() {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const auto branches = static_cast<Eigen::Index>(branches_.size());
    columns_ = Eigen::MatrixXd::Ones(rows, 1 + branches);
    precision_ = Eigen::VectorXd::Zero(1 + branches);
    if (branches == 0) return;
    for (Eigen::Index b = 0; b < branches; ++b) {
      const auto branch = static_cast<std::size_t>(b);
      for (Eigen::Index r = 0; r < rows; ++r) {
        const double since_s = beginning_.time_s[rows_[static_cast<std::size_t>(r)]] - beginning_.time_s[0];
        columns_(r, 1 + b) = std::exp(-since_s / branches_[branch].time_constant_s);
      }
      const double settled_mm = (highest_kpa_ - lowest_kpa_) * branches_[branch].gain_mm_per_kpa;
      precision_[1 + b] = 1 / std::max(square(unsettled_share * settled_mm), smallest_mm2);
    }
  }

  /// Returns `rest`, and a start state for every pair of a last peak and a subsequent valley on the grid.
  [[nodiscard]] std::vector<StartState> grid(const StartState& rest) const {
    std::vector<StartState> starts{rest};
    for (int peak = 0; peak <= grid_steps; ++peak) {
      for (int valley = 0; valley <= grid_steps; ++valley) {
        starts.push_back(turned(rest, first_kpa_ + (highest_kpa_ - first_kpa_) * peak / grid_steps,
                                first_kpa_ - (first_kpa_ - lowest_kpa_) * valley / grid_steps));
      }
    }
    return starts;
  }

  [[nodiscard]] std::vector<StartState> around(const StartState& start, double peak_step,
                                               double valley_step) const {
    const double peak = std::max(start.peak_before_kpa, first_kpa_);
    const double valley = std::min(start.valley_before_kpa, first_kpa_);
    return {start, turned(start, peak + peak_step, valley), turned(start, peak - peak_step, valley),
            turned(start, peak, valley + valley_step), turned(start, peak, valley - valley_step)};
  }

  [[nodiscard]] StartState turned(StartState start, double peak_kpa, double valley_kpa) const {
    start.peak_before_kpa = std::clamp(peak_kpa, first_kpa_, highest_kpa_);
    start.valley_before_kpa = std::clamp(valley_kpa, lowest_kpa_, first_kpa_);
    start.arrival_kpa_per_s = first_speed_kpa_per_s();
    return start;
  }

  [[nodiscard]] double first_speed_kpa_per_s() const {
    if (beginning_.size() < 2) return 0;
    std::size_t i = 1;
    while (i + 1 < beginning_.size() && beginning_.time_s[i] - beginning_.time_s[0] < speed_over_s) ++i;
    return (beginning_.drive_kpa[i] - first_kpa_) / (beginning_.time_s[i] - beginning_.time_s[0]);
  }

  /// Returns true if the initial state `moving` has a significantly smaller residual than the state `resting`
  /// at rest: neither the noise nor the assumed model error explains the difference. Each fitted number of
  /// the initial state reduces the residual by chance, so the limit is a quantile of the chi-square
  /// distribution. If the model error makes the residuals so dependent that their number is below the number
  /// of fitted numbers, half of the residuals count as free. The fit is the best of many pairs of reversals.
  /// The limit therefore increases by twice the logarithm of their number: the probability decreases with
  /// exp(-x/2), and it is divided by the number of pairs (Bonferroni).
  [[nodiscard]] bool is_rejected(const Trial& resting, const Trial& moving) const {
    const Eigen::VectorXd still = unexplained(resting.start);
    double sum = 0, squares = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const double predicted = beginning_.reading_mm[rows_[r]] - still[static_cast<Eigen::Index>(r)];
      sum += predicted;
      squares += square(predicted);
    }
    const auto n = static_cast<double>(rows_.size());
    const double motion_mm2 = squares / n - square(sum / n);
    const double less_mm2 = resting.left.mean_square_mm2 - moving.left.mean_square_mm2;
    const double numbers = reversals + static_cast<double>(branches_.size());
    const double independent = moving.left.independent;
    const double free = std::max(independent - numbers, limits::majority_share * independent);
    const double most =
        chi_square_quantile(limits::strict_deviate, numbers) + 2 * std::log(square(grid_steps + 1.0));
    const double by_chance_mm2 = most * moving.left.mean_square_mm2 / free;
    return less_mm2 > by_chance_mm2 + square(rejected_at * limits::form_error_share) * motion_mm2;
  }

  static constexpr double smallest_mm2 = 1e-18;

  const model::Model& model_;
  Record beginning_;
  std::vector<CreepBranch> branches_;
  double first_kpa_, lowest_kpa_ = 0, highest_kpa_ = 0;
  bool under_pressure_;
  std::vector<std::size_t> rows_;  ///< indices of the samples that have a reading
  Eigen::MatrixXd columns_;        ///< contributions of the offset and of unsettled creep to the readings
  Eigen::VectorXd precision_;      ///< precision of the priors of the offset and of the unsettled creep
};

}  // namespace

double begin_s(const Record& unit) noexcept {
  return std::min(std::max(used_share * unit.length_s(), used_at_least_s),
                  used_at_most_share * unit.length_s());
}

std::size_t samples_for_start(const Record& record) {
  const double until_s = record.time_s.front() + begin_s(record);
  return std::max<std::size_t>(
      1, static_cast<std::size_t>(std::upper_bound(record.time_s.begin(), record.time_s.end(), until_s) -
                                  record.time_s.begin()));
}

StartState estimated_start(const model::Model& model, const Record& unit) {
  return StartSearch(model, unit).run(unit);
}

bool is_at_rest(const StartState& start, const Record& unit) {
  const double first_kpa = unit.drive_kpa.front();
  return start.peak_before_kpa <= first_kpa && start.valley_before_kpa >= first_kpa &&
         std::all_of(start.unsettled_mm.begin(), start.unsettled_mm.end(), [](double u) { return u == 0; });
}

std::vector<StartState> estimated_starts(const model::Model& model, const std::vector<Record>& units) {
  std::vector<StartState> starts(units.size());
  for_each_record(units, [&](std::size_t k) { starts[k] = estimated_start(model, units[k]); });
  return starts;
}

}  // namespace softgrip::sysid
