#include "control/elements/fault.h"

#include <array>
#include <cstddef>

namespace softgrip::control {

namespace {
/// The texts for all codes of a refusal, in the order of RefusalCode.
constexpr std::array<RefusalText, 13> texts{{
    {"The request was not refused.", ""},
    {"A fault is latched.",
     "`softgrip status` names the fault and its remedy; then run `softgrip acknowledge`. `softgrip vent` is "
     "always available."},
    {"A sequence runs, starts or is being stopped.",
     "Wait for the end of the sequence (`softgrip watch`), or end it with `softgrip stop`."},
    {"The interlock is open: no part is in position.", "Close the interlock, then start the sequence again."},
    {"The emergency stop is pressed.",
     "Make the area safe and release the emergency stop; then run `softgrip acknowledge`."},
    {"The sequence was prepared for another rig.",
     "Prepare and start the sequence again: `softgrip start SEQUENCE`."},
    {"The rig is starting, or a channel of the sequence has no valid reading.",
     "`softgrip status` names the channel; `softgrip doctor` finds the reason."},
    {"No sequence runs.", "`softgrip release` vents a pressurised finger."},
    {"There is nothing to acknowledge: no fault is latched, and no grip result needs an acknowledgement.",
     "The rig is ready: `softgrip start SEQUENCE` starts a sequence."},
    {"The cause of a fault is still present.",
     "`softgrip status` names the remedy. Apply the remedy, then acknowledge again."},
    {"A stop or vent request superseded the start.", "To run the sequence, send the start request again."},
    {"No sequence runs and every channel is at its rest pressure.", "No finger is pressurised."},
    {"The stop request names a start whose sequence does not run and will not begin.",
     "No action is required. To stop any running sequence, use `softgrip stop` without naming a start."},
}};
static_assert(static_cast<std::size_t>(RefusalCode::named_start_not_running) + 1 == texts.size());
}  // namespace

const RefusalText& text_of(RefusalCode code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return texts[index < texts.size() ? index : 0];
}

}  // namespace softgrip::control
