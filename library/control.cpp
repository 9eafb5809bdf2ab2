#include "library/include/softgrip/control.h"

#include <cmath>
#include <limits>

#include "control/elements/limits.h"
#include "control/elements/pid.h"
#include "control/elements/reference.h"
#include "control/feedforward/feedforward_kinds.h"
#include "control/feedforward/invertibility.h"
#include "control/feedforward/running_model.h"
#include "control/tick/channel_controller.h"
#include "control/tick/settings.h"
#include "library/model_parts.h"

namespace softgrip {
namespace {

constexpr double longest_tick_s = 1;
constexpr double shortest_tick_s = 1e-4;

control::FeedforwardKind kind_of(FeedforwardKind kind) {
  switch (kind) {
    case FeedforwardKind::none:
      return control::FeedforwardKind::none;
    case FeedforwardKind::bouc_wen:
      return control::FeedforwardKind::bouc_wen;
    case FeedforwardKind::full_model:
      return control::FeedforwardKind::full_model;
  }
  throw InvalidArgument("kind", "not a FeedforwardKind");
}

control::AntiWindup anti_windup_of(AntiWindup method) {
  switch (method) {
    case AntiWindup::none:
      return control::AntiWindup::none;
    case AntiWindup::conditional:
      return control::AntiWindup::conditional;
    case AntiWindup::back_calculation:
      return control::AntiWindup::back_calculation;
  }
  throw InvalidArgument("anti_windup", "not an AntiWindup");
}

control::PidSettings checked_pid(const PidSettings& pid) {
  constexpr double most = 1e9;
  library::require_between("kp_kpa_per_mm", pid.kp_kpa_per_mm, -most, most, "kPa/mm");
  library::require_between("ki_kpa_per_mm_s", pid.ki_kpa_per_mm_s, -most, most, "kPa/(mm s)");
  library::require_between("kd_kpa_s_per_mm", pid.kd_kpa_s_per_mm, -most, most, "kPa s/mm");
  library::require_between("derivative_filter_s", pid.derivative_filter_s, 0, most, "s");
  library::require_between("setpoint_weight", pid.setpoint_weight, 0, 1, "");
  library::require_positive("tracking_time_s", pid.tracking_time_s, "s");
  return {pid.kp_kpa_per_mm,       pid.ki_kpa_per_mm_s, pid.kd_kpa_s_per_mm,
          pid.derivative_filter_s, pid.setpoint_weight, anti_windup_of(pid.anti_windup),
          pid.tracking_time_s};
}

void require_usable(const Model& model, const control::FeedforwardSettings& settings,
                    const control::LimitSettings& limits, double tick_s) {
  if (const auto accepted = control::check_feedforward(model.parts().value, settings, limits, tick_s);
      !accepted)
    throw Refused(accepted.error().with_advice());
}

}  // namespace

namespace library {

control::LimitSettings settings_of(const Limits& limits) noexcept {
  return {limits.pressure_min_kpa,
          limits.pressure_max_kpa,
          limits.slew_up_kpa_per_s,
          limits.slew_down_kpa_per_s,
          limits.displacement_min,
          limits.displacement_max,
          0,
          limits.rest_kpa};
}

control::LimitSettings checked(const Limits& limits) {
  constexpr double most_kpa = 1e6;
  require_between("pressure_min_kpa", limits.pressure_min_kpa, -most_kpa, most_kpa, "kPa");
  require_between("pressure_max_kpa", limits.pressure_max_kpa, -most_kpa, most_kpa, "kPa");
  if (!(limits.pressure_max_kpa > limits.pressure_min_kpa))
    throw InvalidArgument("pressure_max_kpa", "the value must be above pressure_min_kpa (both in kPa)");
  require_positive("slew_up_kpa_per_s", limits.slew_up_kpa_per_s, "kPa/s");
  require_positive("slew_down_kpa_per_s", limits.slew_down_kpa_per_s, "kPa/s");
  require_between("rest_kpa", limits.rest_kpa, -most_kpa, most_kpa, "kPa");
  if (!(std::isfinite(limits.displacement_min) && std::isfinite(limits.displacement_max) &&
        limits.displacement_min < limits.displacement_max))
    throw InvalidArgument("displacement_max",
                          "the value must be above displacement_min (both in the unit of the model)");
  return settings_of(limits);
}

}  // namespace library

LimitedCommand limit(const Limits& limits, double wanted_kpa, double last_kpa, double elapsed_s) noexcept {
  const control::LimitedCommand limited =
      control::limit(library::settings_of(limits), wanted_kpa, last_kpa, elapsed_s);
  return {limited.command_kpa, limited.saturated, limited.slewing, limited.invalid};
}

struct Pid::Parts {
  control::Pid pid;
};

Pid::Pid(const PidSettings& settings, double tick_s) {
  library::require_positive("tick_s", tick_s, "s");
  parts_ = std::make_unique<Parts>(Parts{control::Pid(checked_pid(settings), tick_s)});
}
Pid::~Pid() = default;
Pid::Pid(Pid&& other) noexcept = default;
Pid& Pid::operator=(Pid&& other) noexcept = default;

void Pid::align(double command_kpa) noexcept {
  parts_->pid.align(command_kpa);
}
double Pid::step(double reference, double measurement, double feedforward_kpa) noexcept {
  return parts_->pid.step(reference, measurement, feedforward_kpa);
}
double Pid::hold(double feedforward_kpa) noexcept {
  return parts_->pid.hold(feedforward_kpa);
}
void Pid::sent(double command_kpa) noexcept {
  parts_->pid.sent(command_kpa);
}

struct Reference::Parts {
  control::Reference value;
};

Reference::Reference(double value) : parts_(std::make_unique<Parts>()) {
  library::require_between("value", value, -std::numeric_limits<double>::max(),
                           std::numeric_limits<double>::max(), "");
  parts_->value.start(0, value);
}
Reference::~Reference() = default;
Reference::Reference(const Reference& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
Reference& Reference::operator=(const Reference& other) {
  *parts_ = *other.parts_;
  return *this;
}

void Reference::start(double time_s, double value) noexcept {
  if (std::isfinite(time_s) && std::isfinite(value)) parts_->value.start(time_s, value);
}
bool Reference::ramp_to(double value, double duration_s) noexcept {
  return std::isfinite(value) && std::isfinite(duration_s) && duration_s > 0 &&
         parts_->value.ramp_for(value, duration_s);
}
bool Reference::hold_for(double duration_s) noexcept {
  return std::isfinite(duration_s) && duration_s > 0 && parts_->value.hold_for(duration_s);
}
bool Reference::sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept {
  return std::isfinite(mean) && std::isfinite(amplitude) && std::isfinite(frequency_hz) && frequency_hz > 0 &&
         std::isfinite(cycles) && cycles > 0 && parts_->value.sine(mean, amplitude, frequency_hz, cycles);
}
double Reference::at(double time_s) const noexcept {
  return parts_->value.value_at(time_s);
}
double Reference::end_s() const noexcept {
  return parts_->value.end_s();
}

struct Feedforward::Parts {
  control::RunningModel running;
  control::Feedforward at_rest;  ///< the feedforward before its first step
  control::Feedforward feedforward;
  FeedforwardKind kind = FeedforwardKind::none;
  control::LimitSettings limits;
  double tick_s = 0;
  double time_s = 0;
  double last_kpa = 0;  ///< result of the last step

  /// Returns a reference that has the value `ahead` at all times.
  [[nodiscard]] control::Reference reference(double ahead) const noexcept {
    control::Reference reference;
    reference.start(time_s, ahead);
    return reference;
  }
};

Feedforward::Feedforward(const Model& model, const Limits& limits, double tick_s, FeedforwardKind kind,
                         double extra_latency_s) {
  const control::LimitSettings settings = library::checked(limits);
  library::require_between("tick_s", tick_s, shortest_tick_s, longest_tick_s, "s");
  library::require_between("extra_latency_s", extra_latency_s, 0, 1, "s");
  const control::FeedforwardSettings feedforward{kind_of(kind), extra_latency_s};
  require_usable(model, feedforward, settings, tick_s);
  const control::Feedforward at_rest(model.parts().value, feedforward, settings, tick_s);
  parts_ = std::make_unique<Parts>(
      Parts{.running = control::RunningModel(model.parts().value, tick_s, extra_latency_s, tick_s),
            .at_rest = at_rest,
            .feedforward = at_rest,
            .kind = kind,
            .limits = settings,
            .tick_s = tick_s});
  start(control::resting_kpa(settings), 0);
}
Feedforward::~Feedforward() = default;
Feedforward::Feedforward(Feedforward&& other) noexcept = default;
Feedforward& Feedforward::operator=(Feedforward&& other) noexcept = default;

double Feedforward::preview_s() const noexcept {
  return parts_->feedforward.preview_s();
}

void Feedforward::start(double command_kpa, double reference_ahead) noexcept {
  if (!std::isfinite(command_kpa) || !std::isfinite(reference_ahead)) return;
  Parts& parts = *parts_;
  parts.running.reset(command_kpa);
  parts.feedforward = parts.at_rest;
  parts.time_s = 0;
  parts.last_kpa = parts.kind == FeedforwardKind::none ? 0 : control::in_range(parts.limits, command_kpa);
  const control::Reference reference = parts.reference(reference_ahead);
  parts.feedforward.enter(parts.running, {.reference = &reference, .time_s = 0}, command_kpa);
}

FeedforwardStep Feedforward::step(double reference_ahead) noexcept {
  Parts& parts = *parts_;
  if (!std::isfinite(reference_ahead)) {
    parts.feedforward.hold();
    parts.time_s += parts.tick_s;
    return {parts.last_kpa, true};
  }
  const control::Reference reference = parts.reference(reference_ahead);
  const control::FeedforwardStep step =
      parts.feedforward.step({.reference = &reference, .time_s = parts.time_s});
  parts.time_s += parts.tick_s;
  parts.last_kpa = step.pressure_kpa;
  return {step.pressure_kpa, step.out_of_reach};
}

struct Controller::Parts {
  Parts(const control::ChannelSettings& settings, double tick_s) : controller(settings, tick_s) {}

  control::ChannelController controller;
  control::ChannelOutput output;
  control::ChannelDemand demand;
  control::Reference reference;
};

Controller::Controller(const ControllerSettings& settings) {
  library::require_between("tick_s", settings.tick_s, shortest_tick_s, longest_tick_s, "s");
  library::require_between("extra_latency_s", settings.extra_latency_s, 0, 1, "s");
  library::require_positive("sensor_noise", settings.sensor_noise, name_of(settings.model.unit()));
  library::require_between("reading_max_age_s", settings.reading_max_age_s, 1e-4, 60, "s");
  control::ChannelSettings channel;
  channel.name = settings.model.name();
  channel.model = settings.model.parts().value;
  channel.pid = checked_pid(settings.pid);
  channel.feedforward = {kind_of(settings.feedforward), settings.extra_latency_s};
  channel.limits = library::checked(settings.limits);
  channel.plausibility.max_age_s = settings.reading_max_age_s;
  channel.health.noise_mm = settings.sensor_noise;
  require_usable(settings.model, channel.feedforward, channel.limits, settings.tick_s);
  parts_ = std::make_unique<Parts>(channel, settings.tick_s);
  start(control::resting_kpa(channel.limits));
}
Controller::~Controller() = default;
Controller::Controller(Controller&& other) noexcept = default;
Controller& Controller::operator=(Controller&& other) noexcept = default;

void Controller::start(double command_kpa) noexcept {
  parts_->controller.start(command_kpa, parts_->output);
  hold();
}

void Controller::follow(const Reference& reference) noexcept {
  parts_->reference = reference.parts().value;
  parts_->demand = {.mode = control::ChannelDemand::Mode::displacement, .reference = &parts_->reference};
}

void Controller::hold() noexcept {
  parts_->demand = {.mode = control::ChannelDemand::Mode::hold};
}

void Controller::vent() noexcept {
  parts_->demand = {.mode = control::ChannelDemand::Mode::vent};
}

void Controller::pressure(double pressure_kpa) noexcept {
  parts_->demand = {.mode = control::ChannelDemand::Mode::pressure, .pressure_kpa = pressure_kpa};
}

ControlOutput Controller::tick(std::chrono::nanoseconds now, const Reading& reading) noexcept {
  Parts& parts = *parts_;
  parts.demand.time_s = std::chrono::duration<double>(now).count();
  parts.controller.tick({.now = now.count(), .reading = library::reading_of(reading), .demand = parts.demand},
                        parts.output);
  const control::ChannelOutput& output = parts.output;
  return {output.command_kpa,
          output.reference_mm,
          output.displacement_mm,
          output.feedforward_kpa,
          output.feedback_kpa,
          output.residual_mm,
          library::validity_of(output.validity),
          output.saturated,
          output.slewing,
          output.out_of_reach};
}

}  // namespace softgrip
