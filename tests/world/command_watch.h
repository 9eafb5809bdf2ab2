#pragma once
// Checks the invariants of softgrip-plc. Each counter value executes at most one command, and this command
// was sent by a master. After a stop or a vent, no earlier start takes effect. If a master becomes silent, a
// daemon receives the stop that the gateway sends.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "tests/world/master_in_world.h"

namespace softgrip::world {

class CommandWatch {
 public:
  explicit CommandWatch(Nanoseconds silence) : silence_(silence) {}

  std::function<void(const char* invariant, std::string text)> on_break;

  /// Returns the index that the next requested command will get.
  [[nodiscard]] int next_number() const noexcept { return static_cast<int>(commands_.size()); }
  void ask(std::uint16_t code, std::uint16_t counter) { commands_.push_back({code, counter}); }
  /// Called when the gateway has received a block of registers with this command.
  void arrived(int command);
  /// Called when the gateway sends a message to the daemon. `cause` is the block of registers that made the
  /// gateway send the message; nullopt: the gateway sends the message without a block.
  void sent(const nlohmann::ordered_json& line, const std::optional<Block>& cause, Nanoseconds now);
  /// Called when the gateway receives a message from the daemon.
  void answered(const nlohmann::ordered_json& line);
  void daemon_died();
  /// Called when the gateway process dies. The next gateway process does not know the earlier commands.
  void gateway_died();
  void read_refused(int command);
  void read_accepted(std::uint16_t code, std::uint16_t counter);

  /// Called when a master's heartbeat has changed.
  void beat(Nanoseconds now);
  void look(Nanoseconds now);
  /// Called when simulated time has passed. `undisturbed` is true if no incident affects the gateway or the
  /// daemon.
  void passed(Nanoseconds now, bool undisturbed);

  /// Returns the number of stop and vent commands that have been executed.
  [[nodiscard]] std::uint64_t halts() const noexcept { return halts_; }
  [[nodiscard]] std::uint64_t asked() const noexcept { return commands_.size(); }
  [[nodiscard]] std::uint64_t executed() const noexcept { return executed_; }
  /// Returns the number of heartbeat time-outs of masters since the last call of this function.
  [[nodiscard]] std::uint64_t take_silences() noexcept { return std::exchange(silences_, 0); }

 private:
  struct Command {
    std::uint16_t code = 0;
    std::uint16_t counter = 0;
    bool arrived = false;
    bool executed = false;
    /// True in three cases: the daemon refused the command; the command was executed, and another command has
    /// arrived since; the command was executed, and the gateway has died since.
    bool over = false;
    bool read_as_refused = false;
  };
  /// A message to which the daemon has not responded.
  struct Sent {
    int command = -1;           ///< index of the command; -1: a stop that the gateway sends for a silent
                                ///< master
    std::uint64_t silence = 0;  ///< number of the latest heartbeat time-out before the message was sent
  };
  void execute(const std::string& name, const std::optional<Block>& cause, std::uint64_t id);
  void check(bool holds, const char* invariant, const char* otherwise) {
    if (!holds) on_break(invariant, otherwise);
  }

  Nanoseconds silence_;
  std::vector<Command> commands_;
  std::map<std::uint64_t, Sent> sent_;  // messages to which the daemon has not responded, by message id
  std::uint64_t halts_ = 0;
  std::uint64_t executed_ = 0;
  std::uint64_t silences_ = 0;
  std::optional<Nanoseconds> beat_at_;
  bool silent_ = false;  // true: the present heartbeat time-out has been counted
  std::uint64_t silence_number_ = 0;
  bool owed_ = false;  // true: no daemon has responded yet to the stop that the newest time-out requires
  Nanoseconds seen_ = 0;
  Nanoseconds waited_ = 0;  // time since the newest time-out required a stop, or since the last later
                            // incident that affects the gateway or the daemon
};

}  // namespace softgrip::world
