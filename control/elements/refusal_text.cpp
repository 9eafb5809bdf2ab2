#include "control/elements/refusal_text.h"

#include <array>
#include <cstddef>

namespace softgrip::control {

namespace {
/// In the order of RefusalCode.
constexpr std::array<RefusalText, 13> texts{{
    {"There is no reason.", ""},
    {"A fault is latched.",
     "`softgrip status` says which and what to do about it; then `softgrip acknowledge`. `softgrip vent` "
     "works all "
     "the same."},
    {"A sequence runs, starts or is being stopped.",
     "Wait for its end (`softgrip watch`), or end it with `softgrip stop`."},
    {"The interlock is open: no part is in position.", "Close it, then start again."},
    {"The emergency stop is pressed.", "Make the place safe and reset it; then `softgrip acknowledge`."},
    {"The sequence was prepared for another rig.", "Start it again: `softgrip start SEQUENCE`."},
    {"The rig is starting, or a channel of the sequence has no valid reading.",
     "`softgrip status` shows which; `softgrip doctor` looks for the reason."},
    {"No sequence runs.", "A finger that is still under pressure is let down by `softgrip release`."},
    {"No fault is latched and no grip result stands.", "The rig can be started: `softgrip start SEQUENCE`."},
    {"What caused a fault is still there.",
     "`softgrip status` says what to do about it; acknowledge again when it is gone."},
    {"A stop or a vent was asked for before the loop could take the start.", "Start again if it shall move."},
    {"No sequence runs and every channel is at its rest pressure.", "There is nothing to let go of."},
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
