#pragma once
// The state that the loop shares with other threads. Each member has exactly one writing thread. Each
// TripleBuffer and each Ring has exactly one reading thread. The events of the loop have two readers: the
// event log and the recorder. Any thread may read an atomic member.

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

/// Passed from the loop to the bus: the outputs for the board.
struct Commands {
  Nanoseconds at = 0;  ///< time at which the tick that computed the commands started
  std::array<double, control::max_channels> command_kpa{};
  /// Outputs that the bus writes if the loop stops sending commands.
  std::array<double, control::max_channels> safe_kpa{};
  bool may_rise = false;  ///< true: a sequence was started and has not ended, so commands may move away from
                          ///< rest; false: a command that is further from rest than the outputs is an old
                          ///< command that arrived late
  std::uint32_t inhibit = 0;  ///< value of control::BusHealth::inhibit that the loop had read in this tick
  bool last = false;          ///< true: the loop has ended, and the bus writes these commands until the board
                              ///< confirms them
};

/// Passed from the bus to the loop: readings and the state of the bus.
struct BusReport {
  static constexpr auto anything = [] {
    std::array<double, control::max_channels> outputs_kpa{};
    outputs_kpa.fill(std::numeric_limits<double>::infinity());
    return outputs_kpa;
  }();
  std::array<model::Reading, control::max_channels> readings{};
  /// Assumed pressure of each output [kPa]. A command that may not move the output away from rest must lie
  /// between the rest pressure and this pressure. After a confirmed write, this is the written pressure.
  /// After an unconfirmed write, this is the one of the last two written pressures that is nearer to rest. If
  /// these two pressures are on different sides of rest, or if the board's watchdog has acted, this is the
  /// rest pressure. Infinity, before the first write: the output is not known, so it does not limit the
  /// command.
  std::array<double, control::max_channels> outputs_kpa = anything;
  control::BusHealth health;
};

/// Passed from the bus to the event log: a change of the state of the bus.
struct BusEvent {
  enum class Kind : std::uint8_t {
    connected,  ///< the board has responded on a new connection
    failed,  ///< the first failure since the start or since a successful exchange; `status` and `detail` give
             ///< the reason
    recovered,       ///< the first successful exchange after a failure
    loop_silent,     ///< the commands of the loop timed out, so the safe outputs are written
    loop_back,       ///< the commands of the loop are written again
    another_client,  ///< another client feeds the board's watchdog; `detail` is the number of clients
    not_connected,   ///< no new connection can be opened, and the reason is not the reason that `failed` has
                     ///< reported
  };
  Kind kind = Kind::connected;
  Nanoseconds at = 0;
  drivers::BusStatus status = drivers::BusStatus::ok;
  std::array<char, 256> detail{};  ///< message of the board's driver; ends with a zero byte
};

/// Passed from the loop to the recorder: a row of one channel.
struct Record {
  Nanoseconds at = 0;
  control::State state = control::State::starting;
  std::uint8_t channel = 0;
  control::ChannelOutput output;
};

/// Passed from the loop to the event log and to the recorder: an event. The events of a tick are pushed
/// before the rows of the tick.
struct StampedEvent {
  Nanoseconds at = 0;
  control::Event event;
};

/// The state after one tick, passed from the loop to the readers of the status.
struct Snapshot {
  Nanoseconds at = 0;
  std::uint64_t ticks = 0;
  control::State state = control::State::starting;
  control::Fault first_fault;
  control::Fault cause;  ///< present condition that is a fault, or can become a fault if the condition lasts
  std::uint32_t under_pressure = 0;  ///< channels under pressure that do not move; bit mask as in
                                     ///< control::TickOutput
  std::size_t channel_count = 0;
  std::array<control::ChannelOutput, control::max_channels> channels{};
  control::BusHealth bus;
};

/// Levels of the digital inputs, which the loop reads in each tick. The thread that reads the digital lines
/// (daemon/panel/panel.h) writes them.
struct InputLevels {
  std::atomic<bool> emergency_stop{false};
  std::atomic<bool> interlock_open{false};
  std::atomic<bool> lost{false};          ///< true: the digital lines cannot be read
  std::atomic<Nanoseconds> looked_at{0};  ///< time at which the digital lines were last read
  /// largest permitted age of the last read of the digital lines [ns]; if the read is older, the lines count
  /// as lost; 0: the rig has no digital lines
  Nanoseconds longest_silence = 0;
};

/// Passed from the reader of the digital lines to the event log.
struct PanelEvent {
  enum class Kind : std::uint8_t {
    emergency_stop_pressed,
    emergency_stop_released,
    part_in_position,
    part_away,
    enable_on,
    enable_off,
    loop_hangs,  ///< the loop has executed no tick for too long, so the enable output was switched off
    gpio_lost,   ///< the GPIO chip failed
  };
  Kind kind = Kind::gpio_lost;
  Nanoseconds at = 0;
};

struct SharedState {
  /// `record_capacity` is the largest number of rows by which the recorder may lag. `event_capacity` is the
  /// largest number of events by which a reader may lag.
  explicit SharedState(std::size_t record_capacity, std::size_t event_capacity = 4096)
      : records(record_capacity), events(event_capacity) {}

  TripleBuffer<Commands> commands;
  TripleBuffer<BusReport> bus;
  TripleBuffer<Snapshot> snapshot;
  Ring<BusEvent> bus_events{256};
  Ring<Record> records;
  Broadcast<StampedEvent> events;
  Ring<PanelEvent> panel_events{64};
  Ring<control::Request> vents{16};  ///< requests to vent; the loop reads this queue first
  Ring<control::Request> stops{16};  ///< requests to stop any running sequence; the loop reads this queue
                                     ///< second
  /// Requests to stop one particular start, at most one request per start; the loop reads this queue third.
  /// The queue has space for a request for each waiting start, and for some starts that the loop has just
  /// read.
  Ring<control::Request> named_stops{128};
  Ring<control::Request> requests{64};
  std::atomic<control::State> state{control::State::starting};  ///< state of the supervisor in the last tick
  std::atomic<bool> under_pressure{false};                      ///< true: a finger is pressurised but does
                                                                ///< not move
  std::atomic<bool> enable_on{false};                           ///< level of the enable output that was
                                                                ///< written last
  InputLevels inputs;
  std::atomic<std::uint64_t> records_dropped{0};  ///< number of rows that were dropped because the recorder
                                                  ///< lagged
  std::atomic<std::uint64_t> events_dropped{0};   ///< number of events that were dropped because one tick had
                                                  ///< too many events
  std::atomic<bool> shutdown_requested{false};    ///< request to the loop to send the safe outputs and to end
  std::atomic<bool> safe_state_confirmed{false};  ///< set by the bus when the board has confirmed the last
                                                  ///< commands
};

}  // namespace softgrip::daemon
