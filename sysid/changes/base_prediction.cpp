#include "sysid/changes/base_prediction.h"

#include <algorithm>
#include <functional>
#include <type_traits>

#include "base/thread_budget.h"
#include "model/catalogue.h"
#include "model/chain_walk.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/fitting/trajectory_walk.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

using model::Kind;
using Block = model::AnyBlock<double>;

template <class Any>
constexpr Kind kind_of = std::remove_cvref_t<Any>::info.kind;

double rested(Block& any, double input_mm) {
  double output_mm = input_mm;
  model::visit_block(any, [&](auto& block) {
    block.reset(input_mm);
    output_mm = block.output();
  });
  return output_mm;
}

double stepped(Block& any, const model::Segment<double>& in, const model::Surroundings& around) {
  double output_mm = in.end;
  model::visit_block(any, [&](auto& block) {
    if constexpr (kind_of<decltype(block)> == Kind::displacement) {
      block.step(in, around, [&](const model::Segment<double>& out) { output_mm = out.end; });
    } else if constexpr (kind_of<decltype(block)> == Kind::reading) {
      output_mm = block.sample(in.end, in.duration_s, around);
    }
  });
  return output_mm;
}

std::vector<double> plain_prediction(const model::Model& model, const std::optional<Regulator>& regulator,
                                     const Record& record, const StartState& start) {
  if (model.blocks.empty()) return without_model(regulator, record);
  StartState own = rest_starts(model, {record}).front();
  own.peak_before_kpa = start.peak_before_kpa;
  own.valley_before_kpa = start.valley_before_kpa;
  own.arrival_kpa_per_s = start.arrival_kpa_per_s;
  // If an additional block has added a creep branch, this branch is at equilibrium at the start of the
  // record.
  std::copy_n(start.unsettled_mm.begin(), std::min(start.unsettled_mm.size(), own.unsettled_mm.size()),
              own.unsettled_mm.begin());
  return predict(model, record, own);
}

std::vector<double> simulated_with(const Driven& driven, const std::vector<model::BlockSpec>& blocks) {
  model::Model model = driven.model;
  for (const model::BlockSpec& block : blocks) model = model::with_block(std::move(model), block);
  return plain_prediction(model, {}, driven.simulated, driven.start);
}

/// Returns the prediction of the baseline model plus the contribution of the filter bank, changed by the
/// blocks of an extension. A block that follows the model also acts on the contribution of the filter bank.
/// The model is simulated a second time only if a block changes the model or depends on the motion between
/// samples.
std::vector<double> extended_prediction(const Driven& driven, const std::vector<model::BlockSpec>& blocks) {
  std::vector<model::BlockSpec> within, behind;
  for (const model::BlockSpec& block : blocks) {
    const bool is_behind = !driven.model.blocks.empty() && block.type > driven.model.blocks.back().type;
    (is_behind ? behind : within).push_back(block);
  }
  std::stable_sort(behind.begin(), behind.end(),
                   [](const model::BlockSpec& a, const model::BlockSpec& b) { return a.type < b.type; });
  const std::vector<double> plain = within.empty() ? driven.plain : simulated_with(driven, within);
  std::vector<double> with_filters(plain.size());
  std::transform(plain.begin(), plain.end(), driven.filters.begin(), with_filters.begin(), std::plus());
  if (behind.empty()) return with_filters;
  with_filters = downstream(behind, driven.simulated, std::move(with_filters));
  if (is_downstream(behind, driven.model, driven.simulated)) return with_filters;
  // Some blocks depend on the motion between samples. For these blocks, the motion of the model between the
  // samples is simulated. The contribution of the filter bank is assumed to be linear between the samples.
  const std::vector<double> without_filters_mm = downstream(behind, driven.simulated, plain);
  std::vector<double> exact = simulated_with(driven, blocks);
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i] += with_filters[i] - without_filters_mm[i];
  return exact;
}

std::vector<double> driven_prediction(const Base& base, const Driven& driven, const Extension& extension) {
  end_if_cancelled();
  const Record& record = driven.record;
  std::vector<double> y = extended_prediction(driven, extension.chain);
  if (extension.crescent.share != 0) {
    const std::vector<double> loop = added_by(extension.crescent, record, base.largest_kpa);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += base.span_mm * loop[i];
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double warmer = record.temperature_c.empty() ? 0 : record.temperature_c[i] - base.temperature_c;
    y[i] *= extension.gain * (1 + (base.gain_per_c + extension.gain_per_c) * warmer);
  }
  if (extension.softening.share != 0) {
    const std::vector<double> factor = softened(extension.softening, record, base.largest_kpa);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= factor[i];
  }
  if (extension.lead_s > 0) y = leading_by(extension.lead_s, record, y);
  if (base.judged == Judged::pressure)
    y = pressure_behind(extension.line, extension.loss, record, std::move(y));
  return y;
}

/// Applies the valve blocks to the command. If the baseline model has a regulator, returns the output of this
/// regulator; otherwise returns the output of the valve blocks. The output of the valve blocks is not linear
/// between samples, so the regulator is simulated with 5 steps per sample.
std::vector<double> drive_of(const Base& base, const Record& record,
                             const std::vector<model::BlockSpec>& valve, const RegulatorFault& fault) {
  if (!base.regulator) return drive_behind(valve, record);
  Regulator regulator = *base.regulator;
  regulator.leak_per_s += fault.leak_per_s;
  regulator.tube_per_s *= 1 - fault.blocked;
  if (valve.empty()) return regulated(regulator, record, record.drive_kpa);
  constexpr std::size_t parts = 5;
  Record fine = finer_record(record, parts);
  fine.drive_kpa = drive_behind(valve, fine);
  fine.held = false;
  fine.drive_kpa = regulated(regulator, fine, fine.drive_kpa);
  std::vector<double> drive_kpa(record.size());
  for (std::size_t i = 0; i < drive_kpa.size(); ++i) drive_kpa[i] = fine.drive_kpa[i * parts];
  return drive_kpa;
}

/// Returns the record without the contribution of the filter bank to its readings.
Record without_filters(const Driven& driven) {
  Record record = driven.simulated;
  for (std::size_t i = 0; i < record.size(); ++i)
    record.reading_mm[i] -= driven.filters(static_cast<Eigen::Index>(i));
  return record;
}

}  // namespace

bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                   const Record& record) {
  if (record.held || record.start_unknown || base.blocks.empty()) return false;
  std::size_t before = base.blocks.back().type;
  return std::all_of(blocks.begin(), blocks.end(), [&](const model::BlockSpec& block) {
    const bool behind = block.type > before;
    before = block.type;
    return behind && model::catalogue()[block.type].at_samples;
  });
}

std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks, const Record& record,
                               std::vector<double> base_mm) {
  for (const model::BlockSpec& spec : blocks) {
    Block block = model::walk::make_block<double>(spec.type, spec.values, {record.sample_time_s, 0});
    double last_mm = base_mm.front();
    base_mm.front() = rested(block, last_mm);
    for (std::size_t i = 1; i < base_mm.size(); ++i) {
      const double now_mm = base_mm[i];
      const auto in = model::Segment<double>::straight(record.duration_s[i], last_mm, now_mm);
      base_mm[i] = stepped(block, in, surroundings_at(record, i));
      last_mm = now_mm;
    }
  }
  return base_mm;
}

std::vector<double> without_model(const std::optional<Regulator>& regulator, const Record& driven) {
  return regulator ? driven.drive_kpa : std::vector<double>(driven.size(), 0.0);
}

StartState start_of(const model::Model& model, const Record& record) {
  if (model.blocks.empty()) return {};
  StartState start = estimated_start(model, record);
  start.offset_mm = 0;
  return start;
}

Driven driven_by(const Base& base, const Record& record, const Extension& extension,
                 const StartState* start) {
  const std::vector<model::BlockSpec>& valve = extension.valve;
  Driven driven{record, {}, base.model, {}, {}, {}};
  if (base.regulator || !valve.empty()) {
    driven.record.drive_kpa = drive_of(base, record, valve, extension.fault);
    driven.record.held = false;
  }
  const bool whole_is_simulated =
      base.drive == Drive::command && !base.regulator && !base.model.blocks.empty();
  const auto whole = whole_is_simulated ? with_valve(base.model, valve) : std::nullopt;
  if (whole) driven.model = *whole;
  driven.simulated = whole ? record : driven.record;
  if (const Load& load = extension.load; load != Load{}) {
    for (Record* const each : {&driven.record, &driven.simulated}) {
      for (double& p : each->drive_kpa) p = load.factor * p - load.weight_kpa;
    }
  }
  driven.filters = base.filter_weights.size() == 0
                       ? Eigen::VectorXd(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(record.size())))
                       : weighted_filters(driven.record, driven.record.drive_kpa, base.kind, base.largest_kpa,
                                          base.filter_weights);
  driven.start = start != nullptr ? *start : start_of(driven.model, without_filters(driven));
  driven.plain = plain_prediction(driven.model, base.regulator, driven.simulated, driven.start);
  return driven;
}

std::vector<double> predict_base(const Base& base, const Record& record, const Extension& extension,
                                 const Driven* driven) {
  if (driven != nullptr && extension.valve.empty() && extension.fault == RegulatorFault{} &&
      extension.load == Load{})
    return driven_prediction(base, *driven, extension);
  const StartState* const start = driven != nullptr ? &driven->start : nullptr;
  return driven_prediction(base, driven_by(base, record, extension, start), extension);
}

std::vector<std::vector<double>> residuals_of(const Base& base, const std::vector<Record>& records) {
  std::vector<std::vector<double>> left;
  left.reserve(records.size());
  for (const Record& record : records) left.push_back(residual(record, predict_base(base, record, {})));
  return left;
}

}  // namespace softgrip::sysid
