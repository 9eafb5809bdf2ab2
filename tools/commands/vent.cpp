// softgrip vent: stops every sequence and vents all channels.

#include "tools/client/daemon_command.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_vent(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "vent", "Stop and vent all channels; a held part drops", "venting");
}

}  // namespace softgrip::tools
