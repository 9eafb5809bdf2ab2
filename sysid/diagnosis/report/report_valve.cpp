#include "sysid/diagnosis/report/report_sections.h"

#include <string>
#include <string_view>
#include <vector>

#include "base/numbers.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {
namespace {

Table parts_table(const ValveFindings& in_valve) {
  const auto row_of = [](std::string_view title, const CauseParameter& p, const Spread& gain) {
    result::Fields row = parameter_fields(title, p);
    row.emplace_back("", "reduction of the held-out pressure error [%]", spread_value(gain, 0));
    return row;
  };
  std::vector<result::Fields> rows;
  for (const NamedCause& named : in_valve.named) {
    std::string title(named.cause.title);
    for (const Cause& alternative : named.alternatives)
      title += " or " + alternative_title(alternative, in_valve.named);
    for (const CauseParameter& p : named.parameters) rows.push_back(row_of(title, p, named.gain_percent));
  }
  return result::table_of("Causes between command and measured pressure", row_of("", {}, {}), rows);
}

}  // namespace

void add_valve_section(Page& page, const ValveFindings& in_valve) {
  const ValveStage& stage = in_valve.stage;
  page.section("Valve");
  page.paragraph("The valve was identified from the command and the measured pressure. A dead time of " +
                 significant(stage.delay_s, 2) + " s and a lag of " + significant(stage.filling_s, 2) +
                 " s (filling) and " + significant(stage.venting_s, 2) + " s (venting)" +
                 (in_valve.named.empty() ? "" : ", with the causes of the table,") + " leave an error of " +
                 significant(in_valve.heldout_rmse_kpa, 2) +
                 " kPa on held-out blocks. The noise of the pressure is " +
                 significant(in_valve.noise_kpa, 2) + " kPa." +
                 (stage.is_far_off() ? " The error exceeds 5 % of the pressure range. The valve does not "
                                       "match this structure, so no cause in the valve is named."
                                     : ""));
  if (!in_valve.named.empty()) page.table(parts_table(in_valve));
}

}  // namespace softgrip::sysid
