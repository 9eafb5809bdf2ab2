// Fuzz target: passes arbitrary bytes to the readers of external text tables, workbooks, LabVIEW files and
// MCAP files. A reader must refuse the bytes or return a table. It must be possible to write the proposed
// column mapping of a returned table as options and as a mapping file. A converted table must be a valid log.
//
//   Command: scripts/fuzz.sh import_fuzz 30

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sysid/import/conversion.h"
#include "sysid/import/mapping.h"
#include "sysid/import/mcap_table.h"
#include "sysid/import/proposal.h"
#include "sysid/import/table_readers.h"
#include "sysid/logs/plausibility_warnings.h"

namespace {

using namespace softgrip;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  document::Problems problems;
  const auto table = text.starts_with("PK")     ? sysid::read_xlsx_table("fuzz.xlsx", text, {}, problems)
                     : text.starts_with("TDSm") ? sysid::read_tdms_table("fuzz.tdms", text, problems)
                     : text.starts_with(sysid::mcap_magic)
                         ? sysid::read_mcap_table("fuzz.mcap", text, {}, problems)
                         : sysid::parse_text_table("fuzz.csv", text, {}, problems);
  require(table.has_value() == problems.empty());
  (void)problems.format();
  if (!table) return 0;
  for (const sysid::TableColumn& column : table->columns) require(column.values.size() == table->rows());
  const sysid::Proposal proposal = sysid::propose(*table, {}, true);
  (void)sysid::mapping_table(*table, proposal.mapping);
  (void)sysid::options_of(proposal.mapping);
  const auto result = sysid::convert(*table, proposal.mapping, problems);
  require(result.has_value() == problems.empty());
  (void)problems.format();
  if (!result) return 0;
  require(result->log.size() == result->log.displacement_mm.size() && result->log.time_s.front() == 0);
  (void)sysid::plausibility_warnings(result->log);
  return 0;
}
