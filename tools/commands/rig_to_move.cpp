#include "tools/commands/rig_to_move.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <utility>

#include "daemon/service/board_lock.h"
#include "tools/client/daemon_client.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

Consent consent_on_terminal(bool yes) {
  if (yes) return [](const std::string&) { return true; };
  return [](const std::string& what) {
    std::fprintf(stderr, "%s. Ctrl-C vents the rig. Continue? [y/N] ", what.c_str());
    std::fflush(stderr);
    std::string answer;
    return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
  };
}

tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path, const std::string& channel,
                                                  bool yes) {
  if (const auto code = unreadable(path)) return tl::unexpected(*code);
  document::Problems problems;
  auto file = rig::load_rig(path, problems);
  if (!file) return tl::unexpected(refuse(problems));
  auto rig = experiment_rig(std::move(*file), channel);
  if (!rig) return tl::unexpected(fail(ExitCode::usage, rig.error()));
  if (rig->simulated) return std::move(*rig);
  if (!yes && ::isatty(STDIN_FILENO) == 0) {
    return tl::unexpected(fail(ExitCode::usage,
                               "this command moves a rig, which cannot be confirmed without a terminal: "
                               "allow the motion with --yes"));
  }
  if (daemon_runs(rig->rig.socket.path))
    return tl::unexpected(fail(ExitCode::state_refused, stop_the_daemon));
  if (const auto lock = daemon::BoardLock::take(rig->rig); !lock)
    return tl::unexpected(fail(ExitCode::state_refused, lock.error()));
  return std::move(*rig);
}

}  // namespace softgrip::tools
