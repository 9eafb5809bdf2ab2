#include "simulation/emulator/emulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <modbus/modbus.h>

#include "base/numbers.h"

namespace softgrip::simulation {
namespace {

constexpr double seconds_per_nanosecond = 1e-9;

std::vector<FaultSpec> with_object_out(std::vector<FaultSpec> faults) {
  const bool there = std::any_of(faults.begin(), faults.end(),
                                 [](const FaultSpec& fault) { return fault.name == Emulator::object_out; });
  if (!there) {
    FaultSpec fault;
    fault.name = Emulator::object_out;
    fault.kind = FaultKind::object_removed;
    faults.push_back(fault);
  }
  return faults;
}

Nanoseconds interval_of(const FaultSpec& fault) {
  return std::max<Nanoseconds>(1, std::llround(fault.interval_s * 1e9));
}

/// Returns true in the first, third, fifth ... interval of a jumping sensor. In these intervals, the reading
/// of the sensor has an offset.
bool is_off(const FaultSpec& fault, Nanoseconds since, Nanoseconds now) {
  return (now - since) / interval_of(fault) % 2 == 0;
}

}  // namespace

Emulator::Emulator(EmulatorSettings settings)
    : wire_(settings.wire), faults_(with_object_out(std::move(settings.faults))) {
  for (const EmulatedModule& module : settings.modules) {
    boards_.emplace_back(module.map);
    places_.push_back({module.unit, module.link});
  }
  fingers_.reserve(settings.wiring.size());
  for (std::size_t i = 0; i < settings.wiring.size(); ++i) {
    fingers_.emplace_back(std::move(settings.wiring[i]), settings.plants[i]);
  }
  take_commands();
}

void Emulator::advance(Nanoseconds now) {
  while (now_ < now) {
    move_to(next_stop(now));
    for (EmulatedBoard& board : boards_) {
      const bool was_tripped = board.tripped();
      board.advance(now_);
      if (!board.tripped() || was_tripped) continue;
      ++watchdog_trips_;
      take_commands();
    }
    // Faults must be applied in each step, because the offset of a jumping sensor also changes while the set
    // of active faults is unchanged.
    faults_.advance(now_);
    apply_faults();
    if (now_ % grid == 0 && observer_) observer_();
  }
}

EmulatedBoard* Emulator::board_at(std::size_t link, std::uint8_t unit) noexcept {
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    if (places_[i].link == link && places_[i].unit == unit) return &boards_[i];
  }
  return nullptr;
}

bool Emulator::commanded() const noexcept {
  return std::any_of(boards_.begin(), boards_.end(),
                     [](const EmulatedBoard& board) { return board.commanded(); });
}

bool Emulator::tripped() const noexcept {
  return std::any_of(boards_.begin(), boards_.end(),
                     [](const EmulatedBoard& board) { return board.tripped(); });
}

Reply Emulator::serve(Nanoseconds now, const Request& request, std::size_t link, Nanoseconds opened_at) {
  advance(now);
  EmulatedBoard* const board = board_at(link, request.unit);
  // On a serial line, every module receives every request, but only the module with the unit id of the
  // request replies.
  if (board == nullptr && wire_ == Wire::rtu) return {};
  ++requests_;
  const auto index = wire_fault(request, now - opened_at);
  if (index) faults_.count_reply(*index);
  Bytes pdu{request.pdu[0]};
  if (!index || carried_out(faults_.faults()[*index].kind)) {
    if (board == nullptr) {
      pdu = exception_reply(request.pdu[0], MODBUS_EXCEPTION_GATEWAY_TARGET);
    } else {
      for (const Finger& finger : fingers_) finger.show(boards_);
      board->ignore_writes(faults_.first_active(FaultKind::ignored_write).has_value());
      pdu = board->answer(now, request.pdu).pdu;
      if (board->commanded()) faults_.start(now);
      take_commands();
    }
  }
  return index ? spoiled_reply(wire_, faults_.faults()[*index], request, pdu)
               : good_reply(wire_, request, pdu);
}

void Emulator::count_clients(std::size_t clients, std::size_t link) {
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    if (places_[i].link == link) boards_[i].count_clients(clients);
  }
}

bool Emulator::trigger(std::string_view name, Nanoseconds now) {
  advance(now);
  const bool found = faults_.trigger(name, now);
  apply_faults();
  return found;
}

bool Emulator::clear(std::string_view name, Nanoseconds now) {
  advance(now);
  const bool found = faults_.clear(name);
  apply_faults();
  return found;
}

void Emulator::set_object(const std::optional<simulation::PlantObject>& object) {
  for (Finger& finger : fingers_) finger.set_object(object);
  apply_faults();
}

Nanoseconds Emulator::next_stop(Nanoseconds now) const {
  Nanoseconds stop = std::min(now, (now_ / grid + 1) * grid);
  for (const EmulatedBoard& board : boards_) {
    if (const auto due = board.watchdog_due()) stop = std::min(stop, *due);
  }
  if (const auto change = faults_.next_change()) stop = std::min(stop, *change);
  return std::max(stop, now_ + 1);
}

void Emulator::move_to(Nanoseconds moment) {
  const double duration_s = static_cast<double>(moment - now_) * seconds_per_nanosecond;
  for (Finger& finger : fingers_) finger.advance(duration_s);
  now_ = moment;
}

std::optional<std::size_t> Emulator::wire_fault(const Request& request, Nanoseconds connected_for) const {
  for (std::size_t i = 0; i < faults_.faults().size(); ++i) {
    const FaultSpec& fault = faults_.faults()[i];
    if (faults_.active(i) && on_the_wire(fault.kind) && touches(fault, request, connected_for)) return i;
  }
  return std::nullopt;
}

void Emulator::take_commands() {
  for (Finger& finger : fingers_) finger.take_command(boards_);
}

void Emulator::apply_faults() {
  for (std::size_t channel = 0; channel < fingers_.size(); ++channel) apply_faults(channel);
}

void Emulator::apply_faults(std::size_t channel) {
  simulation::LineFault line;
  simulation::SensorFault sensor;
  bool object_there = true;
  for (std::size_t i = 0; i < faults_.faults().size(); ++i) {
    const FaultSpec& fault = faults_.faults()[i];
    if (!faults_.active(i) || fault.channel.value_or(channel) != channel) continue;
    if (fault.line.kind != LineFault::Kind::none) line = fault.line;
    if (fault.sensor.kind != SensorFault::Kind::none) {
      const bool there = fault.kind != FaultKind::sensor_jumping || is_off(fault, faults_.since(i), now_);
      sensor = there ? fault.sensor : SensorFault{};
    }
    if (fault.kind == FaultKind::object_removed) object_there = false;
  }
  fingers_[channel].set_faults(line, sensor);
  fingers_[channel].place_object(object_there);
}

TruthLog::TruthLog(const std::string& path, std::uint32_t decimation)
    : file_(path, std::ios::trunc), decimation_(std::max(decimation, 1U)) {
  file_ << "time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_"
           "tripped\n";
}

void TruthLog::add(const Emulator& emulator) {
  if (count_++ % decimation_ != 0) return;
  // The times are rounded to microseconds to keep their text in the log short.
  const std::int64_t time_us = emulator.now() / 1000;
  const double time_s = static_cast<double>(time_us) / 1e6;
  for (const Finger& finger : emulator.fingers()) {
    const simulation::Plant& plant = finger.plant();
    row_ = shortest(time_s) + "," + finger.name();
    for (const double value : {plant.held_command_kpa(), plant.displacement_mm(), plant.pressure_kpa()}) {
      row_ += "," + shortest(value);
    }
    row_ += ",";
    if (!plant.sees_nothing()) row_ += shortest(plant.reading_mm());
    row_ += finger.has_object() ? ",1" : ",0";
    row_ += emulator.tripped() ? ",1\n" : ",0\n";
    file_ << row_;
  }
}

}  // namespace softgrip::simulation
