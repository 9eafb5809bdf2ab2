#include "daemon/loop/loop.h"

#include <algorithm>
#include <array>
#include <span>

namespace softgrip::daemon {

namespace {

/// Places of the recorder's ring that rows may not take, so that events always find one.
constexpr std::size_t places_for_events = 256;

bool moves(control::State state) noexcept {
  return state == control::State::resynchronising || state == control::State::running ||
         state == control::State::stopping;
}

/// The loop is the only writer; a locked addition is not needed.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t amount) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
}

}  // namespace

Loop::Loop(control::RigController& controller, std::size_t channels, std::uint32_t decimation,
           const Clock& clock, Wires& wires, LoopStatistics& statistics) noexcept
    : controller_(controller),
      clock_(clock),
      wires_(wires),
      statistics_(statistics),
      channels_(std::min(channels, control::max_channels)),
      decimation_(std::max<std::uint32_t>(decimation, 1)) {}

void Loop::run(Grid grid) noexcept {
  while (!wires_.leave.load(std::memory_order_relaxed)) {
    const Nanoseconds due = grid.due();
    sleep_until(due);
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

  controller_.tick(input, output_);
  command();
  record_events();
  if (ticks_ % decimation_ == 0) record_rows();
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
  // An exchange that hangs reports nothing until its deadline; its cycles are without a good exchange all the
  // same. One missing report is the jitter of two grids.
  if (unreported_ > 1) input.bus.consecutive_failures += unreported_ - 1;
  input.emergency_stop = wires_.inputs.emergency_stop.load(std::memory_order_relaxed);
  input.interlock_open = wires_.inputs.interlock_open.load(std::memory_order_relaxed);
  input.inputs_lost = inputs_lost(input.now);
  input.slipped_cycles = slipped_;
  slipped_ = 0;
  wires_.requests.pop(input.request);

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

void Loop::command() noexcept {
  Commands& commands = wires_.commands.draft();
  commands.at = woken_;
  for (std::size_t i = 0; i < channels_; ++i) commands.command_kpa[i] = output_.channels[i].command_kpa;
  controller_.safe_commands(std::span(commands.safe_kpa).first(channels_));
  commands.moving = moves(output_.state);
  commands.last = false;
  wires_.commands.publish();
}

void Loop::record_events() noexcept {
  for (std::size_t i = 0; i < output_.event_count; ++i) {
    const StampedEvent event{woken_, output_.events[i]};
    if (!wires_.events.push(event)) add(wires_.events_dropped, 1);
    Record record;
    record.at = woken_;
    record.state = output_.state;
    record.is_event = true;
    record.event = event.event;
    if (!wires_.records.push(record)) add(wires_.records_dropped, 1);
  }
  add(wires_.events_dropped, output_.events_lost);
}

void Loop::record_rows() noexcept {
  for (std::size_t i = 0; i < channels_; ++i) {
    rows_[i].at = woken_;
    rows_[i].state = output_.state;
    rows_[i].channel = static_cast<std::uint8_t>(i);
    rows_[i].output = output_.channels[i];
  }
  if (!wires_.records.push(std::span<const Record>(rows_).first(channels_), places_for_events)) {
    add(wires_.records_dropped, channels_);
  }
}

void Loop::show(const control::BusHealth& bus) noexcept {
  Snapshot& snapshot = wires_.snapshot.draft();
  snapshot.at = woken_;
  snapshot.ticks = ticks_;
  snapshot.state = output_.state;
  snapshot.first_fault = output_.first_fault;
  snapshot.channel_count = channels_;
  std::copy_n(output_.channels.begin(), channels_, snapshot.channels.begin());
  snapshot.bus = bus;
  wires_.snapshot.publish();
  wires_.state.store(output_.state, std::memory_order_relaxed);
}

void Loop::count_slips(std::uint64_t skipped, bool woken_late) noexcept {
  slipped_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(skipped, UINT32_MAX));
  (woken_late ? statistics_.slips_woken_late : statistics_.slips_took_long).add(skipped);
}

void Loop::leave() noexcept {
  woken_ = clock_.now();
  Commands& commands = wires_.commands.draft();
  commands.at = woken_;
  controller_.safe_commands(std::span(commands.safe_kpa).first(channels_));
  commands.command_kpa = commands.safe_kpa;
  commands.moving = false;
  commands.last = true;

  wires_.commands.publish();

  // The recording ends with what the board was left with.
  for (std::size_t i = 0; i < channels_; ++i) output_.channels[i].command_kpa = commands.safe_kpa[i];
  record_rows();
}

}  // namespace softgrip::daemon
