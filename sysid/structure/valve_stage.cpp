#include "sysid/structure/valve_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "model/two_way_lag.h"
#include "sysid/fitting/minimise.h"
#include "sysid/logs/input_smoothing.h"

namespace softgrip::sysid {
namespace {

using Segment = model::Segment<double>;

/// The search's numbers: the delay in tenths of a second by its magnitude, both lags by their logarithm.
ValveStage stage_at(std::span<const double> t) {
  ValveStage stage;
  stage.delay_s = std::min(0.1 * std::abs(t[0]), 5.0);
  stage.filling_s = std::clamp(std::exp(t[1]), 1e-4, 10.0);
  stage.venting_s = std::clamp(std::exp(t[2]), 1e-4, 10.0);
  return stage;
}

double first_finite(const std::vector<double>& values) {
  const auto found = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return found == values.end() ? 0 : *found;
}

struct Part {
  const Log& log;
  std::size_t fitted = 0;
};

/// Prediction minus measurement over the fitted part of every log; a missing measurement counts nothing.
void errors(const std::vector<Part>& parts, const ValveStage& stage, bool held, std::span<double> out) {
  std::size_t at = 0;
  for (const Part& part : parts) {
    const std::vector<double> p = predicted_pressure_kpa(stage, part.log, held);
    for (std::size_t i = 0; i < part.fitted; ++i) {
      const double error = p[i] - part.log.pressure_kpa[i];
      out[at++] = std::isfinite(error) ? error : 0;
    }
  }
}

double root_mean_square(const Log& log, const std::vector<double>& p, std::size_t first, std::size_t last,
                        double& sum, std::size_t& count) {
  for (std::size_t i = first; i < last; ++i) {
    const double error = p[i] - log.pressure_kpa[i];
    if (!std::isfinite(error)) continue;
    sum += error * error;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held) {
  const std::vector<double>& u = log.pressure_command_kpa;
  const Sampling sampling = sampling_of(log);
  model::TransportDelay<double> delay(std::array{stage.delay_s},
                                      {.sample_time_s = sampling.regular ? sampling.median_interval_s : 0});
  model::TwoWayLag<double> lag(stage.filling_s, stage.venting_s, 0);
  delay.reset(u.front());
  lag.reset(first_finite(log.pressure_kpa));
  std::vector<double> p(u.size(), lag.output());
  const auto walk = [&](double duration_s, double from, double to) {
    delay.step(Segment::straight(duration_s, from, to), {},
               [&](const Segment& s) { lag.step(s, [](const Segment&) {}); });
  };
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double dt = log.time_s[i] - log.time_s[i - 1];
    if (held) {
      if (i > 1) walk(0, u[i - 2], u[i - 1]);
      walk(dt, u[i - 1], u[i - 1]);
    } else {
      walk(dt, u[i - 1], u[i]);
    }
    p[i] = lag.output();
  }
  return p;
}

ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held) {
  std::vector<Part> parts;
  std::size_t samples = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low, noise = 0;
  for (const Log& log : logs) {
    parts.push_back({log, static_cast<std::size_t>(share * static_cast<double>(log.size()))});
    samples += parts.back().fitted;
    for (const double p : log.pressure_kpa) {
      if (!std::isfinite(p)) continue;
      low = std::min(low, p);
      high = std::max(high, p);
    }
    noise = std::max(noise, white_noise_of(log.time_s, log.pressure_kpa));
  }
  const auto residuals = [&](std::span<const double> t, std::span<double> r) {
    errors(parts, stage_at(t), held, r);
  };
  ValveStage best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::array<double, 3>& from :
       {std::array{0.2, std::log(0.1), std::log(0.2)}, std::array{1.0, std::log(0.05), std::log(0.1)},
        std::array{0.2, std::log(0.5), std::log(1.5)}}) {
    const PlainMinimum minimum = minimise_plain(residuals, samples, {from.begin(), from.end()});
    if (!(minimum.sum_of_squares < lowest)) continue;
    lowest = minimum.sum_of_squares;
    best = stage_at(minimum.p);
    best.converged = true;
  }
  double fitted = 0, rest = 0;
  std::size_t fitted_count = 0, rest_count = 0;
  for (const Part& part : parts) {
    const std::vector<double> p = predicted_pressure_kpa(best, part.log, held);
    best.rmse_kpa = root_mean_square(part.log, p, 0, part.fitted, fitted, fitted_count);
    best.held_out_rmse_kpa = root_mean_square(part.log, p, part.fitted, part.log.size(), rest, rest_count);
  }
  best.rmse_percent = high > low ? 100 * best.rmse_kpa / (high - low) : 0;
  best.noise_kpa = noise;
  return best;
}

model::Model with_valve(model::Model actuator, const ValveStage& stage) {
  actuator =
      model::with_block(std::move(actuator), {model::block_type<model::TransportDelay>(), {stage.delay_s}});
  return model::with_block(std::move(actuator), {model::block_type<model::AsymmetricValveLag>(),
                                                 {stage.filling_s, stage.venting_s}});
}

}  // namespace softgrip::sysid
