// softgrip release: releases the part as the sequence defines.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_release(CLI::App& program, ExitCode& outcome) {
  add_plain_request(
      program, outcome, "release",
      "Lets go: the running sequence goes on with its release step; what is held without one is "
      "let down",
      "releasing");
}

}  // namespace softgrip::tools
