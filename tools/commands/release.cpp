// softgrip release: releases the gripped part by means of the release step of the sequence.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_release(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "release",
                    "Continue the running sequence with its release step. If no sequence runs, vent the "
                    "pressurised fingers",
                    "releasing");
}

}  // namespace softgrip::tools
