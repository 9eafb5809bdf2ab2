#include "tests/world/hardware.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace softgrip::world {

using drivers::BusStatus;

namespace {

/// Number of exchanges of which one begins with a reading of the outputs, as in the Modbus driver.
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

/// Advances the simulated plants in whole steps. A value that is written during a step takes effect in the
/// next step.
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
  // The watchdog time begins with the first request, as on commercial boards.
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

WorldBoard::WorldBoard(Hardware& hardware, Habits habits, Line& line, Scheduler& scheduler,
                       Callbacks callbacks)
    : hardware_(hardware),
      habits_(habits),
      line_(line),
      scheduler_(scheduler),
      callbacks_(std::move(callbacks)),
      carrier_(scheduler.add("line", [this] { carry(); })),
      found_(hardware.channels(), std::numeric_limits<double>::quiet_NaN()) {}

void WorldBoard::carry() {
  for (;;) {
    const Nanoseconds now = scheduler_.now();
    if (request_ && !request_->there && now >= request_->arrives) {
      Request& request = *request_;
      hardware_.move_to(now);
      request.ignored = now < opened_at_ + habits_.deaf;
      if (request.ignored) {
        request.there = true;
        continue;
      }
      const bool begins = request.first == 0 && !request.again;
      const bool looks_first = begins && ++exchanges_ % looks_first_every == 0 && !left_.empty();
      request.foreign_writes = hardware_.foreign_writes;
      request.overwritten =
          looks_first && !std::equal(left_.begin(), left_.end(), hardware_.outputs_kpa().begin());
      if (request.overwritten) {
        request.there = true;
        continue;
      }
      if (!hardware_.ignores_writes() && request.count > 0) callbacks_.on_write(request.began, request.sent);
      std::vector<double> outputs(hardware_.outputs_kpa().begin(), hardware_.outputs_kpa().end());
      for (std::size_t i = request.first; i < request.first + request.count; ++i)
        outputs[i] = request.sent[i];
      request.taken = hardware_.write(now, outputs);
      for (std::size_t i = 0; i < request.read.size(); ++i)
        hardware_.read(i, scheduler_.shown(), request.read[i]);
      request.there = true;
    }
    const bool under_way = request_ && !request_->there;
    scheduler_.sleep_until(under_way ? request_->arrives : now + ns_per_s);
  }
}

/// Sends the request, repeats it if necessary, and waits for the response. Returns false if no response has
/// arrived until the time `end`.
bool WorldBoard::ask(Request request, Nanoseconds end, bool lost) {
  for (;; request.again = true) {
    const Nanoseconds sent = scheduler_.now();
    request.arrives = sent + line_.latency / 2;
    request_ = request;
    scheduler_.wake(carrier_);
    pass(line_.latency);
    while (request_ && !request_->there) pass(line_.latency / 4);
    if (!request_) return false;
    if (!request_->ignored && !lost && !lost_by_habit()) return true;
    const Nanoseconds again = sent + habits_.repeat_after;
    if (habits_.repeat_after == 0 || again >= end) return false;
    scheduler_.sleep_until(again);
    if (scheduler_.now() >= end) return false;
  }
}

BusStatus WorldBoard::hindered(BusStatus status) {
  left_.clear();
  callbacks_.on_hindered();
  return status;
}

BusStatus WorldBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  pass(line_.latency);
  if (line_.status == BusStatus::disconnected || line_.status == BusStatus::timed_out) {
    pass(line_.status == BusStatus::timed_out ? deadline.count() : 0);
    return line_.status;
  }
  left_.clear();
  opened_at_ = scheduler_.now();
  closes_ = habits_.closes_every > 0 && ++connections_ % habits_.closes_every == 0;
  if (!closes_) hardware_.greet(opened_at_);
  if (habits_.settle > 0) pass(habits_.settle);
  return BusStatus::ok;
}

BusStatus WorldBoard::exchange(std::span<const double> commands_kpa, std::span<model::Reading> readings,
                               std::chrono::nanoseconds deadline) noexcept {
  const Nanoseconds began = scheduler_.now();
  callbacks_.on_exchange();
  const BusStatus status = line_.status;
  if (status == BusStatus::disconnected || status == BusStatus::exception) {
    pass(line_.latency / 2);
    hardware_.move_to(scheduler_.now());
    return status;
  }
  if (closes_) {
    pass(line_.latency / 2);
    return hindered(BusStatus::closed_at_once);
  }
  const bool lost = status == BusStatus::timed_out;
  const Nanoseconds end = began + deadline.count();
  const std::size_t channels = commands_kpa.size();
  const std::size_t at_once = habits_.channels_at_once > 0 ? habits_.channels_at_once : channels;
  bool taken = true;
  bool answered = true;
  bool arrives = !lost || line_.reply_lost;
  // If a separate request reads the outputs, this request is the last one and writes no channel.
  const std::size_t requests_end = channels + (habits_.reads_apart ? 1 : 0);
  for (std::size_t first = 0; first < requests_end && arrives;
       first = std::max(first + 1, std::min(first + at_once, channels))) {
    Request request;
    request.began = began;
    request.sent.assign(commands_kpa.begin(), commands_kpa.end());
    request.first = first;
    request.count = std::min(at_once, channels - std::min(first, channels));
    request.read.assign(readings.begin(), readings.end());
    answered = (first == 0 || scheduler_.now() < end) && ask(std::move(request), end, lost);
    taken = answered && request_->taken;
    arrives = taken;
  }
  if (lost || !answered) scheduler_.sleep_until(end);
  if (status == BusStatus::ok && !answered) return hindered(BusStatus::timed_out);
  if (status != BusStatus::ok) {
    left_.clear();
    return status;
  }
  if (habits_.spoils_every > 0 && ++answers_ % habits_.spoils_every == 0)
    return hindered(BusStatus::bad_reply);
  callbacks_.on_read(request_->foreign_writes);
  if (request_->overwritten) {
    left_.clear();
    return BusStatus::overwritten;
  }
  left_.clear();  // the outputs are unknown until the next exchange is confirmed
  if (!taken) return BusStatus::watchdog_tripped;
  bool as_written = true;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double outputs_kpa = request_->read[i].command_readback_kpa;
    const bool same = outputs_kpa == commands_kpa[i];
    found_[i] = same ? std::numeric_limits<double>::quiet_NaN() : outputs_kpa;
    as_written = as_written && same;
  }
  if (!as_written) return BusStatus::write_refused;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    ++request_->read[i].sequence;
    readings[i] = request_->read[i];
  }
  left_.assign(commands_kpa.begin(), commands_kpa.end());
  return BusStatus::ok;
}

}  // namespace softgrip::world
