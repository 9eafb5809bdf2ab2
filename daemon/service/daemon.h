#pragma once
// softgripd without its command line: board, loop, bus, recorder and socket put together from a rig file.
// `softgripd` and `softgrip run` are this.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/clock.h"
#include "base/exit_code.h"
#include "daemon/loop/shared_state.h"
#include "daemon/loop/statistics.h"
#include "daemon/recording/event_log.h"
#include "daemon/socket/one_shot_run.h"
#include "daemon/socket/sequence_loader.h"
#include "drivers/board/board.h"
#include "drivers/gpio/gpio_lines.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

struct DaemonOptions {
  std::string program = "softgripd";  ///< what it calls itself
  /// No sleeping and no clock: as fast as the processor, and the same bytes from the same seed. Only with a
  /// simulated board; nothing listens on the socket.
  bool virtual_time = false;
  std::shared_ptr<const LoadedSequence> sequence;  ///< started when the rig is idle; run() ends after it
  std::optional<double> duration_s;  ///< run() ends after it; in virtual time one of the two is needed
  std::string record_folder;         ///< everything is recorded into this one folder
  bool listen = true;                ///< on the socket of the rig file
  /// Where the digital lines come from; without it the GPIO chips of this machine.
  std::function<tl::expected<std::unique_ptr<drivers::GpioLines>, drivers::GpioFailure>(
      std::span<const drivers::GpioLineSettings>)>
      open_gpio;
  /// Called in the thread that called run(), for every event, in order.
  std::function<void(const EventEntry&)> on_event;
  /// Called once in the thread that called run(), when all is set up and before anything moves: the start-up
  /// report.
  std::function<void(const std::string&)> on_start;
};

/// Why run() ended.
enum class Ending : std::uint8_t {
  asked,              ///< by a signal, or the duration is over; no sequence was to run
  interrupted,        ///< by a signal or the duration, before the sequence had ended
  sequence_ended,     ///< see Outcome::sequence_end
  sequence_refused,   ///< by the state of the rig
  not_idle,           ///< the rig did not become idle, so the sequence was not started
  real_time_refused,  ///< `real_time: required: true`, and something could not be verified
  socket_failed,      ///< the socket could not be opened
  board_taken,        ///< another program drives the board
  gpio_refused,       ///< the rig file names a digital line that is not there, or not like that
  gpio_failed,        ///< a digital line is in use, or this user may not have it
  broken,             ///< an exception in a thread, or a loop that did not end
};

/// The result of a run.
struct Outcome {
  Ending ending = Ending::asked;
  std::string message;  ///< one sentence where something went wrong
  /// `faulted` also if the fault was latched after the last step and before the end of the run.
  std::optional<control::SequenceEnd> sequence_end;
  Snapshot last;  ///< the last tick
  std::vector<std::string> channel_names;
  std::string recording_error;        ///< why record_folder does not hold all of the run; empty: it does
  bool safe_state_confirmed = false;  ///< the board confirmed the safe outputs at the end
  bool pressure_left_on = false;      ///< control::pressed() of the safe output of a channel
  double vents_after_s = 0;  ///< pressure was left on, and the board's watchdog vents it so soon; 0: neither
  int signal = 0;  ///< the first signal that requested the end, until the outputs were safe; 0: none
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;
  double wall_s = 0;  ///< how long it took
};

/// False where run() ended before the board was opened: then nothing is to be said of its outputs.
[[nodiscard]] bool reached_the_board(Ending ending) noexcept;

/// 0, 1, 3, 4, 5 or 6: see the exit codes of the manual.
[[nodiscard]] ExitCode exit_code_of(const Outcome& outcome) noexcept;

/// The board of a rig file, not yet connected. `clock` outlives it.
[[nodiscard]] std::unique_ptr<drivers::Board> make_board(const rig::RigFile& rig, const Clock& clock);

struct DaemonParts;  // daemon_parts.h

class Daemon {
 public:
  /// `rig` is valid. The error is a sentence: virtual time with a real board, or without an end; a folder
  /// that holds a recording already.
  [[nodiscard]] static tl::expected<std::unique_ptr<Daemon>, std::string> create(rig::RigFile rig,
                                                                                 DaemonOptions options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  Daemon(Daemon&&) = delete;
  Daemon& operator=(Daemon&&) = delete;
  ~Daemon();

  /// Runs until a signal (see Signals) or what the options say, then leaves the board with its safe outputs.
  /// Blocks these signals in the calling thread and in its own while it runs.
  Outcome run();

  [[nodiscard]] const LoopStatistics& loop_statistics() const noexcept;
  [[nodiscard]] const BusStatistics& bus_statistics() const noexcept;

 private:
  explicit Daemon(std::unique_ptr<DaemonParts> parts);
  std::unique_ptr<DaemonParts> parts_;
};

/// Creates a daemon and runs it to its end. The error is that of Daemon::create().
[[nodiscard]] tl::expected<Outcome, std::string> run_daemon(rig::RigFile rig, DaemonOptions options);
/// run_daemon(), or what a test has in its place.
using DaemonRunner =
    std::function<tl::expected<Outcome, std::string>(rig::RigFile rig, DaemonOptions options)>;

}  // namespace softgrip::daemon
