// softgrip import: converts external files to logs.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/command_line/option_check.h"
#include "tools/commands/commands.h"
#include "tools/importing/import_run.h"

namespace softgrip::tools {

void add_import(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = program.add_subcommand("import",
                                             "Logs out of other people's files: CSV in any dialect (.gz "
                                             "too), XLSX, LabVIEW, MATLAB, HDF5, recordings");
  command->add_option("FILE", options->files, "Files, or recordings' folders")->required();
  command
      ->add_option(
          "--out", options->out,
          "Log to write ('-': standard output); of several files the folder for them. What was taken from "
          "where is kept beside it (.import.yaml)")
      ->required();
  for (const sysid::RoleSpec& spec : sysid::roles) {
    const std::string word(spec.word);
    command
        ->add_option("--" + word, options->columns[static_cast<std::size_t>(spec.role)],
                     "Column of the " + word + ": its name, or its number from 1; given twice, " +
                         (spec.role == sysid::Role::time ? "each for its own columns" : "averaged"))
        ->allow_extra_args(false);
  }
  command->add_option("--unit", options->units, "ROLE=UNIT, where the column does not say it (pressure=psi)")
      ->allow_extra_args(false);
  command
      ->add_option("--scale", options->scales,
                   "ROLE=X, s, kPa, mm or C per unit of the column (displacement=-2.5); deg or rad per unit "
                   "beside --unit displacement=deg or =rad")
      ->allow_extra_args(false);
  command
      ->add_option("--zero", options->zeros, "ROLE=X, subtracted first, in the column's unit; or ROLE=first")
      ->allow_extra_args(false);
  command->add_option("--rate-hz", options->rate_hz, "Samples per second of a file without times")
      ->check(number_between(1e-3, 1e7));
  command
      ->add_option("--missing", options->missing,
                   "What stands where nothing was read (-999), besides NaN and the like")
      ->allow_extra_args(false);
  command->add_option("--separator", options->separator, "comma, semicolon, tab, space or bar [found]");
  command->add_option("--channel", options->channel, "Only the rows, or the columns, of this channel");
  command->add_option("--sheet", options->sheet, "Sheet of a workbook, where several have numbers");
  command->add_flag("--skip-bad-lines", options->skip_bad_lines,
                    "Leave out lines that cannot be read, and count them");
  command->add_option("--from-s", options->from_s, "Only samples from here on, counted from the first one")
      ->check(number_between(0.0, 1e9));
  command->add_option("--to-s", options->to_s, "Only samples up to here")->check(number_between(0.0, 1e9));
  command->add_option("--map", options->map,
                      "What an earlier import kept (.import.yaml); options overrule it");
  command->add_flag("--yes", options->yes, "Agree to what is proposed without being asked");
  command->add_flag("--json", options->json, "Say what was done as JSON");
  command->callback([options, &outcome] { outcome = run_import(*options); });
}

}  // namespace softgrip::tools
