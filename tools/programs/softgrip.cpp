// softgrip: the command-line program with all its subcommands.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "base/exit_code.h"
#include "base/version.h"
#include "tools/command_line/program.h"
#include "tools/commands/commands.h"

namespace {

int run(int argc, char** argv) {
  CLI::App program{"Run soft pneumatic grippers and diagnose their models.", "softgrip"};
  program.set_version_flag("--version", std::string{"softgrip "}.append(softgrip::software_version()));
  program.require_subcommand(1);
  program.footer(
      "Exit codes: 0 done, 1 failed, 2 usage, 3 configuration or input refused, 4 I/O,\n"
      "5 refused by the daemon's state, 6 finished but the result is not acceptable.\n"
      "After Ctrl-C or another ending signal, the program cleans up and then ends by the same signal.");

  softgrip::ExitCode outcome = softgrip::ExitCode::done;
#define SOFTGRIP_ADD(name) softgrip::tools::add_##name(program, outcome);
  SOFTGRIP_COMMANDS(SOFTGRIP_ADD)
#undef SOFTGRIP_ADD
  softgrip::tools::refuse_options_as_values(program);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return softgrip::tools::end_of(program, error, argc, argv);
  }
  // All results are complete and stored at this point. If a signal was received, the program raises this
  // signal again: a shell that runs the program in a loop ends the loop only if a signal has ended the
  // program.
  if (softgrip::ending_signal() != 0) softgrip::end_by_signal(softgrip::ending_signal());
  return static_cast<int>(outcome);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto code = static_cast<softgrip::ExitCode>(run(argc, argv));
    return static_cast<int>(softgrip::with_output_checked(code, "softgrip"));
  } catch (const std::bad_alloc&) {
    std::fputs("softgrip: there is not enough memory for this input\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softgrip: %s\n", error.what());
  }
  return static_cast<int>(softgrip::ExitCode::failed);
}
