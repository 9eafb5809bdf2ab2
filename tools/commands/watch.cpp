// softgrip watch: the daemon's state, live.

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/client/daemon_command.h"
#include "tools/client/status_view.h"
#include "tools/command_line/option_check.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  DaemonOptions daemon;
  double rate_hz = 10;
  std::uint64_t count = 0;  ///< 0: until interrupted
};

/// True when the user wants to leave: q, or a signal that ends programs.
bool leaving(const std::array<pollfd, 3>& watched, const Descriptor& signals) {
  constexpr char end_of_transmission = 4;
  if (watched[1].revents != 0) {
    char key = 0;
    if (::read(STDIN_FILENO, &key, 1) == 1 && (key == 'q' || key == 'Q' || key == end_of_transmission))
      return true;
  }
  signalfd_siginfo info{};
  return watched[2].revents != 0 && ::read(signals.get(), &info, sizeof info) > 0 &&
         info.ssi_signo != SIGWINCH;
}

void show(const Json& status, const Options& options, std::optional<Screen>& screen) {
  if (options.daemon.json) {
    print_json(status);
  } else if (screen) {
    const ViewStyle style{terminal_columns(), wants_colour(), has_unicode()};
    auto lines = view_of(status, style);
    lines.insert(lines.end(), {"", "q leaves"});
    screen->draw(lines);
  } else {
    std::printf("%s\n", line_of_status(status).c_str());
    std::fflush(stdout);
  }
}

ExitCode watch(DaemonClient& client, const Options& options) {
  constexpr std::chrono::milliseconds whole_line{1000};
  const Descriptor signals = take_ending_signals();
  const bool live = on_terminal() && !options.daemon.json;
  std::optional<Screen> screen;
  if (live) screen.emplace();
  const int keyboard = live && ::isatty(STDIN_FILENO) == 1 ? STDIN_FILENO : -1;
  Json shown;
  for (std::uint64_t lines = 0; options.count == 0 || lines < options.count;) {
    std::array<pollfd, 3> watched{
        {{client.descriptor(), POLLIN, 0}, {keyboard, POLLIN, 0}, {signals.get(), POLLIN, 0}}};
    if (::poll(watched.data(), watched.size(), -1) < 0) continue;
    if (leaving(watched, signals)) return ExitCode::done;
    if (watched[2].revents != 0 && !shown.is_null()) show(shown, options, screen);  // resized
    if (watched[0].revents == 0) continue;
    // Everything that came, or poll() would not tell of what is already buffered here.
    auto line = client.next_line(whole_line);
    for (; line && *line; line = client.next_line(std::chrono::milliseconds{0})) {
      if (!(*line)->contains("watch")) continue;
      shown = (**line)["watch"];
      show(shown, options, screen);
      ++lines;
    }
    if (!line) {
      screen.reset();
      return fail(line.error().code, line.error().message);
    }
  }
  return ExitCode::done;
}

ExitCode run(const Options& options) {
  auto client = DaemonClient::connect(options.daemon.socket);
  if (!client) return fail(client.error().code, client.error().message);
  const auto accepted = client->ask({{"command", "watch"}, {"rate_hz", options.rate_hz}});
  if (!accepted) return fail(accepted.error().code, accepted.error().message);
  return watch(*client, options);
}

}  // namespace

void add_watch(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "watch", "The daemon's state, live; a line per update where there is no terminal");
  add_daemon_options(*command, options->daemon);
  command->add_option("--rate-hz", options->rate_hz, "Updates per second")
      ->capture_default_str()
      ->check(number_between(0.1, 50));
  command->add_option("--count", options->count, "Leave after so many updates; 0: when interrupted")
      ->capture_default_str();
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
