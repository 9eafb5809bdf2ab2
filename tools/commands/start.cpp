// softgrip start: starts a sequence of the daemon.

#include <poll.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/exit_code.h"
#include "base/files.h"
#include "tools/client/daemon_client.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/client/set_option.h"
#include "tools/command_line/options.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct StartOptions {
  DaemonOptions daemon;
  std::string sequence;
  std::vector<std::string> settings;
  bool wait = false;
};

/// Returns the id of the daemon's latest event, so that the program shows only the events after it.
tl::expected<std::uint64_t, ClientFailure> newest_event(DaemonClient& client) {
  const auto result = client.call({{"command", "events"}, {"since", 0}, {"limit", 1}});
  if (!result) return tl::unexpected{result.error()};
  return result->value("newest", std::uint64_t{0});
}

/// Time limit for the response to a start. It is long because the daemon may have to plan the motion before
/// the response.
constexpr std::chrono::seconds longest_planning{90};

/// The reason why the program stops following a start: a signal, a failure of the daemon, or a failure of the
/// standard output.
struct Break {
  int signal = 0;
  ClientFailure failure;
};

/// Follows one start from the request until the daemon has accepted it or, with --wait, until the sequence
/// has ended. If the program ends earlier, for example after a signal, it first stops the sequence, because
/// the sequence must not continue without the program.
class FollowedStart {
 public:
  FollowedStart(const StartOptions& options, DaemonClient& client)
      : options_(options), client_(client), id_(new_start_id()), signals_(take_ending_signals()) {}

  ExitCode run(Json request, std::uint64_t newest_event);

 private:
  [[nodiscard]] int signal_within(std::chrono::milliseconds patience, int descriptor = -1);
  [[nodiscard]] tl::expected<Json, Break> reply(DaemonClient& client, const Json& request,
                                                std::chrono::milliseconds patience);
  [[nodiscard]] tl::expected<ExitCode, Break> follow(std::uint64_t request, std::uint64_t since);
  [[nodiscard]] tl::expected<void, Break> print(const Json& event) const;
  [[nodiscard]] bool stop_confirmed();
  ExitCode refused(const Json& reply, const ClientFailure& failure) const;
  ExitCode take_back(const Break& reason);

  const StartOptions& options_;
  DaemonClient& client_;
  std::string id_;
  Descriptor signals_;
  bool pipe_ends_ = true;  ///< true: a closed pipe ends the program; false: the calling program ignores
                           ///< SIGPIPE
};

/// Waits until the descriptor is readable, a signal arrives or `patience` has elapsed. Returns the signal, or
/// 0 if there was none.
int FollowedStart::signal_within(std::chrono::milliseconds patience, int descriptor) {
  std::array<pollfd, 2> watched{{{signals_.get(), POLLIN, 0}, {descriptor, POLLIN, 0}}};
  if (::poll(watched.data(), watched.size(), static_cast<int>(patience.count())) <= 0) return 0;
  if (watched[0].revents == 0) return 0;
  const int signal = next_signal(signals_);
  if (signal == SIGTSTP) ::raise(SIGSTOP);
  return signal == SIGTSTP || signal == SIGWINCH ? 0 : signal;
}

tl::expected<Json, Break> FollowedStart::reply(DaemonClient& client, const Json& request,
                                               std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + patience;
  client.send(request);
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    const auto pause = std::max(left, std::chrono::milliseconds{0});
    if (const int signal = signal_within(pause, client.descriptor()); signal != 0)
      return tl::unexpected{Break{signal, {}}};
    auto line = client.next_line(std::chrono::milliseconds{0});
    if (!line) return tl::unexpected{Break{0, line.error()}};
    if (*line) return std::move(**line);
    if (left.count() <= 0) return tl::unexpected{Break{0, {ExitCode::io, "the daemon does not respond"}}};
  }
}

tl::expected<void, Break> FollowedStart::print(const Json& event) const {
  errno = 0;
  if (options_.daemon.json) {
    print_json(event);
  } else {
    std::printf("%s\n", line_of_event(event).c_str());
    std::fflush(stdout);
  }
  if (std::ferror(stdout) == 0) return {};
  return tl::unexpected{Break{errno == EPIPE && pipe_ends_ ? SIGPIPE : 0,
                              {ExitCode::io, "the standard output cannot be written"}}};
}

/// Prints the events until the sequence that `request` started has ended. The event with the reason of a
/// failure can follow the end of the sequence, so the events after the end are read once more.
tl::expected<ExitCode, Break> FollowedStart::follow(std::uint64_t request, std::uint64_t since) {
  constexpr std::chrono::milliseconds pause{50};
  // Ignore SIGPIPE, so that flushing the output detects a closed pipe. The sequence is stopped before the
  // program ends.
  pipe_ends_ = std::signal(SIGPIPE, SIG_IGN) != SIG_IGN;
  std::string reason;
  std::optional<ExitCode> end;
  while (true) {
    const auto line = reply(client_, {{"command", "events"}, {"since", since}, {"limit", 1000}},
                            DaemonClient::reply_timeout);
    if (!line) return tl::unexpected{line.error()};
    const auto result = DaemonClient::result_of(*line);
    if (!result) return tl::unexpected{Break{0, result.error()}};
    const bool ended_before = end.has_value();
    for (const Json& event : result->value("events", Json::array())) {
      since = event.value("id", since);
      if (const auto printed = print(event); !printed) return tl::unexpected{printed.error()};
      if (reason.empty()) reason = failure_reason(event);
      if (event.value("kind", "") == "sequence_finished" &&
          event.value("request", std::uint64_t{0}) == request) {
        if (event.value("code", "") == "done") return ExitCode::done;
        end = ExitCode::not_acceptable;
      }
    }
    if (end && (ended_before || !reason.empty()))
      return reason.empty() ? *end : fail(*end, options_.sequence + " was not completed. " + reason);
    if (const int signal = signal_within(pause); signal != 0) return tl::unexpected{Break{signal, {}}};
  }
}

/// Requests the stop over a separate connection, because a response may still be pending on the first
/// connection. Returns true if the daemon confirms the stop.
bool FollowedStart::stop_confirmed() {
  auto client = DaemonClient::connect(options_.daemon.socket);
  if (!client) return false;
  const auto line = reply(*client, stop_request_for(id_), DaemonClient::reply_timeout);
  return line && confirms_stop(*line);
}

ExitCode FollowedStart::take_back(const Break& reason) {
  const bool stopped = stop_confirmed();
  const char* const outcome = stopped ? "sequence stopped"
                                      : "the stop was not confirmed, so the sequence may still run. "
                                        "`softgrip status` shows the sequence, `softgrip stop` stops it";
  if (reason.signal == 0) return fail(reason.failure.code, reason.failure.message + "; " + outcome);
  note_ending_signal(reason.signal);
  return fail(ExitCode::failed, outcome);
}

/// Reports that the daemon has refused the start. A request is too long only because of the sequence file.
ExitCode FollowedStart::refused(const Json& reply, const ClientFailure& failure) const {
  if (text_at(object_at(reply, "error"), "code") != "too_long") return fail(failure.code, failure.message);
  return fail(failure.code, options_.sequence + ": the sequence is too large to be sent to the daemon: " +
                                failure.message + " (`socket: max_line_bytes` in the rig file)");
}

ExitCode FollowedStart::run(Json request, std::uint64_t newest_event) {
  request["start_id"] = id_;
  const auto line = reply(client_, request, longest_planning);
  if (!line) return take_back(line.error());
  const auto accepted = DaemonClient::result_of(*line);
  if (!accepted && !refuses_start(*line)) return take_back({0, accepted.error()});
  if (!accepted) return refused(*line, accepted.error());
  if (!accepted->contains("request"))
    return take_back({0, {ExitCode::io, "softgripd sent a malformed reply: `result.request` is missing"}});
  if (const Json warnings = accepted->value("warnings", Json::array()); !warnings.empty())
    std::fprintf(stderr, "softgrip: %s\n", visible_lines("warning:" + problem_list(warnings)).c_str());
  if (options_.wait) {
    const auto end = follow(accepted->value("request", std::uint64_t{0}), newest_event);
    return end ? *end : take_back(end.error());
  }
  if (options_.daemon.json) {
    print_json(*accepted);
  } else {
    std::printf("started\n");
  }
  return ExitCode::done;
}

/// Returns true if SEQUENCE is a local file, and not a name in the sequence directory of the daemon. A folder
/// with the name of a sequence has no effect.
bool is_local_file(const std::string& sequence) {
  return sequence.find('/') != std::string::npos || (is_there(sequence) && !is_folder(sequence));
}

ExitCode run(const StartOptions& options) {
  constexpr std::size_t longest_sequence = 256 * 1024;
  const auto arguments = arguments_of(options.settings);
  if (!arguments) return arguments.error();
  Json request{{"command", "start"}, {"sequence", options.sequence}};
  if (!arguments->empty()) request["parameters"] = json_of(*arguments);
  // The text of a local file is sent. Otherwise the daemon finds the sequence by its name.
  if (is_local_file(options.sequence)) {
    const auto text = read_file(options.sequence, longest_sequence);
    if (!text) return fail(ExitCode::io, text.error());
    request["sequence_text"] = *text;
  }
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  if (const auto failure = check_start_id_support(*client)) return fail(failure->code, failure->message);
  const auto newest = newest_event(*client);
  if (!newest) return fail(newest.error().code, newest.error().message);
  return FollowedStart(options, *client).run(std::move(request), *newest);
}

}  // namespace

void add_start(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] =
      add_command<StartOptions>(program, outcome, "start", "Start a sequence of the daemon", run);
  command
      ->add_option("SEQUENCE", options->sequence,
                   "Sequence: a file, or a name in the sequence directory of the daemon")
      ->required();
  add_set_option(*command, options->settings);
  add_daemon_options(*command, options->daemon);
  command->add_flag("--wait", options->wait,
                    "Wait for the end of the sequence. If this command is interrupted, stop the sequence. "
                    "The exit code is 6 if a grip did not succeed");
}

}  // namespace softgrip::tools
