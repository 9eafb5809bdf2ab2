#pragma once
// State that the loop shares with the threads around it. One thread writes each member. One thread reads each
// TripleBuffer and each Ring. The log and the recorder both read the events of the loop. Any thread may read
// an atomic.

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>

#include "control/tick/tick.h"
#include "daemon/loop/broadcast.h"
#include "daemon/loop/ring.h"
#include "daemon/loop/triple_buffer.h"
#include "drivers/board/board.h"
#include "model/reading.h"

namespace softgrip::daemon {

/// From the loop to the bus: the outputs for the board.
struct Commands {
  Nanoseconds at = 0;  ///< scheduled time of the tick that computed them
  std::array<double, control::max_channels> command_kpa{};
  /// The output if the loop stops sending commands.
  std::array<double, control::max_channels> safe_kpa{};
  bool may_rise = false;      ///< a sequence runs; if not, a command further from rest is an old one that
                              ///< arrived late
  std::uint32_t inhibit = 0;  ///< control::BusHealth::inhibit that this tick had read
  bool last = false;          ///< the loop has ended; the bus writes these commands until the board confirms
                              ///< them
};

/// From the bus to the loop: readings and state of the bus.
struct BusReport {
  static constexpr auto anything = [] {
    std::array<double, control::max_channels> outputs_kpa{};
    outputs_kpa.fill(std::numeric_limits<double>::infinity());
    return outputs_kpa;
  }();
  std::array<model::Reading, control::max_channels> readings{};
  /// Bound of the outputs [kPa]: no output is nearer to rest than this. The bound is the last write. If the
  /// board has not confirmed the last write, it is the one of the last two writes that is nearer to rest. If
  /// these writes are on different sides of rest, or if the board's watchdog has acted, it is the rest
  /// pressure. Before the first write it is infinite.
  std::array<double, control::max_channels> outputs_kpa = anything;
  control::BusHealth health;
};

/// From the bus to the log: a change of the bus.
struct BusEvent {
  enum class Kind : std::uint8_t {
    connected,       ///< the board has answered in a new session
    failed,          ///< the first failure after a successful exchange, with `status` and `detail`
    recovered,       ///< the first successful exchange after failures
    loop_silent,     ///< no new commands from the loop: the safe outputs are written
    loop_back,       ///< the loop's commands are written again
    another_client,  ///< another client feeds the board's watchdog; `detail`: number of clients
    not_connected,   ///< no session can be opened again, and the reason differs from that of `failed`
  };
  Kind kind = Kind::connected;
  Nanoseconds at = 0;
  drivers::BusStatus status = drivers::BusStatus::ok;
  std::array<char, 256> detail{};  ///< message of the board, terminated by 0
};

/// From the loop to the recorder: a row of one channel.
struct Record {
  Nanoseconds at = 0;
  control::State state = control::State::starting;
  std::uint8_t channel = 0;
  control::ChannelOutput output;
};

/// From the loop to the log and to the recorder: an event. The events of a tick are pushed before its rows.
struct StampedEvent {
  Nanoseconds at = 0;
  control::Event event;
};

/// One tick, from the loop to the readers of the status.
struct Snapshot {
  Nanoseconds at = 0;
  std::uint64_t ticks = 0;
  control::State state = control::State::starting;
  control::Fault first_fault;
  control::Fault cause;              ///< present condition that is a fault or may become one
  std::uint32_t under_pressure = 0;  ///< as in control::TickOutput
  std::size_t channel_count = 0;
  std::array<control::ChannelOutput, control::max_channels> channels{};
  control::BusHealth bus;
};

/// Inputs that are levels, not requests. The thread that reads the digital lines (daemon/panel/panel.h)
/// stores them.
struct InputLevels {
  std::atomic<bool> emergency_stop{false};
  std::atomic<bool> interlock_open{false};
  std::atomic<bool> lost{false};          ///< the lines cannot be read
  std::atomic<Nanoseconds> looked_at{0};  ///< time of the last read of the lines
  /// The lines are lost if the last read is older than this [ns]; 0: there are no lines.
  Nanoseconds longest_silence = 0;
};

/// From the reader of the digital lines to the log.
struct PanelEvent {
  enum class Kind : std::uint8_t {
    emergency_stop_pressed,
    emergency_stop_released,
    part_in_position,
    part_away,
    enable_on,
    enable_off,
    loop_hangs,  ///< no tick for too long: the enable output was switched off
    gpio_lost,   ///< the chip failed
  };
  Kind kind = Kind::gpio_lost;
  Nanoseconds at = 0;
};

struct SharedState {
  /// `record_capacity`: largest number of rows by which the recorder may lag. `event_capacity`: largest
  /// number of events by which a reader may lag.
  explicit SharedState(std::size_t record_capacity, std::size_t event_capacity = 4096)
      : records(record_capacity), events(event_capacity) {}

  TripleBuffer<Commands> commands;
  TripleBuffer<BusReport> bus;
  TripleBuffer<Snapshot> snapshot;
  Ring<BusEvent> bus_events{256};
  Ring<Record> records;
  Broadcast<StampedEvent> events;
  Ring<PanelEvent> panel_events{64};
  Ring<control::Request> vents{16};  ///< requests to vent; read first
  Ring<control::Request> stops{16};  ///< requests to stop any sequence; read second
  /// Requests to stop one given start, at most one for each start; read third. The capacity covers all
  /// waiting starts and some that were read a moment ago.
  Ring<control::Request> named_stops{128};
  Ring<control::Request> requests{64};
  std::atomic<control::State> state{control::State::starting};  ///< state in the last tick
  std::atomic<bool> under_pressure{false};                      ///< a finger is pressurised without motion
  std::atomic<bool> enable_on{false};                           ///< last written level of the enable output
  InputLevels inputs;
  std::atomic<std::uint64_t> records_dropped{0};  ///< rows dropped because the recorder lagged
  std::atomic<std::uint64_t> events_dropped{0};   ///< events dropped because a tick had more events than its
                                                  ///< capacity
  std::atomic<bool> shutdown_requested{false};    ///< to the loop: end after a last, safe tick
  std::atomic<bool> safe_state_confirmed{false};  ///< from the bus: the board confirmed the last commands
};

}  // namespace softgrip::daemon
