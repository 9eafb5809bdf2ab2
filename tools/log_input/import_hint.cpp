#include "tools/log_input/log_input.h"

#include <filesystem>

#include "base/files.h"
#include "base/text.h"
#include "sysid/import/conversion.h"
#include "sysid/import/proposal.h"
#include "sysid/import/table_readers.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

std::string import_hint(const std::string& path) {
  document::Problems problems;
  // If the file is a valid log, give no hint. The log was refused because of another log or of the model.
  if (const auto text = read_file(path, sysid::LogOptions{}.bytes);
      text && sysid::parse_log(path, *text, problems))
    return "";
  problems = {};
  bool unreadable = false;
  const auto table = sysid::read_foreign_file(path, {}, problems, unreadable);
  const std::filesystem::path file(path);
  const std::string begin = "softgrip import " + shell_word(path) + " ";
  const std::string end = "--out " + shell_word(file.stem().stem().string() + "_log.csv");
  if (!table) {
    const document::Problem& problem = problems.list().front();
    const bool needs_sheet = problem.hint == sysid::select_sheet_hint;
    return needs_sheet ? path + ": " + problem.message + ": " + begin + "--sheet NAME " + end + "\n" : "";
  }
  const sysid::Proposal proposal = sysid::propose(*table, {}, true);
  if (proposal.missing.empty() && sysid::convert(*table, proposal.mapping, problems))
    return path + " as a log: " + begin + sysid::options_of(proposal.mapping) + " " + end + "\n";
  // If the file has the columns of a log, give no hint. Its errors are already printed, and an import would
  // not correct them.
  const bool own = sysid::column_index(*table, "pressure_command_kpa") < table->columns.size();
  return own ? std::string() : "To see the columns of " + path + ": " + begin + end + "\n";
}

}  // namespace softgrip::tools
