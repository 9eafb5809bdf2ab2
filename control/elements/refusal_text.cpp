#include "control/elements/refusal_text.h"

#include <array>
#include <cstddef>

namespace softgrip::control {

namespace {
/// The texts for all refusals, in the order of RefusalCode.
constexpr std::array<RefusalText, 13> texts{{
    {"There is no reason.", ""},
    {"A fault is latched.",
     "`softgrip status` names the fault and its remedy; then run `softgrip acknowledge`. `softgrip vent` is "
     "always available."},
    {"A sequence runs, starts or is being stopped.",
     "Wait for its end (`softgrip watch`), or end it with `softgrip stop`."},
    {"The interlock is open: no part is in position.", "Close it, then start again."},
    {"The emergency stop is pressed.", "Make the area safe and release it; then run `softgrip acknowledge`."},
    {"The sequence was prepared for another rig.", "Start it again: `softgrip start SEQUENCE`."},
    {"The rig is starting, or a channel of the sequence has no valid reading.",
     "`softgrip status` names the channel; `softgrip doctor` finds the reason."},
    {"No sequence runs.", "`softgrip release` vents a pressurised finger."},
    {"No fault is latched, and no grip result needs an acknowledgement.",
     "The rig can be started: `softgrip start SEQUENCE`."},
    {"The cause of a fault is still present.",
     "`softgrip status` names its remedy; acknowledge again after it."},
    {"A stop or vent request superseded the start.", "Start again if the rig should move."},
    {"No sequence runs and every channel is at its rest pressure.", "No finger is pressurised."},
    {"The start that this stop names does not run, and will not begin.",
     "There is nothing to do. `softgrip stop` stops any sequence."},
}};
static_assert(static_cast<std::size_t>(RefusalCode::named_start_not_running) + 1 == texts.size());
}  // namespace

const RefusalText& text_of(RefusalCode code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return texts[index < texts.size() ? index : 0];
}

}  // namespace softgrip::control
