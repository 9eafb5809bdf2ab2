// softgrip stop: stops the running sequence.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_stop(CLI::App& program, ExitCode& outcome) {
  add_ending_request(program, outcome, "stop", "Stop the sequence with the safe action of its phase",
                     "stopping");
}

}  // namespace softgrip::tools
