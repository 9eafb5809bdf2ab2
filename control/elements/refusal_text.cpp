#include <string_view>

#include "base/enum_table.h"
#include "control/elements/fault.h"

namespace softgrip::control {

namespace {
struct RefusalInfo {
  std::string_view id;
  std::string_view name;
  RefusalText text;
};
constexpr auto refusals = enum_table<RefusalCode, RefusalInfo>({
    {RefusalCode::none, {"R00", "none", {"The request was not refused.", ""}}},
    {RefusalCode::faulted,
     {"R01",
      "faulted",
      {"A fault is latched.",
       "`softgrip status` names the fault and its remedy; then run `softgrip acknowledge`. `softgrip vent` "
       "is "
       "always available."}}},
    {RefusalCode::not_idle,
     {"R02",
      "not_idle",
      {"A sequence runs, starts or is being stopped.",
       "Wait for the end of the sequence (`softgrip watch`), or end it with `softgrip stop`."}}},
    {RefusalCode::interlock_open,
     {"R03",
      "interlock_open",
      {"The interlock is open: no part is in position.",
       "Close the interlock, then start the sequence again."}}},
    {RefusalCode::emergency_stop,
     {"R04",
      "emergency_stop",
      {"The emergency stop is pressed.",
       "Make the area safe and release the emergency stop; then run `softgrip acknowledge`."}}},
    {RefusalCode::sequence_unfit,
     {"R05",
      "sequence_unfit",
      {"The sequence was prepared for another rig.",
       "Prepare and start the sequence again: `softgrip start SEQUENCE`."}}},
    {RefusalCode::no_valid_reading,
     {"R06",
      "no_valid_reading",
      {"The rig is starting, or a channel of the sequence has no valid reading.",
       "`softgrip status` names the channel; `softgrip doctor` finds the reason."}}},
    {RefusalCode::nothing_to_stop,
     {"R07", "nothing_to_stop", {"No sequence runs.", "`softgrip release` vents a pressurised finger."}}},
    {RefusalCode::nothing_to_acknowledge,
     {"R08",
      "nothing_to_acknowledge",
      {"There is nothing to acknowledge: no fault is latched, and no grip result needs an acknowledgement.",
       "The rig is ready: `softgrip start SEQUENCE` starts a sequence."}}},
    {RefusalCode::cause_persists,
     {"R09",
      "cause_persists",
      {"The cause of a fault is still present.",
       "`softgrip status` names the remedy. Apply the remedy, then acknowledge again."}}},
    {RefusalCode::overtaken,
     {"R10",
      "overtaken",
      {"A stop or vent request superseded the start.",
       "To run the sequence, send the start request again."}}},
    {RefusalCode::nothing_to_release,
     {"R11",
      "nothing_to_release",
      {"No sequence runs and every channel is at its rest pressure.", "No finger is pressurised."}}},
    {RefusalCode::named_start_not_running,
     {"R12",
      "named_start_not_running",
      {"The stop request names a start whose sequence does not run and will not begin.",
       "No action is required. To stop any running sequence, use `softgrip stop` without naming a start."}}},
});
}  // namespace

std::string_view id_of(RefusalCode code) noexcept {
  return refusals[code].id;
}

std::string_view name_of(RefusalCode code) noexcept {
  return refusals[code].name;
}

const RefusalText& text_of(RefusalCode code) noexcept {
  return refusals[code].text;
}

}  // namespace softgrip::control
