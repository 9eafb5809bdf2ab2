// softgrip acknowledge: resets latched faults.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/client/daemon_command.h"
#include "tools/client/event_text.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_acknowledge(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<DaemonOptions>();
  CLI::App* command = program.add_subcommand(
      "acknowledge", "Reset latched faults whose cause is gone; nothing moves until the next start");
  add_daemon_options(*command, *options);
  command->callback([options, &outcome] {
    const auto result = ask_daemon(*options, {{"command", "acknowledge"}});
    if (!result) {
      outcome = result.error();
    } else if (options->json) {
      print_json(*result);
    } else {
      std::printf("%s\n", sentence_of_acknowledged(*result).c_str());
    }
  });
}

}  // namespace softgrip::tools
