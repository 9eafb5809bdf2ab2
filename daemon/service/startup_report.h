#pragma once
// Builds the report that softgripd or `softgrip run` prints before any motion.

#include <string>
#include <string_view>

#include "daemon/loop/real_time.h"
#include "drivers/board/board.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Returns several lines: rate, board, bus budget, latency, watchdog, safe actions and the feedforward of
/// each channel. If `real_time` is not nullptr, the lines contain the real-time settings. `real_time` is
/// nullptr in virtual time and for `--check`. `program` is the name of the program that drives the rig.
[[nodiscard]] std::string startup_report(const rig::RigFile& rig, const drivers::Board& board,
                                         const RealTimeReport* real_time, std::string_view program);

}  // namespace softgrip::daemon
