#include "library/include/softgrip/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "document/node.h"
#include "document/problem.h"
#include "library/include/softgrip/control.h"
#include "library/model_parts.h"
#include "model/chain.h"
#include "model/file/model_file.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip {
namespace {

/// Largest permitted difference between a time step and the mean time step, as a share of the mean time step.
constexpr double most_jitter = 1e-6;
/// Shortest and longest time step that an inverse permits [s].
constexpr double shortest_step_s = 1e-4;
constexpr double longest_step_s = 1;

}  // namespace

namespace library {

Model wrapped(model::Model model) {
  return Model(std::make_shared<const Model::Parts>(Model::Parts{std::move(model)}));
}

model::OutputUnit unit_of(Unit unit) noexcept {
  return unit == Unit::deg ? model::OutputUnit::deg : model::OutputUnit::mm;
}

Unit unit_of(model::OutputUnit unit) noexcept {
  return unit == model::OutputUnit::deg ? Unit::deg : Unit::mm;
}

std::string in_brackets(model::OutputUnit unit) {
  return std::string(model::name_of(unit));
}

std::string unknown_parameter(const model::Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i)
    names.push_back(model::parameter_path(model, i));
  const std::string near = document::nearest(name, names);
  return "the model has no parameter '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?");
}

}  // namespace library

std::string name_of(Unit unit) {
  return std::string(model::name_of(library::unit_of(unit)));
}

Model::Model(std::shared_ptr<const Parts> parts) noexcept : parts_(std::move(parts)) {}

Model Model::load(const std::string& path) {
  document::Problems problems;
  auto model = model::load_model(path, problems);
  if (!model) library::refuse(problems);
  return library::wrapped(*std::move(model));
}

Model Model::parse(const std::string& yaml, const std::string& name) {
  document::Problems problems;
  const document::Document document = document::parse(name, yaml, problems);
  auto model = problems.empty() ? model::read_model(document, problems) : std::nullopt;
  if (!model) library::refuse(problems);
  return library::wrapped(*std::move(model));
}

void Model::save(const std::string& path) const {
  if (const auto written = write_file(path, yaml()); !written) throw FileError(written.error());
}

std::string Model::yaml() const {
  return model::to_yaml(parts_->value);
}

const std::string& Model::name() const noexcept {
  return parts_->value.name;
}

const std::string& Model::source() const noexcept {
  return parts_->value.source;
}

std::string Model::hash() const {
  return model::model_hash(parts_->value);
}

Unit Model::unit() const noexcept {
  return library::unit_of(parts_->value.output_unit);
}

std::vector<Parameter> Model::parameters() const {
  const model::Model& model = parts_->value;
  const std::vector<double> values = model::flat_values(model);
  std::vector<Parameter> all;
  all.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const model::ParameterSpec& spec = model::parameter_spec(model, i);
    all.push_back({model::parameter_path(model, i), values[i],
                   model::in_unit(std::string(spec.unit), model.output_unit), spec.lower, spec.upper,
                   model::in_unit(std::string(spec.meaning), model.output_unit)});
  }
  return all;
}

Model Model::with(const std::string& parameter, double value) const {
  const model::Model& model = parts_->value;
  const auto place = model::find_path(model, parameter);
  if (!place) throw InvalidArgument("parameter", library::unknown_parameter(model, parameter));
  const model::ParameterSpec& spec = model::parameter_spec(model, *place);
  library::require_between("value", value, spec.lower, spec.upper,
                           model::in_unit(std::string(spec.unit), model.output_unit));
  std::vector<double> values = model::flat_values(model);
  values[*place] = value;
  model::Model changed = model::with_values(model, values);
  if (const auto problems = model::validate(changed); !problems.empty())
    throw InvalidArgument("value", problems.front());
  return library::wrapped(std::move(changed));
}

std::vector<double> Model::simulate(std::span<const double> time_s, std::span<const double> pressure_kpa,
                                    const SimulateOptions& options) const {
  const model::Model& model = parts_->value;
  library::require_times("time_s", time_s, 1);
  library::require_size("pressure_kpa", pressure_kpa.size(), time_s.size(), "kPa");
  library::require_finite("pressure_kpa", pressure_kpa, "kPa");
  library::require_between("noise", options.noise, 0, std::numeric_limits<double>::max(),
                           library::in_brackets(model.output_unit));
  sysid::Log log;
  log.time_s.assign(time_s.begin(), time_s.end());
  log.pressure_command_kpa.assign(pressure_kpa.begin(), pressure_kpa.end());
  const auto surroundings = [&](const char* name, std::span<const double> values, const char* unit,
                                std::vector<double>& into) {
    if (values.empty()) return;
    library::require_size(name, values.size(), time_s.size(), unit);
    library::require_finite(name, values, unit);
    into.assign(values.begin(), values.end());
  };
  surroundings("supply_kpa", options.supply_kpa, "kPa", log.supply_kpa);
  surroundings("temperature_c", options.temperature_c, "degrees Celsius", log.temperature_c);
  sysid::simulate(model, {options.noise, options.seed, options.held}, log);
  return std::move(log.displacement_mm);
}

Inverse Model::inverse(std::span<const double> time_s, std::span<const double> displacement,
                       const InverseOptions& options) const {
  const std::string unit = library::in_brackets(parts_->value.output_unit);
  library::require_times("time_s", time_s, 2);
  library::require_size("displacement", displacement.size(), time_s.size(), unit);
  library::require_finite("displacement", displacement, unit);
  const double tick_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  if (tick_s < shortest_step_s || tick_s > longest_step_s)
    throw InvalidArgument("time_s", "steps of " + shortest(tick_s) +
                                        " s between samples; the inverse of a model requires steps of " +
                                        written(shortest_step_s) + " to " + written(longest_step_s) + " s");
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (std::abs(time_s[i] - time_s[i - 1] - tick_s) > most_jitter * tick_s + 1e-12 * std::abs(time_s[i]))
      throw InvalidArgument(
          "time_s", "the time steps differ, but the inverse of a model requires equal time steps (in s)");
  }
  Limits limits;
  limits.pressure_min_kpa = options.pressure_min_kpa;
  limits.pressure_max_kpa = options.pressure_max_kpa;
  limits.slew_up_kpa_per_s = options.slew_up_kpa_per_s;
  limits.slew_down_kpa_per_s = options.slew_down_kpa_per_s;
  limits.rest_kpa = options.start_kpa;
  library::checked(limits);
  library::require_between("start_kpa", options.start_kpa, options.pressure_min_kpa, options.pressure_max_kpa,
                           "kPa");
  Feedforward feedforward(*this, limits, tick_s);
  // Computes the reference at the time preview_s() after a sample. The reference is linear between samples,
  // and constant after the last sample.
  const double ahead = feedforward.preview_s() / tick_s;
  const auto whole = static_cast<std::size_t>(ahead);
  const double part = ahead - static_cast<double>(whole);
  const auto value = [&](std::size_t i) { return displacement[std::min(i, displacement.size() - 1)]; };
  const auto reference = [&](std::size_t i) {
    return value(i + whole) + part * (value(i + whole + 1) - value(i + whole));
  };
  feedforward.start(options.start_kpa, reference(0));
  Inverse result;
  result.pressure_kpa.reserve(time_s.size());
  result.out_of_reach.reserve(time_s.size());
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const FeedforwardStep step = feedforward.step(reference(i));
    result.pressure_kpa.push_back(step.pressure_kpa);
    result.out_of_reach.push_back(step.out_of_reach ? 1 : 0);
  }
  return result;
}

struct Simulator::Parts {
  model::Chain<double> chain;
};

Simulator::Simulator(const Model& model, double sample_time_s, std::uint64_t seed) {
  if (sample_time_s != 0)
    library::require_between("sample_time_s", sample_time_s, library::shortest_simulated_step_s,
                             std::numeric_limits<double>::max(), "s");
  parts_ = std::make_unique<Parts>(Parts{model::Chain<double>(model.parts().value, {}, sample_time_s, seed)});
  parts_->chain.reset(0);
}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&& other) noexcept = default;
Simulator& Simulator::operator=(Simulator&& other) noexcept = default;

void Simulator::reset(double pressure_kpa) noexcept {
  if (std::isfinite(pressure_kpa)) parts_->chain.reset(pressure_kpa);
}

double Simulator::step(double duration_s, double pressure_kpa) noexcept {
  if (!std::isfinite(duration_s) || duration_s < 0 || !std::isfinite(pressure_kpa))
    return std::numeric_limits<double>::quiet_NaN();
  return parts_->chain.step(duration_s, pressure_kpa);
}

}  // namespace softgrip
