#include "daemon/loop/loop.h"

#include <algorithm>
#include <span>

#include "control/tick/rig_controller.h"

namespace softgrip::daemon {

namespace {

/// The loop is the only thread that writes the counter, so a load and a store can replace an atomic addition.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t amount) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
}

}  // namespace

Loop::Loop(control::RigController& controller, std::uint32_t decimation, const Clock& clock,
           SharedState& shared, LoopStatistics& statistics) noexcept
    : controller_(controller),
      clock_(clock),
      shared_(shared),
      statistics_(statistics),
      output_(controller.output()),
      channels_(output_.channel_count),
      decimation_(std::max<std::uint32_t>(decimation, 1)) {}

void Loop::run(PeriodicSchedule schedule) noexcept {
  while (!shared_.shutdown_requested.load(std::memory_order_relaxed)) {
    const Nanoseconds due = schedule.due();
    clock_.sleep_until(due);
    tick(due);
    count_overruns(schedule.advance(ended_), woken_ - due >= schedule.period());
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
  unreported_ = shared_.bus.fetch() ? 0 : unreported_ + 1;
  const BusReport& report = shared_.bus.value();
  input.readings = std::span(report.readings).first(channels_);
  input.bus = report.health;
  input.outputs_kpa = std::span(report.outputs_kpa).first(channels_);
  inhibit_ = report.health.inhibit;
  // A blocked exchange reports nothing until its deadline, so the loop counts each cycle without a report as
  // failed. One missing report is not a failure, because it can come from the jitter between the schedules of
  // loop and bus.
  if (unreported_ > 1) input.bus.consecutive_failures += unreported_ - 1;
  input.emergency_stop = shared_.inputs.emergency_stop.load(std::memory_order_relaxed);
  input.interlock_open = shared_.inputs.interlock_open.load(std::memory_order_relaxed);
  input.inputs_lost = inputs_lost(input.now);
  input.overrun_cycles = overrun_cycles_;
  overrun_cycles_ = 0;
  if (!shared_.vents.pop(input.request) && !shared_.stops.pop(input.request) &&
      !shared_.named_stops.pop(input.request)) {
    shared_.requests.pop(input.request);
  }

  Nanoseconds oldest = input.now;
  for (const model::Reading& reading : input.readings) oldest = std::min(oldest, reading.sampled_at);
  if (oldest > 0) statistics_.reading_age.add(input.now - oldest);
}

bool Loop::inputs_lost(Nanoseconds now) const noexcept {
  const InputLevels& inputs = shared_.inputs;
  if (inputs.longest_silence == 0) return false;
  return inputs.lost.load(std::memory_order_relaxed) ||
         now - inputs.looked_at.load(std::memory_order_relaxed) > inputs.longest_silence;
}

void Loop::command(bool last) noexcept {
  Commands& commands = shared_.commands.write_slot();
  commands.at = woken_;
  for (std::size_t i = 0; i < channels_; ++i) {
    const control::ChannelOutput& channel = output_.channels[i];
    commands.command_kpa[i] = last ? channel.safe_kpa : channel.command_kpa;
    commands.safe_kpa[i] = channel.safe_kpa;
  }
  commands.may_rise = !last && control::may_rise(output_.state);
  commands.inhibit = inhibit_;
  commands.last = last;
  shared_.commands.publish();
}

void Loop::tell_events() noexcept {
  for (const control::Event& event : output_.events) shared_.events.push({woken_, event});
  if (output_.events.lost() > 0) add(shared_.events_dropped, output_.events.lost());
}

void Loop::record_rows(bool last) noexcept {
  const bool room = shared_.records.push(channels_, [&](Record& row, std::size_t i) {
    row = {.at = woken_,
           .state = output_.state,
           .channel = static_cast<std::uint8_t>(i),
           .output = output_.channels[i]};
    // The last row of the recording must contain the last outputs of the board.
    if (last) row.output.command_kpa = row.output.safe_kpa;
  });
  if (!room) add(shared_.records_dropped, channels_);
}

void Loop::show(const control::BusHealth& bus) noexcept {
  Snapshot& snapshot = shared_.snapshot.write_slot();
  snapshot.at = woken_;
  snapshot.ticks = ticks_;
  snapshot.state = output_.state;
  snapshot.first_fault = output_.first_fault;
  snapshot.cause = output_.cause;
  snapshot.under_pressure = output_.under_pressure;
  snapshot.channel_count = channels_;
  std::copy_n(output_.channels.begin(), channels_, snapshot.channels.begin());
  snapshot.bus = bus;
  shared_.snapshot.publish();
  shared_.under_pressure.store(output_.under_pressure != 0, std::memory_order_relaxed);
  shared_.state.store(output_.state, std::memory_order_relaxed);
}

void Loop::count_overruns(std::uint64_t skipped, bool woken_late) noexcept {
  overrun_cycles_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(skipped, UINT32_MAX));
  (woken_late ? statistics_.overruns_woken_late : statistics_.overruns_took_long).add(skipped);
}

void Loop::leave() noexcept {
  woken_ = clock_.now();
  command(true);
  record_rows(true);
}

}  // namespace softgrip::daemon
