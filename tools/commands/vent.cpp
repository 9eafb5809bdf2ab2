// softgrip vent: stops every sequence and vents all channels.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_vent(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "vent", "Ends what runs and vents all channels: a held part drops",
                    "venting");
}

}  // namespace softgrip::tools
