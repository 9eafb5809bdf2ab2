#include "sysid/diagnosis/verdict/loop_valve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <utility>

#include <Eigen/QR>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

// The grids contain the sizes that a record can show: bands between the noise and the span of the command,
// and lags and dead times between one sample and a part of the record.
constexpr std::array band_shares{0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 0.95};
constexpr std::array jump_shares{0.0, 1.0 / 3, 2.0 / 3, 1.0};
constexpr std::array<double, 7> process_poles{0.0, 0.5, 0.8, 0.92, 0.97, 0.99, 0.995};
constexpr std::array<Eigen::Index, 10> dead_times{1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
constexpr std::array load_zeros{0.0, 0.4, 0.7, 0.85, 0.95, 0.99};
/// Number of past readings in the model of the load. Ten describe a sinusoidal load behind the noise of the
/// readings. With six, smooth sinusoidal loads with long periods are reported as a sticking valve.
constexpr Eigen::Index load_order = 10;
/// Number of samples at the beginning without a prediction: the largest dead time, and the start of the
/// filters.
constexpr Eigen::Index skipped = dead_times.back() + 2;
/// Relative decrease of the sum of squares below which a refinement ends.
constexpr double least_improvement = 1e-4;

/// Returns the differences of the samples behind the inverse of a moving average, (1 - z) / (1 - zero z). z
/// is the shift by one sample.
Eigen::VectorXd whitened(const std::vector<double>& values, double zero) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(values.size()));
  double before = values.front(), state = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    state = out[static_cast<Eigen::Index>(i)] = zero * state + values[i] - before;
    before = values[i];
  }
  return out;
}

Eigen::VectorXd lagged(Eigen::VectorXd values, double pole) {
  double state = 0;
  for (double& value : values) value = state = pole * state + (1 - pole) * value;
  return values;
}

/// Behaviour of process and load.
struct Dynamics {
  std::size_t zero = 0;  ///< index in `load_zeros`
  double pole = 0;
};

struct Fit {
  double squares = std::numeric_limits<double>::infinity();  ///< of the one-step prediction errors
  Dynamics dynamics;
};

/// Fits the one-step predictions of the readings to inputs.
class Predictions {
 public:
  explicit Predictions(const std::vector<double>& reading)
      : rows_(static_cast<Eigen::Index>(reading.size()) - skipped) {
    for (const double zero : load_zeros) {
      const Eigen::VectorXd white = whitened(reading, zero);
      Eigen::MatrixXd past(rows_, load_order);
      for (Eigen::Index lag = 1; lag <= load_order; ++lag)
        past.col(lag - 1) = white.segment(skipped - lag, rows_);
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(past);
      Readings readings{qr.householderQ() * Eigen::MatrixXd::Identity(rows_, load_order), white.tail(rows_)};
      readings.target -= readings.past * (readings.past.transpose() * readings.target);
      readings_.push_back(std::move(readings));
    }
  }

  /// Returns the fit with the given dynamics, and with the best load, dead time and gain.
  [[nodiscard]] Fit fit(const std::vector<double>& input, const Dynamics& dynamics) const {
    return {squares(lagged(whitened(input, load_zeros[dynamics.zero]), dynamics.pole), dynamics.zero),
            dynamics};
  }

  /// Returns the best fit.
  [[nodiscard]] Fit fit(const std::vector<double>& input) const { return fit({&input}); }

  /// Returns the best fit to a quadratic function of the input.
  [[nodiscard]] Fit fit_curved(const std::vector<double>& input) const {
    const double middle =
        Eigen::Map<const Eigen::ArrayXd>(input.data(), static_cast<Eigen::Index>(input.size())).mean();
    std::vector<double> squared;
    squared.reserve(input.size());
    for (const double value : input) squared.push_back((value - middle) * (value - middle));
    return fit({&input, &squared});
  }

 private:
  struct Readings {
    Eigen::MatrixXd past;    ///< orthonormal basis of the past readings
    Eigen::VectorXd target;  ///< readings that the past readings do not predict
  };

  /// Returns the best fit to a linear combination of the inputs.
  [[nodiscard]] Fit fit(std::initializer_list<const std::vector<double>*> inputs) const {
    const auto count = static_cast<Eigen::Index>(inputs.size());
    Eigen::MatrixXd white(rows_ + skipped, count), moved(rows_ + skipped, count);
    Fit best;
    for (std::size_t zero = 0; zero < load_zeros.size(); ++zero) {
      Eigen::Index column = 0;
      for (const auto* const input : inputs) white.col(column++) = whitened(*input, load_zeros[zero]);
      for (const double pole : process_poles) {
        for (column = 0; column < count; ++column) moved.col(column) = lagged(white.col(column), pole);
        const double left = squares(moved, zero);
        if (left < best.squares) best = {left, {zero, pole}};
      }
    }
    return best;
  }

  /// Returns the smallest sum of squares of the one-step prediction errors over all dead times.
  /// @param inputs  one input per column. The gain of the first input must not be negative.
  [[nodiscard]] double squares(const Eigen::MatrixXd& inputs, std::size_t zero) const {
    const auto& [past, target] = readings_[zero];
    const double all = target.squaredNorm();
    double least = all;
    for (const Eigen::Index delay : dead_times) {
      const auto moved = inputs.middleRows(skipped - delay, rows_);
      const Eigen::MatrixXd known = past.transpose() * moved, whole = moved.transpose() * moved;
      const Eigen::MatrixXd left = whole - known.transpose() * known;
      if (!(left.diagonal().array() > 1e-9 * whole.diagonal().array()).all()) continue;
      const Eigen::VectorXd gained = moved.transpose() * target;
      const Eigen::VectorXd gains = left.colPivHouseholderQr().solve(gained);
      if (gains[0] > 0) least = std::min(least, all - gained.dot(gains));
    }
    return least;
  }

  Eigen::Index rows_;
  std::vector<Readings> readings_;  ///< one per value of `load_zeros`
};

double repeated_share(const std::vector<double>& values) {
  std::size_t same = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] == values[i - 1]) ++same;
  }
  return static_cast<double>(same) / static_cast<double>(values.size());
}

std::size_t moves_in(const std::vector<double>& stem) {
  std::size_t moves = 0;
  for (std::size_t i = 1; i < stem.size(); ++i) {
    if (stem[i] != stem[i - 1]) ++moves;
  }
  return moves;
}

/// Sticking valves that are compared with other explanations of the readings.
class Stems {
 public:
  Stems(const std::vector<double>& command, const std::vector<double>& reading, double most_band,
        double least_band)
      : command_(command),
        predictions_(reading),
        most_band_(most_band),
        least_band_(least_band),
        rows_(static_cast<double>(reading.size()) - static_cast<double>(skipped)) {}

  /// Compares a sticking valve. Omits it if its band is not possible, or if it moves less than twice.
  void add(double band, double jump) {
    if (const auto positions = positions_of(band, jump)) {
      ++compared_;
      tried_.push_back({{band, jump, 0}, predictions_.fit(*positions)});
    }
  }

  [[nodiscard]] std::optional<StickingStem> best(const OtherExplanations& others) {
    double follows = predictions_.fit(command_).squares;
    if (others.curved) follows = std::min(follows, predictions_.fit_curved(command_).squares);
    if (!others.response.empty()) follows = std::min(follows, predictions_.fit(others.response).squares);
    std::sort(tried_.begin(), tried_.end(),
              [](const Tried& a, const Tried& b) { return a.fit.squares < b.fit.squares; });
    tried_.resize(std::min(tried_.size(), limits::followed_starts));
    for (Tried& one : tried_) refine(one);
    const auto best = std::min_element(tried_.begin(), tried_.end(), [](const Tried& a, const Tried& b) {
      return a.fit.squares < b.fit.squares;
    });
    if (best == tried_.end() || !(best->fit.squares > 0) || !(follows > 0)) return std::nullopt;
    StickingStem found = best->stem;
    found.log_likelihood_ratio =
        0.5 * rows_ * std::log(follows / best->fit.squares) - std::log(static_cast<double>(compared_));
    return found;
  }

 private:
  struct Tried {
    StickingStem stem;
    Fit fit;
  };

  [[nodiscard]] std::optional<std::vector<double>> positions_of(double band, double jump) const {
    if (band < least_band_ || band >= most_band_) return std::nullopt;
    std::vector<double> positions = stem_positions(command_, band, jump);
    if (moves_in(positions) < 2) return std::nullopt;
    return positions;
  }

  /// Improves band and jump with constant dynamics, because the times of the jumps depend strongly on the
  /// band. After that, fits the dynamics again.
  void refine(Tried& one) {
    for (const double step : {0.2, 0.1, 0.05, 0.025, 0.0125}) {
      for (bool improved = true; std::exchange(improved, false);) {
        const auto [band, jump, unused] = one.stem;
        const double change = step * band;
        for (const auto& [more, higher] :
             {std::pair{change, 0.0}, {-change, 0.0}, {0.0, change}, {0.0, -change}}) {
          const StickingStem near{band + more, std::clamp(jump + higher, 0.0, band + more), 0};
          const auto positions = positions_of(near.band, near.jump);
          if (!positions) continue;
          const Fit fit = predictions_.fit(*positions, one.fit.dynamics);
          if (!(fit.squares < one.fit.squares * (1 - least_improvement))) continue;
          one = {near, fit};
          improved = true;
        }
      }
    }
    if (const auto positions = positions_of(one.stem.band, one.stem.jump))
      one.fit = predictions_.fit(*positions);
  }

  const std::vector<double>& command_;
  Predictions predictions_;
  double most_band_, least_band_, rows_;
  std::size_t compared_ = 0;
  std::vector<Tried> tried_;
};

}  // namespace

std::vector<double> stem_positions(const std::vector<double>& command, double band, double jump) {
  const double at_rest = (band + jump) / 2, sliding = (band - jump) / 2;  // friction / stiffness
  std::vector<double> stem(command.size());
  double force = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (i == 0) {
      stem[0] = command[0];
      continue;
    }
    force += command[i] - command[i - 1];
    stem[i] = stem[i - 1];
    if (std::abs(force) <= at_rest) continue;
    const double kept = std::copysign(sliding, force);
    stem[i] += force - kept;
    force = kept;
  }
  return stem;
}

std::optional<StickingStem> best_sticking_stem(const std::vector<double>& command,
                                               const std::vector<double>& reading,
                                               const OtherExplanations& others) {
  if (command.size() != reading.size() ||
      command.size() < limits::fewest_readings + static_cast<std::size_t>(skipped) ||
      repeated_share(command) > limits::majority_share || repeated_share(reading) > limits::majority_share)
    return std::nullopt;
  const auto [low, high] = std::minmax_element(command.begin(), command.end());
  const double span = *high - *low;
  const double least_band = std::max(limits::least_explained_share * span,
                                     limits::strict_deviate * third_difference_noise(command));
  Stems stems(command, reading, span, least_band);
  for (const double share : band_shares) {
    for (const double jump_share : jump_shares) stems.add(share * span, jump_share * share * span);
  }
  return stems.best(others);
}

}  // namespace softgrip::sysid
