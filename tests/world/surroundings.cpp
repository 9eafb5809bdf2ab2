#include "tests/world/surroundings.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <variant>

#include "base/random.h"

namespace softgrip::world {
namespace {

using Kind = Incident::Kind;

constexpr Nanoseconds foreign_period = ns_per_s * 7 / 1000;

/// The beginning or the end of an incident.
struct Act {
  Nanoseconds at = 0;
  const Incident* incident = nullptr;
  bool begins = true;
};

std::vector<Act> acts_of(const std::vector<Incident>& incidents) {
  std::vector<Act> acts;
  for (const Incident& incident : incidents) {
    acts.push_back({incident.at, &incident, true});
    if (incident.duration > 0) acts.push_back({incident.at + incident.duration, &incident, false});
  }
  std::stable_sort(acts.begin(), acts.end(), [](const Act& a, const Act& b) { return a.at < b.at; });
  return acts;
}

}  // namespace

Surroundings::Surroundings(RigShape rig_shape, bool tracing_)
    : shape(std::move(rig_shape)),
      tracing(tracing_),
      scheduler(derived_seed(shape.seed, 2), ns_per_s),
      begin(scheduler.now()),
      hardware(hardware_settings()),
      board(hardware, shape.habits, line, scheduler,
            {[this](Nanoseconds began, std::span<const double> commands) { on_write(began, commands); },
             [this] { on_exchange(); },
             [this] {
               nobody_spoke();
               on_hindered();
             },
             [this](std::uint64_t foreign_writes) { monitor.outputs_read(foreign_writes); }}),
      monitor(shape.rig.settings, shape.watchdog,
              rig::watchdog_margin(shape.rig.loop, std::chrono::nanoseconds(shape.watchdog)).count()) {}

HardwareSettings Surroundings::hardware_settings() {
  HardwareSettings settings;
  const auto& simulated = std::get<simulation::SimulatedBoardSettings>(shape.rig.board);
  for (const simulation::SimulatedChannel& channel : simulated.channels) {
    settings.plants.push_back(channel.plant);
    settings.plants.back().sample_time_s = 0.005;
    settings.plants.back().seed = derived_seed(channel.plant.seed, shape.seed);
  }
  for (const control::ChannelSettings& channel : shape.rig.settings.channels)
    settings.safe_kpa.push_back(control::resting_kpa(channel.limits));
  settings.plant_step = ns_per_s / 200;
  settings.watchdog = shape.watchdog;
  settings.trip_latches = shape.trip_latches;
  settings.on_trip = [this] {
    ++trips;
    trace("the board's watchdog vents");
    on_trip();
  };
  return settings;
}

void Surroundings::let_happen(const std::vector<Incident>& incidents,
                              std::function<void(const Incident& incident, bool begins)> carry_out) {
  scheduler.add("incidents", [this, acts = acts_of(incidents), carry_out = std::move(carry_out)] {
    for (const Act& act : acts) {
      scheduler.sleep_until(begin + act.at);
      if (act.begins) trace("** {}", text_of(*act.incident));
      carry_out(*act.incident, act.begins);
    }
    for (;;) scheduler.sleep_until(scheduler.now() + 1000 * ns_per_s);
  });
}

void Surroundings::carry_out(const Incident& incident, bool begins) {
  if (incident.kind == Kind::clock_stalls) {
    if (begins) scheduler.stall_clock(incident.duration);
  } else if (incident.kind <= Kind::foreign) {
    to_line(incident, begins);
  } else {
    to_fingers(incident, begins);
  }
}

Excuse Surroundings::excuse() const noexcept {
  Excuse excuse;
  excuse.no_line = hindered_ > 0 || !good_since_;
  excuse.line_but_for_foreign = hindered_ > (foreign_ != nullptr ? 1 : 0) || !good_since_;
  return excuse;
}

void Surroundings::note_write(std::span<const double> outputs_kpa, std::span<const double> commands_kpa) {
  if (tracing && !std::equal(commands_kpa.begin(), commands_kpa.end(), outputs_kpa.begin()))
    trace("wrote {:.4f} kPa over {:.4f}", fmt::join(commands_kpa, " "), fmt::join(outputs_kpa, " "));
  ++writes;
  good_since_ = true;
  for (const double command : commands_kpa) {
    fingerprint = scattered(fingerprint ^ std::bit_cast<std::uint64_t>(command));
  }
  fingerprint = scattered(fingerprint ^ static_cast<std::uint64_t>(scheduler.now()));
}

void Surroundings::to_line(const Incident& incident, bool begins) {
  hindered_ += begins ? 1 : -1;
  if (!begins) good_since_ = false;
  switch (incident.kind) {
    case Kind::line:
      line.status = begins ? static_cast<drivers::BusStatus>(incident.target) : drivers::BusStatus::ok;
      line.reply_lost = false;
      break;
    case Kind::replies_lost:
      line.status = begins ? drivers::BusStatus::timed_out : drivers::BusStatus::ok;
      line.reply_lost = begins;
      break;
    case Kind::slow_line:
      line.latency = begins ? nanoseconds(incident.value) : Line{}.latency;
      break;
    case Kind::write_refused:
      hardware.refuses_writes = begins;
      break;
    case Kind::foreign:
      foreign_ = begins ? &incident : nullptr;
      monitor.foreign_ended();
      if (begins) write_as_another(incident);
      break;
    default:
      break;
  }
}

void Surroundings::write_as_another(const Incident& incident) {
  scheduler.add("other client", [this, &incident] {
    const std::vector<double> outputs(hardware.channels(), incident.value);
    while (foreign_ == &incident) {
      monitor.foreign_wrote(outputs);
      ++hardware.foreign_writes;
      hardware.write(scheduler.now(), outputs);
      scheduler.sleep_until(scheduler.now() + foreign_period);
    }
  });
}

void Surroundings::to_fingers(const Incident& incident, bool begins) {
  hardware.move_to(scheduler.now());
  const std::size_t channel = incident.target % hardware.channels();
  using Sensor = simulation::SensorFault;
  using LineFault = simulation::LineFault;
  switch (incident.kind) {
    case Kind::sensor_stuck:
      hardware.plant(channel).set_fault(Sensor{begins ? Sensor::Kind::stuck : Sensor::Kind::none, 0});
      break;
    case Kind::sensor_lost:
      hardware.plant(channel).set_fault(Sensor{begins ? Sensor::Kind::out_of_range : Sensor::Kind::none, 0});
      break;
    case Kind::line_leaks:
      hardware.plant(channel).set_fault(
          LineFault{begins ? LineFault::Kind::leaking : LineFault::Kind::none, 0.4});
      break;
    case Kind::part_gone:
      for (std::size_t i = 0; i < hardware.channels(); ++i) {
        const auto& simulated = std::get<simulation::SimulatedBoardSettings>(shape.rig.board);
        hardware.plant(i).set_object(begins ? std::nullopt : simulated.channels[i].plant.object);
      }
      break;
    default:
      break;
  }
}

}  // namespace softgrip::world
