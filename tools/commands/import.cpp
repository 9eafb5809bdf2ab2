// softgrip import: converts external files to logs.

#include <CLI/CLI.hpp>

#include "tools/command_line/options.h"
#include "tools/commands/commands.h"
#include "tools/importing/import_run.h"

namespace softgrip::tools {

void add_import(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] =
      add_command<ImportOptions>(program, outcome, "import",
                                 "Convert external files to logs: CSV in any dialect (.gz "
                                 "too), XLSX, LabVIEW, MATLAB, HDF5, recordings",
                                 run_import);
  command->add_option("FILE", options->files, "Files, or recordings' folders")->required();
  command
      ->add_option("--out", options->out,
                   "Log to write ('-': standard output), or a folder for several files. The column "
                   "assignment is stored next to each log (.import.yaml)")
      ->required();
  for (const sysid::RoleSpec& spec : sysid::roles) {
    const std::string word(spec.word);
    command
        ->add_option("--" + word, options->columns[static_cast<std::size_t>(spec.role)],
                     "Column of the " + word +
                         ": its name, or its number counted from 1. If the option is given twice, " +
                         (spec.role == sysid::Role::time
                              ? "each of the two time columns applies to its own value columns"
                              : "the two columns are averaged"))
        ->allow_extra_args(false);
  }
  command
      ->add_option("--unit", options->units,
                   "ROLE=UNIT: unit of a column, if the file does not state the unit (example: pressure=psi)")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--scale", options->scales,
          "ROLE=X: factor that converts the column to s, kPa, mm or C (example: displacement=-2.5). With "
          "--unit displacement=deg or displacement=rad, the factor converts the column to deg or rad")
      ->allow_extra_args(false);
  command
      ->add_option("--zero", options->zeros,
                   "ROLE=X: value that is subtracted from the column before scaling, in the unit of the "
                   "column; ROLE=first: subtract the first value of the column")
      ->allow_extra_args(false);
  command->add_option("--rate-hz", options->rate_hz, "Sampling rate of a file without a time column")
      ->check(number_between(1e-3, 1e7));
  command
      ->add_option("--missing", options->missing,
                   "Value or text that stands for a missing reading (example: -999), in addition to NaN and "
                   "similar texts")
      ->allow_extra_args(false);
  command
      ->add_option("--missing-in", options->missing_in,
                   "COLUMN=NUMBER: number that stands for a missing reading in one column only (example: "
                   "tip_mm=999)")
      ->allow_extra_args(false);
  command->add_option("--separator", options->separator, "comma, semicolon, tab, space or bar [detected]");
  command->add_option("--channel", options->channel, "Import only the rows or columns of this channel");
  command->add_option("--sheet", options->sheet,
                      "Sheet of a workbook, if more than one sheet contains numbers");
  command->add_flag("--skip-bad-lines", options->skip_bad_lines, "Skip and count unreadable lines");
  command
      ->add_option("--from-s", options->from_s,
                   "Time of the first sample to use, relative to the first sample of the file [s]")
      ->check(number_between(0.0, 1e9));
  command
      ->add_option("--to-s", options->to_s,
                   "Time of the last sample to use, relative to the first sample of the file [s]")
      ->check(number_between(0.0, 1e9));
  command->add_option(
      "--map", options->map,
      "Column assignment of an earlier import (.import.yaml); options override this assignment");
  command->add_flag("--yes", options->yes,
                    "Accept the proposed column assignment without a confirmation question");
  command->add_flag("--json", options->json, "Print a summary as JSON");
}

}  // namespace softgrip::tools
