#pragma once
// The invariants of softgrip-plc. A counter is executed once, and only if a master has commanded it. No start
// outlives a stop or a vent that came after it. The reaction to a silent master reaches a daemon.

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

  /// The number of the next command.
  [[nodiscard]] int next_number() const noexcept { return static_cast<int>(commands_.size()); }
  void ask(std::uint16_t code, std::uint16_t counter) { commands_.push_back({code, counter}); }
  /// A block with a command has arrived.
  void arrived(int command);
  /// A line leaves for the daemon. `cause`: the block that led to it.
  void sent(const nlohmann::ordered_json& line, const std::optional<Block>& cause, Nanoseconds now);
  /// A line of the daemon arrives.
  void answered(const nlohmann::ordered_json& line);
  void daemon_died();
  /// The next one knows nothing of what was.
  void gateway_died();
  void read_refused(int command);
  void read_accepted(std::uint16_t code, std::uint16_t counter);

  /// A master's heartbeat has changed.
  void beat(Nanoseconds now);
  void look(Nanoseconds now);
  /// Time has passed; `undisturbed`: nothing hinders gateway and daemon.
  void passed(Nanoseconds now, bool undisturbed);

  /// The number of stops and vents that were executed.
  [[nodiscard]] std::uint64_t halts() const noexcept { return halts_; }
  [[nodiscard]] std::uint64_t asked() const noexcept { return commands_.size(); }
  [[nodiscard]] std::uint64_t executed() const noexcept { return executed_; }
  /// The number of silences since the last call.
  [[nodiscard]] std::uint64_t take_silences() noexcept { return std::exchange(silences_, 0); }

 private:
  struct Command {
    std::uint16_t code = 0;
    std::uint16_t counter = 0;
    bool arrived = false;
    bool executed = false;
    /// The daemon declined it, another command came after it, or the gateway that executed it died.
    bool over = false;
    bool read_as_refused = false;
  };
  /// A line that the daemon has not answered.
  struct Sent {
    int command = -1;           ///< -1: the reaction to a silence
    std::uint64_t silence = 0;  ///< the newest one, then
  };
  void execute(const std::string& name, const std::optional<Block>& cause, std::uint64_t id);
  void check(bool holds, const char* invariant, const char* otherwise) {
    if (!holds) on_break(invariant, otherwise);
  }

  Nanoseconds silence_;
  std::vector<Command> commands_;
  std::map<std::uint64_t, Sent> sent_;  // by the line's id
  std::uint64_t halts_ = 0;
  std::uint64_t executed_ = 0;
  std::uint64_t silences_ = 0;
  std::optional<Nanoseconds> beat_at_;
  bool silent_ = false;  // and counted
  std::uint64_t silence_number_ = 0;
  bool owed_ = false;  // no daemon has answered the reaction to the newest silence
  Nanoseconds seen_ = 0;
  Nanoseconds waited_ = 0;  // undisturbed, while it is owed
};

}  // namespace softgrip::world
