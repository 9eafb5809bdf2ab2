#pragma once
// The bus thread: exchanges with the board in step with the loop, and rebuilds a lost session by itself.

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "base/clock.h"
#include "base/grid.h"
#include "control/elements/fault.h"
#include "daemon/loop/statistics.h"
#include "daemon/loop/wires.h"
#include "drivers/board/board.h"
#include "rig/loop_settings.h"

namespace softgrip::daemon {

/// What a failed exchange means to the supervisor; none for ok.
[[nodiscard]] control::FaultCode fault_of(drivers::BusStatus status) noexcept;

/// The only one that talks to the board. It writes nothing before the loop has sent its first commands, which
/// are safe ones. When the loop falls silent while the board is there, it writes the safe outputs that came
/// with the last commands, reports cycles_lost, and goes back to the loop's commands only when these no
/// longer move.
class Bus {
 public:
  /// All references outlive the bus.
  Bus(drivers::Board& board, const rig::LoopSettings& loop, const rig::ReconnectSettings& reconnect,
      const Clock& clock, Wires& wires, BusStatistics& statistics) noexcept;

  /// Tries to open the session before the first step, so that what connecting measures is known. Blocks up to
  /// connect_deadline.
  bool open() noexcept { return ensure_session(); }

  /// Steps on the grid until the last commands were confirmed or `leave_deadline` has passed since the loop
  /// was told to leave.
  void run(Grid grid, std::chrono::nanoseconds leave_deadline) noexcept;

  /// One exchange, or one attempt to rebuild the session if it is due. `due` is when it should have begun.
  void step(Nanoseconds due) noexcept;

 private:
  bool fetch_commands() noexcept;
  bool ensure_session() noexcept;
  void put_off_next_attempt() noexcept;
  void exchange() noexcept;
  void note_failure(drivers::BusStatus status) noexcept;
  void tell(BusEvent::Kind kind, drivers::BusStatus status, const char* detail = "") noexcept;
  void publish() noexcept;

  drivers::Board& board_;
  const rig::LoopSettings& loop_;
  const rig::ReconnectSettings& reconnect_;
  const Clock& clock_;
  Wires& wires_;
  BusStatistics& statistics_;
  std::size_t channels_;

  /// With the board.
  enum class Session : std::uint8_t {
    none,    // to be opened when the next attempt is due
    opened,  // connect() succeeded
    proven,  // and an exchange in it was good
  };
  /// Whose outputs are written.
  enum class Hearing : std::uint8_t {
    nothing_yet,  // nobody's: the loop has not sent anything
    commands,     // the loop's
    silence,      // the safe ones that came with the loop's last commands
  };

  BusReport report_;
  Session session_ = Session::none;
  Hearing hearing_ = Hearing::nothing_yet;
  std::uint32_t unheard_ = 0;                           // steps since the loop's last commands
  bool told_failed_ = false;                            // the log knows about the present failure
  control::FaultCode said_ = control::FaultCode::none;  // by the board, and still to be reported ...
  std::uint32_t repeats_ = 0;                           // ... so often
  Nanoseconds pause_ = 0;                               // before the attempt after the next
  Nanoseconds next_attempt_ = 0;
};

}  // namespace softgrip::daemon
