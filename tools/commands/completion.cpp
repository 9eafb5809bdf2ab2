// softgrip completion: prints a script for a shell that completes softgrip's commands and options.

#include "tools/command_line/command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "tools/commands/commands.h"

namespace softgrip::tools {

void add_completion(CLI::App& program, ExitCode& outcome) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("completion", "Print a completion script for bash, zsh or fish");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "The Debian package installs these scripts. Without the package, run one of these commands:\nsource "
      "<(softgrip completion bash);\n"
      "softgrip completion zsh >DIRECTORY_OF_FPATH/_softgrip;\n"
      "softgrip completion fish >~/.config/fish/completions/softgrip.fish.");
  command->callback([&program, shell, &outcome] {
    if (const auto known = shell_named(*shell)) {
      std::fputs(completion_script(program, *known).c_str(), stdout);
      outcome = std::fflush(stdout) == 0 ? ExitCode::done : ExitCode::io;
    }
  });
}

}  // namespace softgrip::tools
