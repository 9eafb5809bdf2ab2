// softgrip acknowledge: resets latched faults.

#include <nlohmann/json.hpp>

#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_acknowledge(CLI::App& program, ExitCode& outcome) {
  add_plain_request(program, outcome, "acknowledge",
                    "Reset latched faults whose cause is gone; nothing moves until the next start",
                    sentence_of_acknowledged);
}

}  // namespace softgrip::tools
