#pragma once
// Lists the subcommands, one per line, in the order of `softgrip --help`. All other code takes the
// subcommands from this list.

#include "tools/command_line/command.h"

// clang-format off
#define SOFTGRIP_COMMANDS(X) \
  X(init)                    \
  X(check)                   \
  X(doctor)                  \
  X(calibrate)               \
  X(simulate)                \
  X(import)                  \
  X(plot)                    \
  X(export)                  \
  X(identify)                \
  X(validate)                \
  X(baseline)                \
  X(diagnose)                \
  X(health)                  \
  X(investigate)             \
  X(report)                  \
  X(run)                     \
  X(tune)                    \
  X(study)                   \
  X(status)                  \
  X(watch)                   \
  X(sequences)               \
  X(start)                   \
  X(stop)                    \
  X(release)                 \
  X(vent)                    \
  X(acknowledge)             \
  X(events)                  \
  X(completion)              \
  // end of the list
// clang-format on

namespace softgrip::tools {

#define SOFTGRIP_DECLARE(name) void add_##name(CLI::App& program, ExitCode& outcome);
SOFTGRIP_COMMANDS(SOFTGRIP_DECLARE)
#undef SOFTGRIP_DECLARE

}  // namespace softgrip::tools
