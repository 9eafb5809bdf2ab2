#include "sysid/fitting/separable.h"

#include <array>
#include <cmath>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"
#include "model/dual.h"
#include "model/exponential.h"
#include "model/named.h"
#include "sysid/fitting/hysteresis_step.h"

namespace softgrip::sysid {
namespace {

/// Rate k/c of a branch that consists of a dashpot without a spring [1/s]. The creep of such a branch never
/// settles, so its state begins at zero.
constexpr double without_spring_hz = 1e-30;

constexpr std::size_t most_branches = 8;

/// Response of a branch to a pressure segment of a given duration, and the derivatives of this response with
/// respect to the rate of the branch.
struct BranchWeights {
  double loss, begin, rise, bend;
  double loss_by_rate, begin_by_rate, rise_by_rate, bend_by_rate;
};

std::vector<BranchWeights> branch_weights(const std::vector<double>& durations,
                                          const std::vector<double>& rates, bool sensitivities) {
  using Number = model::Dual<double>;
  std::vector<BranchWeights> weights;
  weights.reserve(durations.size() * rates.size());
  for (const double duration : durations) {
    for (const double rate : rates) {
      if (!sensitivities) {
        const auto w = model::ExponentialWeights<double>::make(duration, rate, 1.0);
        weights.push_back({w.loss, w.end_begin, w.end_rise, w.end_bend, 0, 0, 0, 0});
        continue;
      }
      const auto w = model::ExponentialWeights<Number>::make(Number(duration), Number(rate, 1), Number(1.0));
      weights.push_back({w.loss.a, w.end_begin.a, w.end_rise.a, w.end_bend.a, w.loss.v, w.end_begin.v,
                         w.end_rise.v, w.end_bend.v});
    }
  }
  return weights;
}

/// State of a Kelvin-Voigt branch with unit damping and its derivatives. The equation is w' = p - r w with
/// pressure p and rate r.
struct Branch {
  double w = 0;
  double by_rate = 0;
  double by_lag = 0;
};

/// Collects rows in blocks and passes each full block to the function `sink`.
class Rows {
 public:
  Rows(Eigen::Index columns, SeparableRecord::Sink& sink)
      : block_(SeparableRecord::block_rows, columns), sink_(sink) {}

  [[nodiscard]] double* row() { return block_.data() + used_; }
  [[nodiscard]] static constexpr Eigen::Index stride() { return SeparableRecord::block_rows; }
  void next() {
    if (++used_ == block_.rows()) flush();
  }
  void flush() {
    if (used_ > 0) sink_.block(block_.topRows(used_));
    used_ = 0;
  }

 private:
  Eigen::MatrixXd block_;
  SeparableRecord::Sink& sink_;
  Eigen::Index used_ = 0;
};

/// Simulates one record. If Full is true, also computes the sensitivities.
template <bool Full>
class Walker {
 public:
  Walker(const Record& record, const SeparableColumns& columns, const SeparablePoint& point,
         std::size_t index, const PressureWalk& pressure, bool delayed, bool lagged,
         SeparableRecord::Sink& sink)
      : record_(record),
        c_(columns),
        point_(point),
        start_(point.starts[index]),
        pressure_(pressure),
        delayed_(delayed),
        lagged_(lagged),
        rates_{point.growing_per_kpa, point.shrinking_per_kpa},
        weights_(branch_weights(pressure.duration_s, point.rate_hz, Full)),
        rows_((Full ? columns.all() : columns.linear()) + 1, sink) {}

  void walk() {
    begin();
    std::size_t sample = 0;
    emit(sample++, 0);
    double last = pressure_.first_kpa;
    double last_by_lag = 0;
    for (const Stretch& s : pressure_.stretches) {
      advance_hysteresis(s, last, last_by_lag);
      advance_branches(s, last, last_by_lag);
      last = s.end_kpa;
      last_by_lag = s.end_by_lag;
      if (s.ends_sample) {
        kpa_ = last;
        by_lag_ = last_by_lag;
        emit(sample++, s.rate_kpa_per_s);
      }
    }
    rows_.flush();
  }

 private:
  void begin() {
    kpa_ = pressure_.first_kpa;
    const bool released = c_.has_start && start_.peak_before_kpa > kpa_;
    const double peak = released ? start_.peak_before_kpa : kpa_;
    step(hysteresis_, peak, 0, released ? 1 : 0, rates_);
    if (released) step(hysteresis_, kpa_ - peak, 0, -1, rates_);
    for (std::size_t b = 0; b < c_.branches; ++b) {
      const double rate = point_.rate_hz[b];
      if (!(rate > without_spring_hz)) continue;
      branches_[b].w = kpa_ / rate;
      branches_[b].by_rate = -kpa_ / (rate * rate);
    }
  }

  void advance_hysteresis(const Stretch& s, double last, double last_by_lag) {
    if (s.turn_kpa == s.turn_kpa) {
      move(s.turn_kpa - last, s.turn_by_lag - last_by_lag);
      move(s.end_kpa - s.turn_kpa, s.end_by_lag - s.turn_by_lag);
    } else {
      move(s.end_kpa - last, s.end_by_lag - last_by_lag);
    }
  }
  void move(double change, double change_by_lag) {
    if constexpr (Full) {
      if (change == 0 && change_by_lag == 0) return;
      step(hysteresis_, change, change_by_lag, 0, rates_);
    } else {
      if (change == 0) return;
      hysteresis_.g = stepped(hysteresis_.g, change, rates_);
    }
  }

  void advance_branches(const Stretch& s, double begin, double begin_by_lag) {
    const double rise = s.end_kpa - begin;
    const double bend = 6 * (s.mean_kpa - (begin + s.end_kpa) * 0.5);
    const double rise_by_lag = s.end_by_lag - begin_by_lag;
    const double bend_by_lag = 6 * (s.mean_by_lag - (begin_by_lag + s.end_by_lag) * 0.5);
    const BranchWeights* weights = &weights_[s.duration * c_.branches];
    for (std::size_t b = 0; b < c_.branches; ++b) {
      const BranchWeights& k = weights[b];
      Branch& branch = branches_[b];
      if constexpr (Full) {
        branch.by_rate += k.begin_by_rate * begin + k.rise_by_rate * rise + k.bend_by_rate * bend -
                          k.loss_by_rate * branch.w - k.loss * branch.by_rate;
        if (lagged_) {
          branch.by_lag +=
              k.begin * begin_by_lag + k.rise * rise_by_lag + k.bend * bend_by_lag - k.loss * branch.by_lag;
        }
      }
      branch.w += k.begin * begin + k.rise * rise + k.bend * bend - k.loss * branch.w;
    }
  }

  void emit(std::size_t sample, double rate_kpa_per_s) {
    const double reading = record_.reading_mm[sample];
    if (reading != reading) return;
    constexpr Eigen::Index stride = Rows::stride();
    double* const row = rows_.row();
    row[SeparableColumns::pressure() * stride] = kpa_;
    row[SeparableColumns::hysteresis() * stride] = -hysteresis_.g;
    double y = point_.instantaneous * kpa_ - point_.beta * hysteresis_.g;
    for (std::size_t b = 0; b < c_.branches; ++b) {
      row[c_.branch(b) * stride] = branches_[b].w;
      y += point_.amplitude[b] * branches_[b].w;
      if constexpr (Full) row[c_.rate(b) * stride] = point_.amplitude[b] * branches_[b].by_rate;
    }
    row[c_.offset() * stride] = 1;
    y += start_.offset_mm;
    if (c_.has_start) y += emit_start(row, record_.time_s[sample] - record_.time_s[0]);
    if constexpr (Full) {
      emit_sensitivities(row, rate_kpa_per_s);
      row[c_.all() * stride] = y - reading;
    } else {
      row[c_.linear() * stride] = reading;
    }
    rows_.next();
  }

  double emit_start(double* row, double t) {
    constexpr Eigen::Index stride = Rows::stride();
    double sum = 0;
    for (std::size_t b = 0; b < c_.branches; ++b) {
      const double decayed = std::exp(-point_.rate_hz[b] * t);
      const double unsettled = start_.unsettled_mm[b] * decayed;
      row[c_.unsettled(b) * stride] = decayed;
      sum += unsettled;
      if constexpr (Full) row[c_.rate(b) * stride] -= t * unsettled;
    }
    return sum;
  }

  void emit_sensitivities(double* row, double rate_kpa_per_s) {
    constexpr Eigen::Index stride = Rows::stride();
    row[c_.growing() * stride] = -point_.beta * hysteresis_.by_growing;
    row[c_.shrinking() * stride] = -point_.beta * hysteresis_.by_shrinking;
    double by_delay = 0;
    double by_lag = 0;
    if (delayed_) {
      // The output y comes from a time-invariant chain. A longer delay only shifts y in time, so dy/d(delay)
      // = -y'.
      const double g = hysteresis_.g;
      const double k = g * rate_kpa_per_s >= 0 ? rates_.growing : rates_.shrinking;
      by_delay = rate_kpa_per_s * (point_.instantaneous - point_.beta * (1 - k * std::abs(g)));
      for (std::size_t b = 0; b < c_.branches; ++b) {
        by_delay += point_.amplitude[b] * (kpa_ - point_.rate_hz[b] * branches_[b].w);
      }
    }
    if (lagged_) {
      by_lag = point_.instantaneous * by_lag_ - point_.beta * hysteresis_.by_lag;
      for (std::size_t b = 0; b < c_.branches; ++b) by_lag += point_.amplitude[b] * branches_[b].by_lag;
    }
    row[c_.delay() * stride] = -by_delay;
    row[c_.lag() * stride] = by_lag;
    if (c_.has_start) row[c_.peak() * stride] = -point_.beta * hysteresis_.by_peak;
  }

  const Record& record_;
  const SeparableColumns& c_;
  const SeparablePoint& point_;
  const StartState& start_;
  const PressureWalk& pressure_;
  bool delayed_;
  bool lagged_;
  HysteresisRates rates_;
  std::vector<BranchWeights> weights_;
  Rows rows_;
  double kpa_ = 0;
  double by_lag_ = 0;
  Hysteresis hysteresis_;
  std::array<Branch, most_branches> branches_{};
};

template <bool Full>
void walk(const Record& record, const SeparableShape& shape, const SeparableColumns& columns,
          const PressureWalk& still, const SeparablePoint& point, std::size_t index,
          SeparableRecord::Sink& sink) {
  const bool moves = point.delay_s > 0 || point.lag_s > 0;
  const PressureWalk own = moves ? walk_pressure(record, point.delay_s, point.lag_s) : PressureWalk{};
  const bool lagged = shape.lag && point.lag_s > 0;
  const bool delayed = shape.delay.has_value();
  Walker<Full>(record, columns, point, index, moves ? own : still, delayed, lagged, sink).walk();
}

}  // namespace

std::optional<SeparableShape> separable_shape(const model::Model& model) {
  SeparableShape shape;
  bool has_bouc_wen = false;
  bool has_kelvin_voigt = false;
  for (std::size_t i = 0; i < model.blocks.size(); ++i) {
    const model::BlockSpec& block = model.blocks[i];
    const std::vector<double>& values = block.values;
    if (model::is<model::TransportDelay>(block) && !shape.delay && !shape.lag) {
      shape.delay = i;
    } else if (model::is<model::ValveLag>(block) && !shape.lag) {
      shape.lag = i;
    } else if (model::is<model::BoucWen>(block) && !has_bouc_wen && values[4] == 1) {
      shape.bouc_wen = i;
      has_bouc_wen = true;
    } else if (model::is<model::KelvinVoigt>(block) && !has_kelvin_voigt) {
      shape.kelvin_voigt = i;
      shape.branches = (values.size() - 1) / 2;
      has_kelvin_voigt = true;
    } else {
      return std::nullopt;
    }
  }
  if (!has_bouc_wen || !has_kelvin_voigt || shape.branches > most_branches) return std::nullopt;
  return shape;
}

SeparablePoint to_separable(const SeparableShape& shape, const FitPoint& point) {
  const auto& blocks = point.model.blocks;
  const std::vector<double>& bw = blocks[shape.bouc_wen].values;
  const std::vector<double>& kv = blocks[shape.kelvin_voigt].values;
  SeparablePoint p;
  p.growing_per_kpa = bw[2] + bw[3];
  p.shrinking_per_kpa = bw[2] - bw[3];
  if (shape.delay) p.delay_s = blocks[*shape.delay].values[0];
  if (shape.lag) p.lag_s = blocks[*shape.lag].values[0];
  p.instantaneous = bw[0] + 1 / kv[0];
  p.beta = bw[1];
  for (std::size_t b = 0; b < shape.branches; ++b) {
    p.rate_hz.push_back(std::max(kv[1 + 2 * b] / kv[2 + 2 * b], without_spring_hz));
    p.amplitude.push_back(1 / kv[2 + 2 * b]);
  }
  p.starts = point.starts;
  return p;
}

SeparableRecord::SeparableRecord(const Record& record, const SeparableShape& shape)
    : record_(record),
      shape_(shape),
      columns_{shape.branches, record.start_unknown},
      still_(walk_pressure(record, 0, 0)) {}

void SeparableRecord::linear(const SeparablePoint& point, std::size_t index, Sink& sink) const {
  walk<false>(record_, shape_, columns_, still_, point, index, sink);
}

void SeparableRecord::full(const SeparablePoint& point, std::size_t index, Sink& sink) const {
  walk<true>(record_, shape_, columns_, still_, point, index, sink);
}

}  // namespace softgrip::sysid
