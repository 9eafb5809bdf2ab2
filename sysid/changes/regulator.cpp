#include "sysid/changes/regulator.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "model/port_flow.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/fitting/descent.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

using model::atmosphere_kpa;

/// Longest simulation step [s], and largest number of steps in one sampling interval. The number of steps can
/// be limited because the implicit steps are stable. The limit applies to sampling intervals of more than
/// 0.1 s, which do not resolve the dynamics of a regulator.
constexpr double longest_step_s = 0.002;
constexpr int most_steps = 50;
/// Assumed supply pressure as a multiple of the largest command. It is used if the supply pressure is not
/// recorded.
constexpr double supply_unknown = 4;
/// Returns the flow between two absolute pressures, divided by the conductance [kPa].
double flow(double from_kpa, double to_kpa) {
  return from_kpa < to_kpa ? -model::port_flow(to_kpa, from_kpa) : model::port_flow(from_kpa, to_kpa);
}

/// Simulates one regulator. The pressures in finger, valve and supply are absolute.
class Walk {
 public:
  Walk(const Regulator& regulator, double command_kpa)
      : regulator_(regulator),
        seen_kpa_(command_kpa),
        finger_kpa_(command_kpa + atmosphere_kpa),
        valve_kpa_(finger_kpa_) {}

  void step(double command_kpa, double supply_kpa, double step_s) {
    const Regulator& r = regulator_;
    seen_kpa_ = std::clamp(seen_kpa_, command_kpa - r.play_kpa, command_kpa + r.play_kpa);
    const double valve_kpa = before_the_tube(supply_kpa, step_s);
    const double through = through_the_tube(valve_kpa, step_s);
    spool_kpa_ = spool_with(valve_kpa, step_s);
    valve_kpa_ = valve_kpa;
    const double error = seen_kpa_ + atmosphere_kpa - valve_kpa;
    const bool stopped =
        std::abs(error + integral_kpa_) > r.dead_kpa + r.full_kpa && (error + integral_kpa_) * error > 0;
    if (!stopped) integral_kpa_ += r.integral_per_s * error * step_s;
    const double lost = r.leak_per_s > 0 ? r.leak_per_s * flow(finger_kpa_, atmosphere_kpa) : 0;
    finger_kpa_ += step_s * (through - lost);
  }
  [[nodiscard]] double gauge_kpa() const { return finger_kpa_ - atmosphere_kpa; }

 private:
  /// Returns the position of the spool at the end of a step [kPa]. The position is stated as the control
  /// error that holds the spool there at equilibrium.
  [[nodiscard]] double spool_with(double valve_kpa, double step_s) const {
    const Regulator& r = regulator_;
    const double most = r.dead_kpa + r.full_kpa;
    const double wanted = std::clamp(seen_kpa_ + atmosphere_kpa - valve_kpa + integral_kpa_, -most, most);
    return spool_kpa_ + (wanted - spool_kpa_) * step_s / (step_s + r.spool_lag_s);
  }
  /// Returns the flow through the ports, stated as the pressure rate that this flow would cause in the finger
  /// [kPa/s].
  [[nodiscard]] double inflow(double spool_kpa, double valve_kpa, double supply_kpa) const {
    const Regulator& r = regulator_;
    const double open = std::min((std::abs(spool_kpa) - r.dead_kpa) / r.full_kpa, 1.0);
    if (!(open > 0)) return 0;
    return r.port_per_s * open *
           (spool_kpa > 0 ? flow(supply_kpa, valve_kpa) : -flow(valve_kpa, atmosphere_kpa));
  }
  /// Returns the flow into the finger, stated as the pressure rate in the finger [kPa/s]. During one step,
  /// the flow can at most equalise the pressures at the two ends of the tube.
  [[nodiscard]] double through_the_tube(double valve_kpa, double step_s) const {
    const double above = valve_kpa - finger_kpa_;
    if (above == 0) return 0;
    const double flows = regulator_.tube_per_s * flow(valve_kpa, finger_kpa_);
    return flows / (1 + step_s * flows / above);
  }
  /// Returns the flow through the ports, minus the flow into the tube, minus the flow that fills the chamber
  /// [kPa/s].
  [[nodiscard]] double surplus(double valve_kpa, double supply_kpa, double step_s) const {
    const Regulator& r = regulator_;
    return inflow(spool_with(valve_kpa, step_s), valve_kpa, supply_kpa) -
           through_the_tube(valve_kpa, step_s) - r.chamber_share * (valve_kpa - valve_kpa_) / step_s;
  }
  /// Returns the pressure before the tube for which surplus() is zero. surplus() decreases when this pressure
  /// increases. The secant method starts from the pressure of the previous step and nearly always converges.
  /// If it does not converge, the method of false position is used.
  [[nodiscard]] double before_the_tube(double supply_kpa, double step_s) const {
    constexpr int most_secants = 6;
    constexpr double beside_kpa = 0.01;
    double last_kpa = valve_kpa_, last = surplus(last_kpa, supply_kpa, step_s);
    if (last == 0) return last_kpa;
    double next_kpa = last_kpa + std::copysign(beside_kpa, last);
    for (int i = 0; i < most_secants; ++i) {
      const double next = surplus(next_kpa, supply_kpa, step_s);
      const double slope = (next - last) / (next_kpa - last_kpa);
      if (!(slope < 0)) break;
      last_kpa = next_kpa;
      last = next;
      next_kpa = std::clamp(next_kpa - next / slope, atmosphere_kpa, supply_kpa);
      if (std::abs(next_kpa - last_kpa) < near_kpa) return next_kpa;
    }
    return by_false_position(supply_kpa, step_s);
  }
  /// Finds the zero of surplus() by the method of false position (Illinois algorithm).
  [[nodiscard]] double by_false_position(double supply_kpa, double step_s) const {
    constexpr int most = 40;
    double low = atmosphere_kpa, high = supply_kpa;
    double at_low = surplus(low, supply_kpa, step_s), at_high = surplus(high, supply_kpa, step_s);
    if (!(at_low > 0)) return low;
    if (!(at_high < 0)) return high;
    bool was_low = false, was_high = false;
    double between = valve_kpa_;
    for (int i = 0; i < most && high - low > near_kpa; ++i) {
      const double value = surplus(between, supply_kpa, step_s);
      if (value == 0) break;
      if (value > 0) {
        low = between;
        at_low = value;
        if (was_low) at_high *= 0.5;
      } else {
        high = between;
        at_high = value;
        if (was_high) at_low *= 0.5;
      }
      was_low = value > 0;
      was_high = !was_low;
      between = low + at_low / (at_low - at_high) * (high - low);
    }
    return between;
  }

  /// Accuracy of the pressure before the tube [kPa].
  static constexpr double near_kpa = 1e-4;

  Regulator regulator_;
  double seen_kpa_, finger_kpa_, valve_kpa_;
  double integral_kpa_ = 0, spool_kpa_ = 0;
};

constexpr Eigen::Index numbers = 8;
constexpr int most_regulator_steps = 15;
/// Step of the logarithm of a parameter for numerical derivatives, and largest change of this logarithm in
/// one iteration.
constexpr double beside_by = 0.03, longest_move = 1.5;
/// Largest absolute value of the logarithm of (parameter / typical value). It corresponds to a factor of 400.
constexpr double largest_logarithm = 6;
constexpr double least_progress = 0.003;
/// Penalty if a parameter differs from its typical value by a factor of e, as a share of the sum of squared
/// residuals. The penalty keeps a parameter that the readings do not determine at its typical value. For
/// example, the readings do not determine the conductance of a wide tube, because the lags of the filter bank
/// can have the same effect.
constexpr double prior_share = 0.003;

/// Returns the regulator with the coordinates t. A coordinate is the logarithm of (parameter / typical
/// value).
Regulator regulator_at(const Eigen::VectorXd& t, double largest_kpa) {
  const auto times = [&](Eigen::Index i) { return std::exp(t(i)); };
  return {0.002 * largest_kpa * times(0),
          0.01 * largest_kpa * times(1),
          0.2 * largest_kpa * times(2),
          2 * times(3),
          5 * times(4),
          10 * times(5),
          0.01 * times(6),
          0.2 * times(7),
          0};
}

/// Readings averaged over bins, and the fit of a signal behind the regulator to these readings. The signal is
/// that of a finger or of a pressure sensor.
class BinnedReadings {
 public:
  BinnedReadings(const std::vector<Record>& records, double largest_kpa, ReadBy read_by)
      : largest_kpa_(largest_kpa), read_by_(read_by) {
    for (const Record& record : records) {
      const double interval_s = read_by == ReadBy::gauge ? 0.01 : 0.02;
      bin_s_ = std::max(2 * interval_s, 2 * record.mean_interval_s());
      records_.push_back(thinned_to_centres(record, interval_s));
      readings_.push_back(binned(record, record.reading_mm, bin_s_));
      bins_ += readings_.back().size();
    }
  }

  [[nodiscard]] Eigen::VectorXd left_by(const Regulator& regulator) const {
    Eigen::MatrixXd columns;
    Eigen::VectorXd target = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bins_));
    Eigen::Index first = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const Eigen::MatrixXd filters =
          seen(records_[r], regulated(regulator, records_[r], records_[r].drive_kpa));
      if (r == 0)
        columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(bins_),
                                        filters.cols() + static_cast<Eigen::Index>(records_.size()));
      const auto own = static_cast<Eigen::Index>(readings_[r].size());
      // A thinned record may have one bin less than the full record. The last row is then repeated.
      for (Eigen::Index b = 0; b < own; ++b)
        columns.row(first + b).head(filters.cols()) = filters.row(std::min(b, filters.rows() - 1));
      for (Eigen::Index b = 0; b < own; ++b) {
        const double reading = readings_[r][static_cast<std::size_t>(b)];
        columns(first + b, filters.cols() + static_cast<Eigen::Index>(r)) = largest_kpa_;
        if (std::isfinite(reading) && columns.row(first + b).allFinite())
          target(first + b) = reading;
        else
          columns.row(first + b).setZero();
      }
      first += own;
    }
    constexpr double ridge = 1e-6;
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
    gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    gram.diagonal().array() += ridge * static_cast<double>(bins_) * largest_kpa_ * largest_kpa_;
    const Eigen::VectorXd weights =
        gram.selfadjointView<Eigen::Lower>().ldlt().solve(columns.transpose() * target);
    return target - columns * weights;
  }

 private:
  /// Returns the signals that the sensor can have seen behind the regulator, averaged over bins.
  [[nodiscard]] Eigen::MatrixXd seen(const Record& record, const std::vector<double>& drive_kpa) const {
    if (read_by_ == ReadBy::finger)
      return binned_filter_columns(record, drive_kpa, FilterKind::finger, largest_kpa_, bin_s_);
    const std::vector<double> means = binned(record, drive_kpa, bin_s_);
    return Eigen::Map<const Eigen::VectorXd>(means.data(), static_cast<Eigen::Index>(means.size()));
  }

  double largest_kpa_;
  ReadBy read_by_;
  double bin_s_ = 0.04;
  std::vector<Record> records_;
  Binned readings_;
  std::size_t bins_ = 0;
};

/// Search for the parameters of a regulator. The class provides the functions that descend() calls.
class RegulatorSearch {
 public:
  struct Point {
    Eigen::VectorXd t, left;  ///< `t`: coordinates of the search; `left`: residuals, followed by penalties
  };

  RegulatorSearch(const BinnedReadings& bank, double largest_kpa)
      : bank_(bank),
        largest_kpa_(largest_kpa),
        price_(std::sqrt(prior_share) *
               bank.left_by(regulator_at(Eigen::VectorXd::Zero(numbers), largest_kpa)).norm()) {}

  [[nodiscard]] Point at(const Eigen::VectorXd& t) const {
    const Eigen::VectorXd readings = bank_.left_by(regulator_at(t, largest_kpa_));
    Point point{t, Eigen::VectorXd(readings.size() + numbers)};
    point.left << readings, price_ * t;
    return point;
  }

  [[nodiscard]] static double loss(const Point& point) { return point.left.squaredNorm(); }

  [[nodiscard]] NormalEquations normal(const Point& point) const {
    Eigen::MatrixXd jacobian(point.left.size(), numbers);
    for (Eigen::Index k = 0; k < numbers; ++k) {
      Eigen::VectorXd beside = point.t;
      beside(k) += beside_by;
      jacobian.col(k) = (at(beside).left - point.left) / beside_by;
    }
    return {jacobian.transpose() * point.left, jacobian.transpose() * jacobian};
  }

  [[nodiscard]] static StepBounds bounds(const Point& point) {
    return {-largest_logarithm - point.t.array(), largest_logarithm - point.t.array()};
  }

  [[nodiscard]] Point moved(const Point& from, const Eigen::VectorXd& step) const {
    return at(from.t + step);
  }

 private:
  const BinnedReadings& bank_;
  double largest_kpa_;
  double price_;
};

}  // namespace

double leaking_kpa_per_s(double gauge_kpa) {
  return flow(gauge_kpa + atmosphere_kpa, atmosphere_kpa);
}

std::vector<double> regulated(const Regulator& regulator, const Record& record,
                              const std::vector<double>& command_kpa) {
  Walk walk(regulator, command_kpa.front());
  std::vector<double> out(command_kpa.size(), walk.gauge_kpa());
  const double unknown_kpa = supply_unknown * record.largest_kpa + atmosphere_kpa;
  for (std::size_t i = 1; i < out.size(); ++i) {
    const double supply_kpa = record.supply_kpa.empty() ? unknown_kpa : record.supply_kpa[i] + atmosphere_kpa;
    const double wanted = std::ceil(record.duration_s[i] / longest_step_s - 1e-6);
    const int steps = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_steps)));
    const double step_s = record.duration_s[i] / steps;
    for (int s = 0; s < steps; ++s) {
      const double part = record.held ? 0 : (s + 0.5) / steps;
      walk.step((1 - part) * command_kpa[i - 1] + part * command_kpa[i], supply_kpa, step_s);
    }
    out[i] = walk.gauge_kpa();
  }
  return out;
}

Record behind(const Regulator& regulator, const Record& record) {
  Record driven = record;
  driven.drive_kpa = regulated(regulator, record, record.drive_kpa);
  driven.held = false;
  return driven;
}

Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa, ReadBy read_by) {
  const BinnedReadings bank(records, largest_kpa, read_by);
  RegulatorSearch search(bank, largest_kpa);
  const auto end = descend(search, search.at(Eigen::VectorXd::Zero(numbers)),
                           {.most_steps = most_regulator_steps,
                            .most_trials = 4,
                            .longest_step = longest_move,
                            .least_share = least_progress,
                            .least_damping = 1.0 / numbers});
  return regulator_at(end.point.t, largest_kpa);
}

}  // namespace softgrip::sysid
