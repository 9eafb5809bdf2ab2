#pragma once
// The daemon without its command line: creates board, loop, bus, recorder and socket from a rig file.
// `softgripd` and `softgrip run` use this class.

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
  std::string program = "softgripd";  ///< name of the program, used in messages
  /// Runs as fast as possible, without sleeping and without the machine's clock. Equal seeds give equal
  /// results. Requires a simulated board, and has no socket.
  bool virtual_time = false;
  std::shared_ptr<const LoadedSequence> sequence;  ///< sequence that is started when the rig is idle; run()
                                                   ///< ends after this sequence
  std::optional<double> duration_s;  ///< run() ends after this time; in virtual time, a sequence or a
                                     ///< duration is required
  std::string record_folder;         ///< if it is not empty, all data are recorded in this folder
  bool listen = true;                ///< true: the daemon opens the socket that the rig file gives
  /// Opens the digital lines; if it is empty, the lines of this machine's GPIO chips are opened.
  std::function<tl::expected<std::unique_ptr<drivers::GpioLines>, drivers::GpioFailure>(
      std::span<const drivers::GpioLineSettings>)>
      open_gpio;
  /// Called for each event, in the order of the events, in the thread that called run().
  std::function<void(const EventEntry&)> on_event;
  /// Called once with the start-up report, after the set-up and before any motion, in the thread that called
  /// run().
  std::function<void(const std::string&)> on_start;
};

/// The reason why run() ended.
enum class Ending : std::uint8_t {
  asked,              ///< a signal or the duration ended a run that had no sequence
  interrupted,        ///< a signal or the duration ended the run before the end of its sequence
  sequence_ended,     ///< the sequence of the run ended; see Outcome::sequence_end
  sequence_refused,   ///< the state of the rig did not permit the start
  not_idle,           ///< the rig did not become idle in time, so the sequence was not started
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
  /// `faulted` also if a fault latched after the last step and before the end of the run.
  std::optional<control::SequenceEnd> sequence_end;
  Snapshot last;  ///< state of the rig after the last tick
  std::vector<std::string> channel_names;
  std::string recording_error;        ///< reason why record_folder is incomplete; empty if it is complete
  bool safe_state_confirmed = false;  ///< true: at the end, the board confirmed the safe outputs
  bool pressure_left_on = false;      ///< true: the safe output of at least one channel is a pressure that
                                      ///< differs from rest (control::pressed())
  double vents_after_s = 0;           ///< time until the board's watchdog vents the channels under pressure
                                      ///< [s]; 0: the board never vents them
  int signal = 0;  ///< first signal that requested the end before the outputs were safe; 0: there was none
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;
  double wall_s = 0;  ///< elapsed time of the run on the wall clock
};

/// Returns false if run() ended before the board was opened. In this case, the outputs of the board are
/// unknown.
[[nodiscard]] bool reached_the_board(Ending ending) noexcept;

/// Returns the exit code for the result of a run: 0, 1, 3, 4, 5 or 6. The manual describes these codes.
[[nodiscard]] ExitCode exit_code_of(const Outcome& outcome) noexcept;

/// Creates the board of a rig file. The board is not connected yet. `clock` must exist longer than the board.
[[nodiscard]] std::unique_ptr<drivers::Board> make_board(const rig::RigFile& rig, const Clock& clock);

struct DaemonParts;  // daemon_parts.h defines this struct

class Daemon {
 public:
  /// Creates the daemon. `rig` must be valid. The error is a sentence. Errors are virtual time with a real
  /// board, virtual time without a sequence or a duration, and a folder that already contains a recording.
  [[nodiscard]] static tl::expected<std::unique_ptr<Daemon>, std::string> create(rig::RigFile rig,
                                                                                 DaemonOptions options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  Daemon(Daemon&&) = delete;
  Daemon& operator=(Daemon&&) = delete;
  ~Daemon();

  /// Runs until a signal (see Signals), or until the end that the options give. At the end, the board has its
  /// safe outputs. The signals are blocked in the calling thread and in the threads of the daemon.
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
/// A function with the same result as run_daemon(). Tests replace run_daemon() by another function.
using DaemonRunner =
    std::function<tl::expected<Outcome, std::string>(rig::RigFile rig, DaemonOptions options)>;

}  // namespace softgrip::daemon
