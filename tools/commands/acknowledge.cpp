// softgrip acknowledge: takes note of a latched fault.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_acknowledge(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "acknowledge",
                    "Clears latched faults whose cause is gone; nothing moves until the next start",
                    "acknowledged");
}

}  // namespace softgrip::tools
