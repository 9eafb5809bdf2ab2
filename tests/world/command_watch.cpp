#include "tests/world/command_watch.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/periodic_schedule.h"
#include "tools/plc/process_image.h"

namespace softgrip::world {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* executed_once = "softgrip-plc executes each command at most once";
constexpr const char* asked_before = "softgrip-plc executes only commands of a master";
constexpr const char* true_end = "a master reads the true result of its command";
constexpr const char* outlives_nothing = "a stop or a vent always ends an earlier start";
constexpr const char* reaction_kept = "the reaction to a stopped heartbeat is not lost";

constexpr auto start_code = static_cast<std::uint16_t>(plc::CommandCode::start);
constexpr auto vent_code = static_cast<std::uint16_t>(plc::CommandCode::vent);
/// Longest permitted time from a heartbeat time-out of a master until a daemon responds to the stop that the
/// gateway then sends. The time is counted again from 0 after an incident that affects the gateway or the
/// daemon.
constexpr Nanoseconds reaction_bound = 2 * ns_per_s;

/// Returns true if no further stop is necessary after this response: the daemon has stopped the sequence, or
/// no sequence was running.
bool answers_for_good(const Json& line) {
  if (line.value("ok", false)) return true;
  constexpr int starting = static_cast<int>(plc::Reason::refusal) + 6;
  const int reason = static_cast<int>(plc::reason_of(line.value("error", Json::object())));
  return reason > static_cast<int>(plc::Reason::refusal) && reason != starting;
}

}  // namespace

void CommandWatch::arrived(int command) {
  if (command < 0) return;
  Command& one = commands_[static_cast<std::size_t>(command)];
  if (std::exchange(one.arrived, true)) return;
  for (Command& other : commands_) other.over = other.over || (other.executed && &other != &one);
}

void CommandWatch::sent(const Json& line, const std::optional<Block>& cause, Nanoseconds now) {
  const std::string name = line["command"];
  const auto id = line["id"].get<std::uint64_t>();
  if (name == "hello" || name == "watch") return;
  // The simulated masters never command a stop. A stop therefore means that the gateway has detected a silent
  // master.
  if (name == "stop") {
    look(now);
    ++halts_;
    sent_[id] = {-1, silence_number_};
    return;
  }
  execute(name, cause, id);
}

void CommandWatch::execute(const std::string& name, const std::optional<Block>& cause, std::uint64_t id) {
  if (!cause || cause->command < 0) return check(false, asked_before, "no master has requested this command");
  Command& asked = commands_[static_cast<std::size_t>(cause->command)];
  check(plc::command_of(static_cast<plc::CommandCode>(asked.code)) == name, asked_before,
        "the executed command differs from the requested one");
  check(!asked.executed, executed_once, "a command is executed twice");
  check(!asked.read_as_refused, true_end, "a command that the gateway reported as refused is executed");
  check(asked.code != start_code || cause->halts == halts_, outlives_nothing,
        "a start is executed, although its register block was written before the last stop or vent");
  check(asked.code != start_code || !owed_, reaction_kept,
        "a start is executed, although no daemon has responded yet to the stop for a silent master");
  if (asked.code == vent_code) ++halts_;
  asked.executed = true;
  ++executed_;
  sent_[id] = {cause->command, silence_number_};
}

void CommandWatch::answered(const Json& line) {
  if (line.contains("watch") || !line.contains("id") || !line["id"].is_number()) return;
  const auto found = sent_.find(line["id"].get<std::uint64_t>());
  if (found == sent_.end()) return;
  const Sent sent = found->second;
  sent_.erase(found);
  if (sent.command >= 0) {
    if (!line.value("ok", false)) commands_[static_cast<std::size_t>(sent.command)].over = true;
  } else if (answers_for_good(line) && sent.silence == silence_number_) {
    owed_ = false;
  }
}

void CommandWatch::daemon_died() {
  sent_.clear();
}

void CommandWatch::gateway_died() {
  for (Command& command : commands_) command.over = command.over || command.executed;
  sent_.clear();
  beat_at_.reset();
  silent_ = owed_ = false;
}

void CommandWatch::read_refused(int command) {
  Command& asked = commands_[static_cast<std::size_t>(command)];
  check(!asked.executed || asked.over, true_end, "the gateway reports an executed command as refused");
  asked.read_as_refused = true;
}

void CommandWatch::read_accepted(std::uint16_t code, std::uint16_t counter) {
  const bool executed = std::any_of(commands_.begin(), commands_.end(), [&](const Command& asked) {
    return asked.executed && asked.counter == counter && asked.code == code;
  });
  check(executed, true_end, "a command was not executed, but is read as accepted");
}

void CommandWatch::beat(Nanoseconds now) {
  look(now);
  beat_at_ = now;
  silent_ = false;
}

void CommandWatch::look(Nanoseconds now) {
  if (silent_ || !beat_at_ || now - *beat_at_ <= silence_) return;
  silent_ = owed_ = true;
  ++silences_;
  ++silence_number_;
  waited_ = 0;
}

void CommandWatch::passed(Nanoseconds now, bool undisturbed) {
  const Nanoseconds duration = seen_ == 0 ? 0 : now - seen_;
  seen_ = now;
  waited_ = owed_ && undisturbed ? waited_ + duration : 0;
  if (waited_ <= reaction_bound) return;
  on_break(reaction_kept,
           fmt::format(
               "the daemon has not responded to the stop after a silence within {:.3f} s of undisturbed time",
               seconds(waited_)));
}

}  // namespace softgrip::world
