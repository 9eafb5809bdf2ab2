// softgrip acknowledge: takes note of a latched fault.

#include "tools/commands.h"
#include "tools/daemon_command.h"

namespace softgrip::tools {

void add_acknowledge(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "acknowledge",
                    "Clears latched faults whose cause is gone; nothing moves until the next start",
                    "acknowledged");
}

}  // namespace softgrip::tools
