#pragma once
// The invariants of softgrip-plc. The command of a counter value is executed at most once, and only if a
// master has sent it. A start does not take effect after a later stop or vent. If a master falls silent, the
// stop that the gateway sends reaches a daemon.

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

  /// Returns the number of the next command.
  [[nodiscard]] int next_number() const noexcept { return static_cast<int>(commands_.size()); }
  void ask(std::uint16_t code, std::uint16_t counter) { commands_.push_back({code, counter}); }
  /// Called when a block of registers with this command has arrived at the gateway.
  void arrived(int command);
  /// Called when the gateway sends a message to the daemon. `cause`: the block of a master that led to this
  /// message.
  void sent(const nlohmann::ordered_json& line, const std::optional<Block>& cause, Nanoseconds now);
  /// Called when a message of the daemon arrives at the gateway.
  void answered(const nlohmann::ordered_json& line);
  void daemon_died();
  /// Called when the gateway dies. The next gateway does not know the earlier commands.
  void gateway_died();
  void read_refused(int command);
  void read_accepted(std::uint16_t code, std::uint16_t counter);

  /// Called when a master's heartbeat has changed.
  void beat(Nanoseconds now);
  void look(Nanoseconds now);
  /// Called when time has passed. `undisturbed`: true if no incident affects the gateway or the daemon.
  void passed(Nanoseconds now, bool undisturbed);

  /// Returns the number of executed stops and vents.
  [[nodiscard]] std::uint64_t halts() const noexcept { return halts_; }
  [[nodiscard]] std::uint64_t asked() const noexcept { return commands_.size(); }
  [[nodiscard]] std::uint64_t executed() const noexcept { return executed_; }
  /// Returns how often a master has fallen silent since the last call.
  [[nodiscard]] std::uint64_t take_silences() noexcept { return std::exchange(silences_, 0); }

 private:
  struct Command {
    std::uint16_t code = 0;
    std::uint16_t counter = 0;
    bool arrived = false;
    bool executed = false;
    /// The daemon declined the command, another command came after it, or the gateway that executed it died.
    bool over = false;
    bool read_as_refused = false;
  };
  /// A message that the daemon has not answered yet.
  struct Sent {
    int command = -1;           ///< index of the command; -1: the stop because of a silent master
    std::uint64_t silence = 0;  ///< number of the newest silence at the time of sending
  };
  void execute(const std::string& name, const std::optional<Block>& cause, std::uint64_t id);
  void check(bool holds, const char* invariant, const char* otherwise) {
    if (!holds) on_break(invariant, otherwise);
  }

  Nanoseconds silence_;
  std::vector<Command> commands_;
  std::map<std::uint64_t, Sent> sent_;  // key: id of the message
  std::uint64_t halts_ = 0;
  std::uint64_t executed_ = 0;
  std::uint64_t silences_ = 0;
  std::optional<Nanoseconds> beat_at_;
  bool silent_ = false;  // the present silence has been counted
  std::uint64_t silence_number_ = 0;
  bool owed_ = false;  // no daemon has answered the stop because of the newest silence
  Nanoseconds seen_ = 0;
  Nanoseconds waited_ = 0;  // time since this stop has been due, except during incidents
};

}  // namespace softgrip::world
