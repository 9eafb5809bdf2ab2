// softgrip release: releases the part with the release step of the sequence.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_release(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "release",
                    "Release: the running sequence continues with its release step. If no sequence runs, "
                    "pressurised fingers are vented",
                    "releasing");
}

}  // namespace softgrip::tools
