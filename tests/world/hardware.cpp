#include "tests/world/hardware.h"

#include <algorithm>
#include <utility>

namespace softgrip::world {

using drivers::BusStatus;

namespace {

/// As the Modbus driver does: one exchange in so many begins with the reading.
constexpr unsigned looks_first_every = 8;

}  // namespace

Hardware::Hardware(HardwareSettings settings) : settings_(std::move(settings)) {
  for (const simulation::PlantSettings& plant : settings_.plants) plants_.emplace_back(plant);
  outputs_kpa_ = settings_.safe_kpa;
  put_out();
}

void Hardware::put_out() {
  for (std::size_t i = 0; i < plants_.size(); ++i) plants_[i].command(outputs_kpa_[i]);
}

/// In whole steps: what is written meanwhile reaches the air with the next.
void Hardware::advance_plants(Nanoseconds until) {
  const double step_s = seconds(settings_.plant_step);
  for (; plants_at_ + settings_.plant_step <= until; plants_at_ += settings_.plant_step) {
    for (simulation::Plant& plant : plants_) plant.advance(step_s);
  }
}

void Hardware::move_to(Nanoseconds now) {
  if (!begun_) {
    begun_ = true;
    plants_at_ = now;
  }
  // As with boards in the shops, nobody is missed before somebody has been there.
  if (settings_.watchdog > 0 && !tripped_ && fed_at_ > 0 && fed_at_ + settings_.watchdog < now) {
    advance_plants(fed_at_ + settings_.watchdog);
    tripped_ = true;
    outputs_kpa_ = settings_.safe_kpa;
    put_out();
    if (settings_.on_trip) settings_.on_trip();
  }
  advance_plants(now);
}

void Hardware::greet(Nanoseconds now) {
  move_to(now);
  fed_at_ = now;
  tripped_ = false;
}

bool Hardware::write(Nanoseconds now, std::span<const double> outputs_kpa) {
  move_to(now);
  fed_at_ = now;
  if (tripped_ && settings_.trip_latches) return false;
  tripped_ = false;
  if (refuses_writes) return true;
  std::copy(outputs_kpa.begin(), outputs_kpa.end(), outputs_kpa_.begin());
  put_out();
  return true;
}

void Hardware::read(std::size_t channel, Nanoseconds now, model::Reading& reading) const {
  const simulation::Plant& plant = plants_[channel];
  const bool blind = plant.sees_nothing();
  if (!blind) reading.displacement_mm = plant.reading_mm();
  reading.validity = blind ? model::Validity::out_of_range : model::Validity::valid;
  reading.pressure_kpa = plant.measured_pressure_kpa();
  reading.command_readback_kpa = outputs_kpa_[channel];
  reading.sampled_at = now;
}

WorldBoard::WorldBoard(Hardware& hardware, Line& line, Scheduler& scheduler, OnWrite on_write,
                       std::function<void()> on_exchange)
    : hardware_(hardware),
      line_(line),
      scheduler_(scheduler),
      on_write_(std::move(on_write)),
      on_exchange_(std::move(on_exchange)),
      carrier_(scheduler.add("line", [this] { carry(); })) {}

void WorldBoard::carry() {
  for (;;) {
    const Nanoseconds now = scheduler_.now();
    if (request_ && !request_->there && now >= request_->arrives) {
      Request& request = *request_;
      hardware_.move_to(now);
      const bool looks_first = ++exchanges_ % looks_first_every == 0 && !left_.empty();
      request.overwritten =
          looks_first && !std::equal(left_.begin(), left_.end(), hardware_.outputs_kpa().begin());
      if (request.overwritten) {
        request.there = true;
        continue;
      }
      if (!hardware_.ignores_writes()) on_write_(request.began, request.sent);
      request.taken = hardware_.write(now, request.sent);
      for (std::size_t i = 0; i < request.read.size(); ++i)
        hardware_.read(i, scheduler_.shown(), request.read[i]);
      request.there = true;
    }
    const bool under_way = request_ && !request_->there;
    scheduler_.sleep_until(under_way ? request_->arrives : now + ns_per_s);
  }
}

/// Sends it and waits for the reply.
bool WorldBoard::ask(const Request& request) {
  request_ = request;
  scheduler_.wake(carrier_);
  pass(line_.latency);
  while (request_ && !request_->there) pass(line_.latency / 4);
  return request_ && request_->taken;
}

BusStatus WorldBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  pass(line_.latency);
  if (line_.status == BusStatus::disconnected || line_.status == BusStatus::timed_out) {
    pass(line_.status == BusStatus::timed_out ? deadline.count() : 0);
    return line_.status;
  }
  hardware_.greet(scheduler_.now());
  left_.clear();
  return BusStatus::ok;
}

BusStatus WorldBoard::exchange(std::span<const double> commands_kpa, std::span<model::Reading> readings,
                               std::chrono::nanoseconds deadline) noexcept {
  const Nanoseconds began = scheduler_.now();
  on_exchange_();
  const BusStatus status = line_.status;
  if (status == BusStatus::disconnected || status == BusStatus::exception) {
    pass(line_.latency / 2);
    hardware_.move_to(scheduler_.now());
    return status;
  }
  const bool lost = status == BusStatus::timed_out;
  bool taken = true;
  if (!lost || line_.reply_lost) {
    Request request;
    request.began = began;
    request.arrives = began + line_.latency / 2;
    request.sent.assign(commands_kpa.begin(), commands_kpa.end());
    request.read.assign(readings.begin(), readings.end());
    taken = ask(request);
  }
  if (lost) scheduler_.sleep_until(began + deadline.count());
  if (status != BusStatus::ok) {
    left_.clear();
    return status;
  }
  if (request_ && request_->overwritten) {
    left_.clear();
    return BusStatus::overwritten;
  }
  left_.clear();  // known again when this one is confirmed
  if (!taken) return BusStatus::watchdog_tripped;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (request_->read[i].command_readback_kpa != commands_kpa[i]) return BusStatus::write_refused;
  }
  for (std::size_t i = 0; i < readings.size(); ++i) {
    ++request_->read[i].sequence;
    readings[i] = request_->read[i];
  }
  left_.assign(commands_kpa.begin(), commands_kpa.end());
  return BusStatus::ok;
}

}  // namespace softgrip::world
