#include "control/tick/rig_controller.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "control/elements/rest_watch.h"
#include "control/tick/channel_controller.h"
#include "control/tick/fault_monitor.h"
#include "control/tick/sequence_player.h"
#include "control/tick/supervisor.h"

namespace softgrip::control {

namespace {
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<std::string_view, 6> state_names{"starting", "idle",     "resynchronising",
                                                      "running",  "stopping", "faulted"};
constexpr std::array<std::string_view, 4> end_names{"done", "failed", "stopped", "faulted"};
constexpr std::uint32_t bit(std::size_t channel) noexcept {
  return 1U << channel;
}
}  // namespace

std::string_view name_of(State state) noexcept {
  return state_names[static_cast<std::size_t>(state)];
}
std::string_view name_of(SequenceEnd end) noexcept {
  return end_names[static_cast<std::size_t>(end)];
}

struct RigController::Parts {
  explicit Parts(const RigSettings& rig)
      : settings(rig),
        monitor(rig),
        supervisor(rig),
        player(rig),
        steps(rig.channels.size()),
        views(rig.channels.size()),
        valid_before(rig.channels.size(), true),
        rest(rig.channels.size(), RestWatch(rig.rest_band_mm, rig.rest_time_s)) {
    for (std::size_t i = 0; i < rig.channels.size(); ++i) {
      controllers.emplace_back(rig.channels[i], 1 / rig.rate_hz);
      controllers[i].start(rig.channels[i].limits.pressure_min_kpa);
      steps[i].command_kpa = controllers[i].command_kpa();
    }
  }

  [[nodiscard]] std::size_t count() const noexcept { return controllers.size(); }

  void tick(const TickInput& input, TickOutput& output) noexcept {
    if (!started) {
      started = true;
      began = input.now;
    }
    const double time_s = static_cast<double>(input.now - began) * 1e-9;
    EventList events(output);
    view();
    carry_out(supervisor.tick(facts(input, time_s), input.request, events), time_s, events);
    play(time_s, events);
    for (std::size_t i = 0; i < count(); ++i) {
      control(i, input, time_s, events);
    }
    monitor.end_tick();
    fill(output);
  }

  /// What the last tick left behind, for the player.
  void view() noexcept {
    for (std::size_t i = 0; i < count(); ++i) {
      const ChannelSettings& channel = settings.channels[i];
      ChannelView& to = views[i];
      to.sighted = channel.displacement_used;
      to.valid = to.sighted && steps[i].validity == model::Validity::valid;
      to.displacement_mm = steps[i].displacement_mm;
      to.deficit_mm = to.valid ? -steps[i].residual_mm : unknown;
      to.pressure_kpa = pressures[i];
      to.command_kpa = controllers[i].command_kpa();
      to.lowest_kpa = channel.limits.pressure_min_kpa;
      to.preview_s = controllers[i].preview_s();
    }
  }

  Facts facts(const TickInput& input, double time_s) noexcept {
    Facts facts;
    facts.fault = monitor.observe(input, steps, supervisor.state() == State::starting);
    facts.cause_present = monitor.cause_present();
    facts.bus_good = monitor.bus_good();
    facts.emergency_stop = input.emergency_stop;
    facts.interlock_open = input.interlock_open;
    facts.phase = player.phase();
    for (std::size_t i = 0; i < count(); ++i) {
      facts.ready |= views[i].valid || !views[i].sighted ? bit(i) : 0;
      facts.lowest |= views[i].command_kpa <= views[i].lowest_kpa ? bit(i) : 0;
    }
    facts.answers = player.has_answers();
    if (supervisor.state() == State::resynchronising) {
      facts.rest = look_for_rest(*supervisor.sequence(), time_s);
    }
    return facts;
  }

  /// All channels of the sequence at rest; those that are vented, and so free, also followed to where they
  /// are, by no more than grip detection can stand.
  Rest look_for_rest(const PreparedSequence& sequence, double time_s) noexcept {
    bool all = true;
    for (std::size_t i = 0; i < count(); ++i) {
      resynchronise[i] = false;
      if ((sequence.channels & bit(i)) == 0) {
        continue;
      }
      const bool still = rest[i].observe(time_s, views[i]);
      resynchronise[i] = still && follows(i);
      const bool followed = !follows(i) || (still && steps[i].synchronised && !too_far(sequence, i));
      all = all && still && followed;
    }
    if (all) {
      return Rest::at_rest;
    }
    return time_s - seeking_since_s >= settings.rest_timeout_s ? Rest::timed_out : Rest::pending;
  }

  [[nodiscard]] bool follows(std::size_t i) const noexcept {
    return views[i].sighted && views[i].command_kpa <= views[i].lowest_kpa;
  }

  /// What of the offset is creep that is still on its way out would later look like an object.
  [[nodiscard]] bool too_far(const PreparedSequence& sequence, std::size_t i) const noexcept {
    return (sequence.needs_detection & bit(i)) != 0 &&
           std::abs(controllers[i].offset_mm()) > settings.detection.margin_mm;
  }

  void carry_out(const Orders& orders, double time_s, EventList& events) noexcept {
    if (orders.interrupt) {
      player.interrupt(orders.end, supervisor.venting(), events);
    }
    if (orders.clear_answers) {
      player.acknowledge(orders.acknowledged_by, events);
    }
    if (orders.vented != 0) {
      player.vented(orders.vented, events);
    }
    if (orders.no_rest != 0) {
      player.refuse(orders.no_rest, events);
    }
    if (orders.seek_rest) {
      seeking_since_s = time_s;
      for (RestWatch& watch : rest) {
        watch.start();
      }
    }
    if (supervisor.state() != State::resynchronising) {
      resynchronise.fill(false);
    }
    if (orders.begin != nullptr) {
      player.start(*orders.begin, time_s, views, events);
    }
  }

  void play(double time_s, EventList& events) noexcept {
    if (supervisor.state() != State::running) {
      if (supervisor.state() == State::idle) {
        player.idle_tick(time_s, views, events);
      }
      return;
    }
    const Phase phase = player.phase();
    const SequencePlayer::Outcome outcome = player.tick(time_s, views, events);
    if (outcome.finished) {
      supervisor.sequence_ended(outcome.end, outcome.action, phase, events);
    }
  }

  [[nodiscard]] ChannelDemand demand(std::size_t i, double time_s) const noexcept {
    if (supervisor.state() == State::running) {
      return player.demand(i, time_s);
    }
    ChannelDemand demand;
    demand.time_s = time_s;
    demand.mode =
        (supervisor.venting() & bit(i)) != 0 ? ChannelDemand::Mode::vent : ChannelDemand::Mode::hold;
    return demand;
  }

  void control(std::size_t i, const TickInput& input, double time_s, EventList& events) noexcept {
    ChannelInput channel;
    channel.now = input.now;
    channel.reading = input.readings[i];
    channel.demand = demand(i, time_s);
    channel.resynchronise = resynchronise[i];
    channel.free_motion = supervisor.state() != State::faulted && supervisor.state() != State::starting &&
                          player.free_motion(i);
    steps[i] = controllers[i].tick(channel);
    pressures[i] = input.readings[i].pressure_kpa;
    monitor.sent(i, steps[i].command_kpa);
    tell_changes(i, events);
  }

  void tell_changes(std::size_t i, EventList& events) noexcept {
    const ChannelStep& step = steps[i];
    const bool valid = step.validity == model::Validity::valid;
    if (valid != valid_before[i]) {
      events.add_of_channel(i, valid ? Event::Kind::reading_valid : Event::Kind::reading_invalid,
                            step.validity, 0, step.age_s);
      valid_before[i] = valid;
    }
    if (step.health_changed) {
      events.add_of_channel(i, Event::Kind::model_health_changed, step.health, 0, step.health_rms_mm);
    }
  }

  void fill(TickOutput& output) const noexcept {
    output.state = supervisor.state();
    output.first_fault = supervisor.first_fault();
    output.channel_count = count();
    for (std::size_t i = 0; i < count(); ++i) {
      const ChannelStep& from = steps[i];
      const ChannelPlayer& played = player.channel(i);
      ChannelOutput& to = output.channels[i];
      to.command_kpa = from.command_kpa;
      to.reference_mm = from.reference_mm;
      to.displacement_mm = from.displacement_mm;
      to.pressure_kpa = pressures[i];
      to.feedforward_kpa = from.feedforward_kpa;
      to.feedback_kpa = from.feedback_kpa;
      to.residual_mm = from.residual_mm;
      to.age_s = from.age_s;
      to.validity = from.validity;
      to.result = played.result();
      to.evidence = played.evidence();
      to.deficit_mm = views[i].valid ? -from.residual_mm : unknown;
      to.step = player.step();
      to.saturated = from.saturated;
      to.slewing = from.slewing;
      to.health = from.health;
      to.health_rms_mm = from.health_rms_mm;
    }
  }

  RigSettings settings;
  FaultMonitor monitor;
  Supervisor supervisor;
  SequencePlayer player;
  std::vector<ChannelController> controllers;
  std::vector<ChannelStep> steps;  ///< of the last tick
  std::vector<ChannelView> views;
  std::vector<bool> valid_before;
  std::vector<RestWatch> rest;
  std::array<double, max_channels> pressures{};
  std::array<bool, max_channels> resynchronise{};
  double seeking_since_s = 0;
  Nanoseconds began = 0;
  bool started = false;
};

RigController::RigController(const RigSettings& settings) : parts_(std::make_unique<Parts>(settings)) {}
RigController::RigController(RigController&&) noexcept = default;
RigController& RigController::operator=(RigController&&) noexcept = default;
RigController::~RigController() = default;

void RigController::tick(const TickInput& input, TickOutput& output) noexcept {
  output.event_count = 0;
  output.events_lost = 0;
  parts_->tick(input, output);
}

void RigController::safe_commands(std::span<double> commands_kpa) const noexcept {
  const Parts& parts = *parts_;
  const std::uint32_t venting = parts.supervisor.venting_on_leaving(parts.player.phase());
  for (std::size_t i = 0; i < parts.count() && i < commands_kpa.size(); ++i) {
    commands_kpa[i] = (venting & bit(i)) != 0 ? parts.settings.channels[i].limits.pressure_min_kpa
                                              : parts.controllers[i].command_kpa();
  }
}

}  // namespace softgrip::control
