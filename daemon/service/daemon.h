#pragma once
// The daemon without its command line: creates board, loop, bus, recorder and socket from a rig file.
// `softgripd` and `softgrip run` use this class.
// Builds the report that softgripd or `softgrip run` prints before any motion.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/clock.h"
#include "base/exit_code.h"
#include "daemon/loop/real_time.h"
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
  std::string program = "softgripd";  ///< name of the program, used in messages
  /// Runs as fast as possible, without sleeping and without the machine's clock. Equal seeds give equal
  /// results. Requires a simulated board, and has no socket.
  bool virtual_time = false;
  std::shared_ptr<const LoadedSequence> sequence;  ///< sequence that is started when the rig is idle; run()
                                                   ///< ends after this sequence
  std::optional<double> duration_s;  ///< time after which run() ends [s]; in virtual time, a sequence or a
                                     ///< duration is required
  std::string record_folder;  ///< folder for the recording of all data; empty: the rig file determines the
                              ///< recordings
  bool listen = true;         ///< true: the daemon opens the socket that the rig file specifies
  /// Opens the digital lines; if the function is empty, the lines of this machine's GPIO chips are opened.
  std::function<tl::expected<std::unique_ptr<drivers::GpioLines>, drivers::GpioFailure>(
      std::span<const drivers::GpioLineSettings>)>
      open_gpio;
  /// Called for each event, in the order of the events and in the thread that called run().
  std::function<void(const EventEntry&)> on_event;
  /// Called in the thread that called run(), before the process ends without the end of run(), because one of
  /// its threads hangs. Must write the output of on_event and must return within 1 s.
  std::function<void()> before_sudden_end;
  /// Called once with the start-up report, after the set-up and before any motion, in the thread that called
  /// run().
  std::function<void(const std::string&)> on_start;
};

/// The reason why run() ended.
enum class Ending : std::uint8_t {
  asked,              ///< a signal or the duration ended a run that had no sequence
  interrupted,        ///< a signal or the duration ended the run before the end of its sequence
  sequence_ended,     ///< the sequence of the run ended; Outcome::sequence_end gives its result
  sequence_refused,   ///< the rig was in a state in which a sequence must not start
  not_idle,           ///< the rig did not become idle in time, so the sequence was not started
  board_unreachable,  ///< the rig did not become idle in time, because the board does not respond
  real_time_refused,  ///< the rig file has `real_time: required: true`, and a setting could not be verified
  socket_failed,      ///< the socket of the daemon could not be opened
  board_taken,        ///< another program drives the board
  gpio_refused,       ///< a digital line of the rig file does not exist, or differs from the settings in the
                      ///< rig file
  gpio_failed,        ///< a digital line is in use by another program, or this user has no permission
  broken,             ///< a thread threw an exception, or the loop did not end
};

/// The result of a run.
struct Outcome {
  Ending ending = Ending::asked;
  std::string message;  ///< description of the error in one sentence; empty without an error
  /// Result of the sequence. The value is `faulted` also if a fault latched after the last step and before
  /// the end of the run.
  std::optional<control::SequenceEnd> sequence_end;
  Snapshot last;  ///< state of the rig after the last tick
  std::vector<std::string> channel_names;
  std::string recording_error;        ///< reason why record_folder is incomplete; empty if it is complete
  bool safe_state_confirmed = false;  ///< true: at the end, the board confirmed the safe outputs
  /// A channel whose safe output is a pressure that differs from rest (control::pressed()).
  struct LeftOn {
    std::string channel;
    double pressure_kpa = 0;
  };
  std::vector<LeftOn> left_on;
  double vents_after_s = 0;  ///< time until the board's watchdog vents the channels under pressure [s]; 0: no
                             ///< channel is under pressure, or the board has no watchdog
  int signal = 0;  ///< first signal that requested the end of the run before the outputs were safe; 0: there
                   ///< was none
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;
  double wall_s = 0;  ///< duration of the run on the wall clock [s]
};

/// Returns false if run() ended before the board was opened. In this case, the outputs of the board are
/// unknown.
[[nodiscard]] bool reached_the_board(Ending ending) noexcept;

/// Returns a sentence that names the channels in Outcome::left_on, their pressures, and when the board vents
/// them. Returns "" if there are none, or if the board did not confirm its safe outputs.
[[nodiscard]] std::string left_on_sentence(const Outcome& outcome);

/// Returns the exit code for the result of a run: 0, 1, 3, 4, 5 or 6. The manual describes these codes.
[[nodiscard]] ExitCode exit_code_of(const Outcome& outcome) noexcept;

/// Creates the board of a rig file and does not connect it. `clock` must exist longer than the board.
[[nodiscard]] std::unique_ptr<drivers::Board> make_board(const rig::RigFile& rig, const Clock& clock);

/// The reason why a daemon cannot be created.
struct NotCreated {
  ExitCode code;
  std::string text;  ///< a sentence
};

struct DaemonParts;  // defined in daemon_parts.h

class Daemon {
 public:
  /// Creates the daemon. `rig` must be valid. There is an error if record_folder already contains a
  /// recording, or cannot be created or written. With virtual time, there is also an error in these cases: a
  /// real board; digital lines; neither a sequence nor a duration; a sequence that holds until a release,
  /// without a duration.
  [[nodiscard]] static tl::expected<std::unique_ptr<Daemon>, NotCreated> create(rig::RigFile rig,
                                                                                DaemonOptions options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  Daemon(Daemon&&) = delete;
  Daemon& operator=(Daemon&&) = delete;
  ~Daemon();

  /// Runs until a signal (see Signals), or until the end that the options specify. At the end, the board has
  /// its safe outputs. The signals are blocked in the calling thread and in the threads of the daemon.
  Outcome run();

  [[nodiscard]] const LoopStatistics& loop_statistics() const noexcept;
  [[nodiscard]] const BusStatistics& bus_statistics() const noexcept;

 private:
  explicit Daemon(std::unique_ptr<DaemonParts> parts);
  std::unique_ptr<DaemonParts> parts_;
};

/// Creates a daemon and runs it until it ends. Returns the error of Daemon::create() if the daemon cannot be
/// created.
[[nodiscard]] tl::expected<Outcome, std::string> run_daemon(rig::RigFile rig, DaemonOptions options);
/// Type of run_daemon(). Tests pass another function of this type in place of run_daemon().
using DaemonRunner =
    std::function<tl::expected<Outcome, std::string>(rig::RigFile rig, DaemonOptions options)>;

/// Returns several lines: rate, board, bus budget, latency, watchdog, safe actions and the feedforward of
/// each channel. If `real_time` is not nullptr, the lines contain the real-time settings. `real_time` is
/// nullptr in virtual time and for `--check`. `program` is the name of the program that drives the rig.
[[nodiscard]] std::string startup_report(const rig::RigFile& rig, const drivers::Board& board,
                                         const RealTimeReport* real_time, std::string_view program);

}  // namespace softgrip::daemon
