#include "sysid/diagnosis/report/report_valve.h"

#include <string>

#include "base/numbers.h"
#include "sysid/diagnosis/verdict/naming.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {
namespace {

Table parts_table(const ValveFindings& in_valve) {
  Table table;
  table.caption = "What the model lacks in the valve";
  table.header = {"cause",         "parameter", "value",
                  "95 % interval", "unit",      "lowers the pressure's held-out error by [%]"};
  table.numeric = {false, false, true, true, false, true};
  for (const NamedCause& named : in_valve.named) {
    const Spread& gain = named.heldout_gain_percent;
    std::string title(named.cause.title);
    for (const Cause& alternative : named.alternatives)
      title += " or " + alternative_title(alternative, in_valve.named);
    for (const CauseParameter& p : named.parameters) {
      table.rows.push_back(
          {title, p.name, significant(p.value, 4),
           p.has_interval ? text_of(p.ci95, p.value, " to ") : "not fitted", p.unit,
           fixed(gain.value, 0) + " (" + fixed(gain.lower, 0) + " to " + fixed(gain.upper, 0) + ")"});
    }
  }
  return table;
}

}  // namespace

void add_valve_section(Page& page, const ValveFindings& in_valve) {
  const ValveStage& stage = in_valve.stage;
  page.section("The valve, by the measured pressure");
  page.paragraph(
      "Command and measured pressure were compared beside the displacement. A dead time of " +
      significant(stage.delay_s, 2) + " s and a lag of " + significant(stage.filling_s, 2) +
      " s while filling and " + significant(stage.venting_s, 2) + " s while venting" +
      (in_valve.named.empty() ? "" : ", with what the table names,") + " leave " +
      significant(in_valve.heldout_rmse_kpa, 2) + " kPa on held-out blocks; the pressure's noise is " +
      significant(in_valve.noise_kpa, 2) + " kPa." +
      (stage.is_far_off()
           ? " That is more than a twentieth of its range: this valve is another thing, and nothing is "
             "named in it."
           : ""));
  if (!in_valve.named.empty()) page.table(parts_table(in_valve));
}

}  // namespace softgrip::sysid
