#include "daemon/loop/loop.h"

#include <algorithm>
#include <span>

#include "control/tick/rig_controller.h"

namespace softgrip::daemon {

namespace {

/// The loop is the only writer; a locked addition is not needed.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t amount) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
}

}  // namespace

Loop::Loop(control::RigController& controller, std::uint32_t decimation, const Clock& clock, Wires& wires,
           LoopStatistics& statistics) noexcept
    : controller_(controller),
      clock_(clock),
      wires_(wires),
      statistics_(statistics),
      output_(controller.output()),
      channels_(output_.channel_count),
      decimation_(std::max<std::uint32_t>(decimation, 1)) {}

void Loop::run(Grid grid) noexcept {
  while (!wires_.leave.load(std::memory_order_relaxed)) {
    const Nanoseconds due = grid.due();
    clock_.sleep_until(due);
    tick(due);
    count_slips(grid.advance(ended_), woken_ - due >= grid.period());
  }
  leave();
}

void Loop::tick(Nanoseconds due) noexcept {
  woken_ = clock_.now();
  control::TickInput input;
  input.now = woken_;
  read(input);

  controller_.tick(input);
  command(false);
  tell_events();
  if (ticks_ % decimation_ == 0) record_rows(false);
  ++ticks_;
  show(input.bus);

  statistics_.ticks.add();
  statistics_.wake_up.add(woken_ - due);
  ended_ = clock_.now();
  statistics_.compute.add(ended_ - woken_);
}

void Loop::read(control::TickInput& input) noexcept {
  unreported_ = wires_.bus.fetch() ? 0 : unreported_ + 1;
  const BusReport& report = wires_.bus.value();
  input.readings = std::span(report.readings).first(channels_);
  input.bus = report.health;
  input.outputs_kpa = std::span(report.outputs_kpa).first(channels_);
  inhibit_ = report.health.inhibit;
  // An exchange that hangs reports nothing until its deadline, but its cycles count as failed. One missing
  // report is the jitter between two grids.
  if (unreported_ > 1) input.bus.consecutive_failures += unreported_ - 1;
  input.emergency_stop = wires_.inputs.emergency_stop.load(std::memory_order_relaxed);
  input.interlock_open = wires_.inputs.interlock_open.load(std::memory_order_relaxed);
  input.inputs_lost = inputs_lost(input.now);
  input.slipped_cycles = slipped_;
  slipped_ = 0;
  if (!wires_.vents.pop(input.request) && !wires_.stops.pop(input.request) &&
      !wires_.named_stops.pop(input.request)) {
    wires_.requests.pop(input.request);
  }

  Nanoseconds oldest = input.now;
  for (const model::Reading& reading : input.readings) oldest = std::min(oldest, reading.sampled_at);
  if (oldest > 0) statistics_.reading_age.add(input.now - oldest);
}

bool Loop::inputs_lost(Nanoseconds now) const noexcept {
  const InputLevels& inputs = wires_.inputs;
  if (inputs.longest_silence == 0) return false;
  return inputs.lost.load(std::memory_order_relaxed) ||
         now - inputs.looked_at.load(std::memory_order_relaxed) > inputs.longest_silence;
}

void Loop::command(bool last) noexcept {
  Commands& commands = wires_.commands.draft();
  commands.at = woken_;
  for (std::size_t i = 0; i < channels_; ++i) {
    const control::ChannelOutput& channel = output_.channels[i];
    commands.command_kpa[i] = last ? channel.safe_kpa : channel.command_kpa;
    commands.safe_kpa[i] = channel.safe_kpa;
  }
  commands.may_rise = !last && control::may_rise(output_.state);
  commands.inhibit = inhibit_;
  commands.last = last;
  wires_.commands.publish();
}

void Loop::tell_events() noexcept {
  for (const control::Event& event : output_.events) wires_.events.push({woken_, event});
  if (output_.events.lost() > 0) add(wires_.events_dropped, output_.events.lost());
}

void Loop::record_rows(bool last) noexcept {
  const bool room = wires_.records.push(channels_, [&](Record& row, std::size_t i) {
    row = {woken_, output_.state, static_cast<std::uint8_t>(i), output_.channels[i]};
    // The recording ends with what the board was left with.
    if (last) row.output.command_kpa = row.output.safe_kpa;
  });
  if (!room) add(wires_.records_dropped, channels_);
}

void Loop::show(const control::BusHealth& bus) noexcept {
  Snapshot& snapshot = wires_.snapshot.draft();
  snapshot.at = woken_;
  snapshot.ticks = ticks_;
  snapshot.state = output_.state;
  snapshot.first_fault = output_.first_fault;
  snapshot.cause = output_.cause;
  snapshot.under_pressure = output_.under_pressure;
  snapshot.channel_count = channels_;
  std::copy_n(output_.channels.begin(), channels_, snapshot.channels.begin());
  snapshot.bus = bus;
  wires_.snapshot.publish();
  wires_.under_pressure.store(output_.under_pressure != 0, std::memory_order_relaxed);
  wires_.state.store(output_.state, std::memory_order_relaxed);
}

void Loop::count_slips(std::uint64_t skipped, bool woken_late) noexcept {
  slipped_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(skipped, UINT32_MAX));
  (woken_late ? statistics_.slips_woken_late : statistics_.slips_took_long).add(skipped);
}

void Loop::leave() noexcept {
  woken_ = clock_.now();
  command(true);
  record_rows(true);
}

}  // namespace softgrip::daemon
