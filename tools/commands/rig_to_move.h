#pragma once
// Opens the rig of a rig file for a command that moves it, and checks that the motion is allowed.

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "base/clock.h"
#include "base/exit_code.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/signals.h"
#include "rig/rig_file.h"
#include "tools/commissioning/motion_session.h"
#include "tools/commissioning/procedure.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {

/// Reads a rig file and prints its warnings. If the file is unreadable or invalid, prints the reason and
/// returns the exit code.
[[nodiscard]] tl::expected<rig::RigFile, ExitCode> read_rig(const std::string& path);

/// The board of a rig in manual mode. Until the object is destroyed, no other program can use the board, and
/// a signal such as Ctrl-C ends the session.
class ManualRig {
 public:
  /// Locks the board and connects to it. If `move` is true, also opens the digital lines of the rig; without
  /// these lines, a rig with an emergency stop or an enable output is not moved. `rig` must outlive the
  /// result.
  [[nodiscard]] static calibrate::Expected<std::unique_ptr<ManualRig>> open(const rig::RigFile& rig,
                                                                            bool move);

  [[nodiscard]] MotionSession& session() { return session_; }
  [[nodiscard]] const drivers::Board& board() const { return *board_; }
  [[nodiscard]] const Clock& clock() const { return clock_; }
  /// Returns true after a signal has requested the end of the session.
  [[nodiscard]] bool stopped() { return signals_.first() != 0; }

 private:
  ManualRig(const rig::RigFile& rig, daemon::BoardLock lock, std::unique_ptr<drivers::GpioLines> lines);

  daemon::BoardLock lock_;
  MonotonicClock clock_;
  std::unique_ptr<drivers::Board> board_;
  std::unique_ptr<drivers::GpioLines> lines_;
  daemon::Signals signals_;
  MotionSession session_;
};

/// Prints that the board does not respond while the fingers are set to their rest pressures.
void tell_silence(const std::string& why);

/// Returns a function that requests consent on the terminal. With `yes`, the function always consents.
[[nodiscard]] Consent consent_on_terminal(bool yes);

/// Opens the rig of a file and selects a channel; "" selects the only channel. Prints the reason and returns
/// an exit code in four cases. The file is unreadable or invalid. The channel does not exist. No terminal is
/// available for the consent. softgripd or another program uses the board; this case is impossible for a rig
/// that is simulated in the process.
[[nodiscard]] tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path,
                                                                const std::string& channel, bool yes);

/// Returns a function that reads the sensor through the board. The outputs stay at the rest pressures, so the
/// rig moves nothing.
[[nodiscard]] GaugeTaker gauge_by_hand(ExperimentRig rig, Consent consent);

}  // namespace softgrip::tools
