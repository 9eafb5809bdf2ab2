#include "sysid/structure/valve_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/numbers.h"
#include "base/parallel.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/leak.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/supply_sag.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/line_loss.h"
#include "model/named.h"
#include "model/play.h"
#include "model/two_way_lag.h"
#include "sysid/fitting/minimise.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/input_smoothing.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {
namespace {

using Segment = model::Segment<double>;

double first_finite(const std::vector<double>& values) {
  const auto found = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return found == values.end() ? 0 : *found;
}

/// Lowest and highest measured pressure and highest supply pressure in the logs [kPa], and the times of the
/// logs.
struct Scene {
  double lowest_kpa = std::numeric_limits<double>::infinity();
  double highest_kpa = -lowest_kpa;
  double highest_supply_kpa = 0;
  double unit_s = 1;                                            ///< result of time_unit_s()
  double interval_s = std::numeric_limits<double>::infinity();  ///< smallest mean interval between samples
  double length_s = 0;                                          ///< length of the longest log

  // The limits of a search are multiples of the unit of time. A log that permits slower or faster valves
  // widens them. 1e3 s and 1e4 s are the limits of the blocks.
  [[nodiscard]] double most_delay_s() const { return std::min(std::max(5 * unit_s, 0.25 * length_s), 1e3); }
  [[nodiscard]] double most_lag_s() const { return std::min(std::max(10 * unit_s, 0.5 * length_s), 1e4); }
  [[nodiscard]] double least_lag_s() const { return std::min(1e-4 * unit_s, 0.1 * interval_s); }
  /// Smallest start value of a time constant [s].
  [[nodiscard]] double least_start_s() const { return std::min(1e-3 * unit_s, interval_s); }
};

/// Writes the times of the logs to the scene.
void add_times(const std::vector<Log>& logs, Scene& scene) {
  for (const Log& log : logs) {
    if (log.size() < 2) continue;
    const double length_s = log.time_s.back() - log.time_s.front();
    scene.interval_s = std::min(scene.interval_s, length_s / static_cast<double>(log.size() - 1));
    scene.length_s = std::max(scene.length_s, length_s);
  }
  scene.unit_s = time_unit_s(step_duration_s(scene.interval_s), scene.length_s);
}

Scene scene_of(const std::vector<Log>& logs) {
  Scene scene;
  for (const Log& log : logs) {
    for (const double p : log.pressure_kpa) {
      if (!std::isfinite(p)) continue;
      scene.lowest_kpa = std::min(scene.lowest_kpa, p);
      scene.highest_kpa = std::max(scene.highest_kpa, p);
    }
    for (const double s : log.supply_kpa) {
      if (std::isfinite(s)) scene.highest_supply_kpa = std::max(scene.highest_supply_kpa, s);
    }
  }
  add_times(logs, scene);
  return scene;
}

/// Converts the parameters of a valve to coordinates of the search, which have a magnitude of about 1. The
/// delay [0.1 units of time], the dead band [kPa] and the share of the leak are the absolute values of their
/// coordinates. The coordinate of a lag is the logarithm of its time constant. The coordinate of the limit is
/// in units of 10 % of the highest pressure.
class Coordinates {
 public:
  Coordinates(ValveParts parts, const Scene& scene) : parts_(parts), scene_(scene) {}

  [[nodiscard]] ValveStage stage_at(std::span<const double> t) const {
    ValveStage stage;
    std::size_t at = 0;
    if (has(ValvePart::delay))
      stage.delay_s = std::min(0.1 * scene_.unit_s * std::abs(t[at++]), scene_.most_delay_s());
    if (has(ValvePart::dead_band)) stage.band_kpa = std::abs(t[at++]);
    if (has(ValvePart::lag)) stage.filling_s = stage.venting_s = time_constant_s(t[at++]);
    if (has(ValvePart::two_ways)) stage.venting_s = time_constant_s(t[at++]);
    stage.nominal_supply_kpa = scene_.highest_supply_kpa;
    if (has(ValvePart::supply_sag)) stage.coupling = std::clamp(t[at++], 0.0, 1.0);
    if (has(ValvePart::limit)) stage.limit_kpa = 0.1 * scene_.highest_kpa * t[at++];
    if (has(ValvePart::second_lag)) stage.second_s = time_constant_s(t[at++]);
    if (has(ValvePart::leak)) stage.leak_share = std::abs(t[at++]);
    return stage;
  }

  [[nodiscard]] std::vector<double> at(const ValveStage& stage) const {
    std::vector<double> t;
    const auto logarithm = [&](double time_constant_s) {
      return std::log(std::max(time_constant_s, scene_.least_start_s()));
    };
    if (has(ValvePart::delay)) t.push_back(std::max(10 * stage.delay_s / scene_.unit_s, 0.05));
    if (has(ValvePart::dead_band)) t.push_back(std::max(stage.band_kpa, 0.01 * scene_.highest_kpa));
    if (has(ValvePart::lag)) t.push_back(logarithm(stage.filling_s));
    if (has(ValvePart::two_ways)) t.push_back(logarithm(stage.venting_s));
    if (has(ValvePart::supply_sag)) t.push_back(std::max(stage.coupling, 0.1));
    if (has(ValvePart::limit))
      t.push_back(std::isfinite(stage.limit_kpa) ? 10 * stage.limit_kpa / scene_.highest_kpa : 9.8);
    if (has(ValvePart::second_lag)) t.push_back(logarithm(stage.second_s));
    if (has(ValvePart::leak)) t.push_back(std::max(stage.leak_share, 0.01));
    return t;
  }

 private:
  [[nodiscard]] double time_constant_s(double t) const {
    return std::clamp(std::exp(t), scene_.least_lag_s(), scene_.most_lag_s());
  }
  [[nodiscard]] bool has(ValvePart part) const { return parts_.test(index_of(part)); }

  ValveParts parts_;
  const Scene& scene_;
};

/// Returns the predicted measured pressure of a log [kPa].
/// @param sample_time_s  sampling time of the log; 0: the sampling is irregular.
std::vector<double> predicted(const ValveStage& stage, const Log& log, bool held, double sample_time_s) {
  const std::vector<double>& u = log.pressure_command_kpa;
  model::TransportDelay<double> delay(std::array{stage.delay_s}, {.sample_time_s = sample_time_s});
  model::Play<double> dead_band(stage.band_kpa / 2);
  model::TwoWayLag<double> lag(stage.filling_s, stage.venting_s, 0),
      second(stage.second_s, stage.second_s, 0);
  delay.reset(u.front());
  const double first_kpa = first_finite(log.pressure_kpa);
  // The initial state of the dead band is computed from the first measured pressure and the first command.
  dead_band.reset(first_kpa + stage.band_kpa / 2);
  dead_band.settle(u.front());
  lag.reset(first_kpa);
  second.reset(first_kpa);
  const auto behind = [&](const Segment& s) {
    lag.step(s, [&](const Segment& lagged) { second.step(lagged, [](const Segment&) {}); });
  };
  const auto walk = [&](double duration_s, double from, double to) {
    delay.step(Segment::straight(duration_s, from, to), {}, [&](const Segment& s) {
      if (stage.band_kpa > 0) {
        dead_band.step(s, behind);
      } else {
        behind(s);
      }
    });
  };
  const model::LineLoss<double> leak{stage.leak_share};
  const auto shown = [&](std::size_t i) {
    double p = second.output();
    if (stage.coupling > 0)
      p *= 1 - stage.coupling * std::max(0.0, 1 - log.supply_kpa[i] / stage.nominal_supply_kpa);
    p = std::min(p, stage.limit_kpa);
    if (stage.leak_share > 0) p = leak.behind(p);
    return stage.gauge_gain * p + stage.gauge_zero_kpa;
  };
  std::vector<double> p(u.size());
  p.front() = shown(0);
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double dt = log.time_s[i] - log.time_s[i - 1];
    if (held) {
      if (i > 1) walk(0, u[i - 2], u[i - 1]);
      walk(dt, u[i - 1], u[i - 1]);
    } else {
      walk(dt, u[i - 1], u[i]);
    }
    p[i] = shown(i);
  }
  return p;
}

/// Computes the residuals of all logs. A residual is the prediction minus the measurement; it is 0 if the
/// measurement is missing or excluded.
class Errors {
 public:
  Errors(const std::vector<Log>& logs, const ValveFit& fit) : logs_(logs), fit_(fit) {
    for (const Log& log : logs) {
      count_ += log.size();
      sample_time_s_.push_back(sampling_of(log).sample_time_s());
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Computes the residuals. If parameters of the pressure sensor are fitted, the function writes their
  /// values to the stage.
  void evaluate(ValveStage& stage, std::span<double> out) const {
    const std::vector<std::vector<double>> p = predicted_by(stage);
    if (fit_.sensor != PressureSensorFit::nothing) read_gauge(p, stage);
    std::size_t at = 0;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      for (std::size_t i = 0; i < logs_[k].size(); ++i) {
        const double error = stage.gauge_gain * p[k][i] + stage.gauge_zero_kpa - logs_[k].pressure_kpa[i];
        out[at++] = counts(k, i) && std::isfinite(error) ? error : 0;
      }
    }
  }

  /// Returns the RMSE of the fitted samples [kPa]. If `fitted` is false, returns the RMSE of the samples that
  /// were not fitted.
  [[nodiscard]] double rmse_kpa(const ValveStage& stage, bool fitted) const {
    double sum = 0;
    std::size_t used = 0;
    const std::vector<std::vector<double>> p = predicted_by(stage);
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      for (std::size_t i = 0; i < p[k].size(); ++i) {
        const double error = p[k][i] - logs_[k].pressure_kpa[i];
        if (counts(k, i) != fitted || !std::isfinite(error)) continue;
        sum += error * error;
        ++used;
      }
    }
    return used == 0 ? 0 : std::sqrt(sum / static_cast<double>(used));
  }

 private:
  /// Returns the predicted measured pressure of each log [kPa].
  [[nodiscard]] std::vector<std::vector<double>> predicted_by(const ValveStage& stage) const {
    std::vector<std::vector<double>> p;
    for (std::size_t k = 0; k < logs_.size(); ++k)
      p.push_back(predicted(stage, logs_[k], fit_.held, sample_time_s_[k]));
    return p;
  }

  [[nodiscard]] bool counts(std::size_t log, std::size_t sample) const {
    return !fit_.is_fitted || fit_.is_fitted(log, sample);
  }

  /// Fits the parameters of the pressure sensor by linear regression of the measured pressure on the
  /// predicted pressure. The parameters are the zero offset, or the gain and the zero offset.
  void read_gauge(const std::vector<std::vector<double>>& predicted, ValveStage& stage) const {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      for (std::size_t i = 0; i < predicted[k].size(); ++i) {
        const double from = predicted[k][i], to = logs_[k].pressure_kpa[i];
        if (!counts(k, i) || !std::isfinite(to)) continue;
        n += 1, x += from, y += to, xx += from * from, xy += from * to;
      }
    }
    const double spread = n * xx - x * x;
    if (!(spread > 0)) return;
    if (fit_.sensor == PressureSensorFit::gain_and_zero) stage.gauge_gain = (n * xy - x * y) / spread;
    stage.gauge_zero_kpa = (y - stage.gauge_gain * x) / n;
  }

  const std::vector<Log>& logs_;
  const ValveFit& fit_;
  std::size_t count_ = 0;
  std::vector<double> sample_time_s_;  ///< sampling time of each log
};

ValveStage start_at(double delay_s, double filling_s, double venting_s) {
  ValveStage start;
  start.delay_s = delay_s;
  start.filling_s = filling_s;
  start.venting_s = venting_s;
  return start;
}

/// Returns the start points of the search: those in `fit.from`, or three default points.
std::vector<ValveStage> starts_of(const ValveFit& fit, const Scene& scene) {
  if (!fit.from.empty()) return fit.from;
  std::vector<ValveStage> starts;
  for (const auto& [delay, filling, venting] :
       {std::array{0.02, 0.1, 0.2}, std::array{0.1, 0.05, 0.1}, std::array{0.02, 0.5, 1.5}})
    starts.push_back(start_at(delay * scene.unit_s, filling * scene.unit_s, venting * scene.unit_s));
  return starts;
}

/// Returns start points for valves of any speed that the logs can show. The time constants are powers of 10
/// of the sampling interval, up to the largest time constant.
std::vector<ValveStage> starts_of_any_speed(const Scene& scene) {
  std::vector<ValveStage> starts;
  for (double lag_s = scene.interval_s; lag_s < scene.most_lag_s(); lag_s *= 10)
    starts.push_back(start_at(0.2 * lag_s, lag_s, lag_s));
  return starts;
}

/// Returns the names of the fitted times that are at the upper limit of the search, with their values. A lag
/// at the lower limit is no longer than 10 % of a sampling interval, so it has no effect.
std::vector<std::string> limits_reached(const ValveStage& stage, ValveParts parts, const Scene& scene) {
  std::vector<std::string> reached;
  const auto add = [&](ValvePart part, const char* name, double value_s, double most_s) {
    if (parts.test(index_of(part)) && value_s >= most_s)
      reached.push_back(std::string(name) + " of " + significant(value_s, 3) + " s");
  };
  add(ValvePart::delay, "dead time", stage.delay_s, scene.most_delay_s());
  add(ValvePart::lag, "lag during filling", stage.filling_s, scene.most_lag_s());
  add(ValvePart::two_ways, "lag during venting", stage.venting_s, scene.most_lag_s());
  add(ValvePart::second_lag, "second lag", stage.second_s, scene.most_lag_s());
  return reached;
}

}  // namespace

double pressure_noise_kpa(const std::vector<Log>& logs) {
  double noise_kpa = 0;
  for (const Log& log : logs) noise_kpa = std::max(noise_kpa, white_noise_of(log.time_s, log.pressure_kpa));
  return noise_kpa;
}

std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held) {
  return predicted(stage, log, held, sampling_of(log).sample_time_s());
}

ValveStage fit_valve_stage(const std::vector<Log>& logs, const ValveFit& fit) {
  const Scene scene = scene_of(logs);
  const Coordinates coordinates(fit.parts, scene);
  const Errors errors(logs, fit);
  const auto residuals = [&](std::span<const double> t, std::span<double> r) {
    ValveStage stage = coordinates.stage_at(t);
    errors.evaluate(stage, r);
  };
  const double range_kpa = scene.highest_kpa - scene.lowest_kpa;
  const auto best_from = [&](const std::vector<ValveStage>& starts) {
    std::vector<PlainMinimum> minima(starts.size());
    parallel_for_idle(starts.size(), [&](std::size_t i) {
      minima[i] = minimise_plain(residuals, errors.count(), coordinates.at(starts[i]), fit.tolerance);
    });
    ValveStage best;
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<double> r(errors.count());
    for (const PlainMinimum& minimum : minima) {
      if (!(minimum.sum_of_squares < lowest)) continue;
      lowest = minimum.sum_of_squares;
      best = coordinates.stage_at(minimum.p);
      errors.evaluate(best, r);
      best.converged = true;
    }
    best.rmse_kpa = errors.rmse_kpa(best, true);
    best.held_out_rmse_kpa = errors.rmse_kpa(best, false);
    best.rmse_percent = range_kpa > 0 ? 100 * best.rmse_kpa / range_kpa : 0;
    best.limits_reached = limits_reached(best, fit.parts, scene);
    return best;
  };
  ValveStage best = best_from(starts_of(fit, scene));
  // The default start points are those of a usual valve. From there, the search for a much faster or slower
  // valve can end in a local minimum.
  if (fit.from.empty() && (best.is_far_off() || !best.limits_reached.empty())) {
    ValveStage other = best_from(starts_of_any_speed(scene));
    if (other.rmse_kpa < (1 - limits::negligible_share) * best.rmse_kpa) best = std::move(other);
  }
  return best;
}

ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held) {
  ValveFit fit;
  fit.held = held;
  fit.is_fitted = [&](std::size_t log, std::size_t sample) {
    return sample < static_cast<std::size_t>(share * static_cast<double>(logs[log].size()));
  };
  return fit_valve_stage(logs, fit);
}

model::Model with_valve(model::Model actuator, const ValveStage& stage) {
  const auto add = [&](std::size_t type, std::vector<double> values) {
    actuator = model::with_block(std::move(actuator), {type, std::move(values)});
  };
  add(model::block_type<model::TransportDelay>(), {stage.delay_s});
  if (stage.band_kpa > 0) add(model::block_type<model::ValveDeadband>(), {stage.band_kpa});
  if (stage.second_s > 0) add(model::block_type<model::ValveLag>(), {stage.second_s});
  add(model::block_type<model::AsymmetricValveLag>(), {stage.filling_s, stage.venting_s});
  if (stage.coupling > 0)
    add(model::block_type<model::SupplySag>(), {stage.coupling, stage.nominal_supply_kpa});
  if (std::isfinite(stage.limit_kpa)) add(model::block_type<model::PressureSaturation>(), {stage.limit_kpa});
  if (stage.leak_share > 0) add(model::block_type<model::Leak>(), {stage.leak_share});
  return actuator;
}

}  // namespace softgrip::sysid
