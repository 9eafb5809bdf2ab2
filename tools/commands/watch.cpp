// softgrip watch: shows the live state of the daemon.

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/exit_code.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/client/live_view.h"
#include "tools/command_line/options.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds whole_line{1000};

struct WatchOptions {
  DaemonOptions daemon;
  double rate_hz = 10;
  std::uint64_t count = 0;  ///< number of updates until the program ends; 0: until a signal ends it
};

void print(const Json& status, bool json) {
  if (json) {
    print_json(status);
    return;
  }
  std::printf("%s\n", line_of_status(status).c_str());
  std::fflush(stdout);
}

/// Returns the exit code after a signal. If `count` is 0, a signal is the normal end of the program.
/// Otherwise the user requested a number of updates, and the signal interrupts them.
ExitCode ended_by(int signal, std::uint64_t count) {
  if (count > 0) note_ending_signal(signal);
  return ExitCode::done;
}

/// Prints a line per update until a signal ends the program.
ExitCode print_updates(DaemonClient& client, const WatchOptions& options) {
  const Descriptor signals = take_ending_signals();
  for (std::uint64_t lines = 0; options.count == 0 || lines < options.count;) {
    std::array<pollfd, 2> watched{{{client.descriptor(), POLLIN, 0}, {signals.get(), POLLIN, 0}}};
    if (::poll(watched.data(), watched.size(), -1) < 0) continue;
    if (watched[1].revents != 0) {
      const int signal = next_signal(signals);
      if (signal == SIGTSTP) ::raise(SIGSTOP);
      if (signal != 0 && signal != SIGTSTP && signal != SIGWINCH) return ended_by(signal, options.count);
    }
    if (watched[0].revents == 0) continue;
    // Read all lines, because poll() does not report lines that the client has already buffered.
    auto line = client.next_line(whole_line);
    for (; line && *line; line = client.next_line(std::chrono::milliseconds{0})) {
      if (!(*line)->contains("watch") || (options.count > 0 && lines == options.count)) continue;
      print((**line)["watch"], options.daemon.json);
      ++lines;
    }
    if (!line) return fail(line.error().code, line.error().message);
  }
  return ExitCode::done;
}

/// Pause between two requests for new events [s].
constexpr double event_pause_s = 0.5;
/// Longest wait of poll() [ms].
constexpr int look_pause_ms = 250;
constexpr std::uint64_t event_page = 200;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns the message after the daemon has accepted a command: "stopping", "started pick_stone" or
/// "acknowledged F202 reading_out_of_range of left".
std::string done_of(const Json& request, const Json& result) {
  const std::string command = request.value("command", "");
  if (command == "start") return "started " + request.value("sequence", "");
  if (command == "stop") return "stopping";
  if (command == "vent") return "venting";
  if (command == "release") return "releasing";
  return sentence_of_acknowledged(result);
}

/// Shows the screen and processes keys. Ends when the user presses `q`, a signal ends the program, the daemon
/// ends, or `count` updates were shown (0: no limit). Restores the terminal at the end and while Ctrl-Z has
/// stopped the program.
class LiveWatch {
 public:
  explicit LiveWatch(DaemonClient& client)
      : client_(client), signals_(take_ending_signals()), keyboard_(::isatty(STDIN_FILENO) == 1) {
    screen_.emplace();
  }

  ExitCode run(std::uint64_t count);

 private:
  /// Processes the signals that have arrived. Returns false if the program must end.
  bool hear_signals(std::uint64_t count);
  bool hear_keys();
  [[nodiscard]] std::optional<ClientFailure> hear_daemon();
  void take_line(const Json& line);
  void take_answer(const Json& request, const Json& line);
  void take_events(const Json& result);
  void ask(Json request);
  void ask_for_events();
  void draw();
  void leave();
  [[nodiscard]] std::string ran() const;

  DaemonClient& client_;
  Descriptor signals_;
  std::optional<Screen> screen_;
  bool keyboard_;
  LiveState state_;
  KeyDialogue dialogue_;
  std::map<std::uint64_t, Json> asked_;  ///< requests to which the daemon has not responded, by id
  std::uint64_t last_id_ = 0;
  std::uint64_t newest_event_ = 0;
  bool events_known_ = false;  ///< true if newest_event_ is valid
  bool events_asked_ = false;
  double events_due_s_ = 0;
  std::uint64_t updates_ = 0;
  std::string started_;  ///< the sequence that this program started most recently
};

void LiveWatch::ask(Json request) {
  if (request.value("command", "") == "start") started_ = request.value("sequence", "");
  request["id"] = ++last_id_;
  client_.send(request);
  asked_.emplace(last_id_, std::move(request));
}

void LiveWatch::ask_for_events() {
  if (events_asked_ || now_s() < events_due_s_) return;
  events_asked_ = true;
  events_due_s_ = now_s() + event_pause_s;
  // The first request fetches only the id of the newest event. The next request then fetches the last
  // `events_shown` events and all newer events.
  ask({{"command", "events"}, {"since", newest_event_}, {"limit", events_known_ ? event_page : 1}});
}

void LiveWatch::take_events(const Json& result) {
  const auto newest = result.value("newest", newest_event_);
  if (!std::exchange(events_known_, true)) {
    newest_event_ = newest > events_shown ? newest - events_shown : 0;
    events_due_s_ = 0;
    return;
  }
  for (const Json& event : result.value("events", Json::array())) {
    newest_event_ = event.value("id", newest_event_);
    add_event(state_, event);
  }
  if (newest_event_ < newest) events_due_s_ = 0;
}

void LiveWatch::take_answer(const Json& request, const Json& line) {
  const auto result = DaemonClient::result_of(line);
  if (request.value("command", "") == "events") {
    events_asked_ = false;
    if (result) take_events(*result);
    return;
  }
  state_.message = result ? Span{done_of(request, *result), Tone::good}
                          : Span{visible_lines(result.error().message), Tone::bad};
  events_due_s_ = 0;
}

void LiveWatch::take_line(const Json& line) {
  if (line.contains("watch")) {
    update_status(state_, line["watch"]);
    ++updates_;
    return;
  }
  const auto id = line.find("id");
  if (id == line.end() || !id->is_number_unsigned()) return;
  const auto found = asked_.find(id->get<std::uint64_t>());
  if (found == asked_.end()) return;
  const Json request = std::move(found->second);
  asked_.erase(found);
  take_answer(request, line);
}

/// Reads all lines, because poll() does not report lines that the client has already buffered.
std::optional<ClientFailure> LiveWatch::hear_daemon() {
  auto line = client_.next_line(whole_line);
  for (; line && *line; line = client_.next_line(std::chrono::milliseconds{0})) take_line(**line);
  if (!line) return line.error();
  return std::nullopt;
}

bool LiveWatch::hear_signals(std::uint64_t count) {
  const int signal = next_signal(signals_);
  if (signal == SIGTSTP) {
    screen_.reset();
    ::raise(SIGSTOP);
    screen_.emplace();
  }
  if (signal == 0 || signal == SIGTSTP || signal == SIGWINCH) return true;
  (void)ended_by(signal, count);
  return false;
}

bool LiveWatch::hear_keys() {
  std::array<char, 256> typed{};
  const ssize_t count = ::read(STDIN_FILENO, typed.data(), typed.size());
  if (count <= 0) {
    keyboard_ = false;  // the keyboard is lost, but the program continues to show the screen
    return true;
  }
  const std::string_view keys(typed.data(), static_cast<std::size_t>(count));
  KeyDialogue::Outcome outcome = dialogue_.process(keys, now_s(), ran());
  if (outcome.quit) return false;
  state_.message = {};
  if (outcome.request) {
    state_.message = {outcome.request->value("command", "") + " requested", Tone::faint};
    ask(std::move(*outcome.request));
  }
  return true;
}

std::string LiveWatch::ran() const {
  if (!started_.empty()) return started_;
  const Json sequence = state_.status.is_object() ? state_.status.value("sequence", Json()) : Json();
  return sequence.is_object() ? sequence.value("name", "") : "";
}

void LiveWatch::draw() {
  if (state_.status.is_null()) return;
  state_.question = dialogue_.question();
  const ViewStyle style{terminal_columns(), wants_colour(), has_unicode()};
  screen_->draw(screen_of(state_, style, terminal_rows()));
}

/// Restores the terminal and reports each start without a response, because the daemon may still begin such a
/// start.
void LiveWatch::leave() {
  screen_.reset();
  for (const auto& [id, request] : asked_) {
    if (request.value("command", "") == "start")
      std::fprintf(stderr,
                   "softgrip: the daemon has not replied to the start of %s. `softgrip status` shows if this "
                   "sequence runs, `softgrip stop` stops the sequence\n",
                   request.value("sequence", "").c_str());
  }
}

ExitCode LiveWatch::run(std::uint64_t count) {
  while (count == 0 || updates_ < count) {
    std::array<pollfd, 3> watched{{{client_.descriptor(), POLLIN, 0},
                                   {keyboard_ ? STDIN_FILENO : -1, POLLIN, 0},
                                   {signals_.get(), POLLIN, 0}}};
    ask_for_events();
    if (::poll(watched.data(), watched.size(), look_pause_ms) < 0) continue;
    if (watched[2].revents != 0 && !hear_signals(count)) break;
    if (watched[1].revents != 0 && !hear_keys()) break;
    if (watched[0].revents != 0) {
      if (const auto failure = hear_daemon()) {
        leave();
        return fail(failure->code, failure->message);
      }
    }
    if (dialogue_.expire(now_s())) state_.message = {"no confirmation: no command was sent", Tone::warning};
    draw();
  }
  leave();
  return ExitCode::done;
}

ExitCode run(const WatchOptions& options) {
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  const auto accepted = client->call({{"command", "watch"}, {"rate_hz", options.rate_hz}});
  if (!accepted) return fail(accepted.error().code, accepted.error().message);
  if (on_terminal() && !options.daemon.json) return LiveWatch(*client).run(options.count);
  return print_updates(*client, options);
}

}  // namespace

void add_watch(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<WatchOptions>(
      program, outcome, "watch",
      "Show the live state of the daemon with trends, events, and keys that stop, vent, release, acknowledge "
      "and start. Without a terminal, this command prints one line for each update",
      run);
  add_daemon_options(*command, options->daemon);
  command->add_option("--rate-hz", options->rate_hz, "Updates per second")
      ->capture_default_str()
      ->check(number_between(0.1, 50));
  command->add_option("--count", options->count, "Number of updates; 0: until the command is interrupted")
      ->capture_default_str();
}

}  // namespace softgrip::tools
