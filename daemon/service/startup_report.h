#pragma once
// Builds the report that softgripd or `softgrip run` prints before any motion.

#include <string>
#include <string_view>

#include "daemon/loop/real_time.h"
#include "drivers/board/board.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Several lines: rate, board, bus budget, latency, watchdog, safe actions, feedforward of every channel, and
/// the real-time set-up if there is one (`real_time` may be nullptr: virtual time, or a check without
/// starting). `program` is who drives the rig.
[[nodiscard]] std::string startup_report(const rig::RigFile& rig, const drivers::Board& board,
                                         const RealTimeReport* real_time, std::string_view program);

}  // namespace softgrip::daemon
