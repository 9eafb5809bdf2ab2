#pragma once
// Builds the replies of the socket API about the daemon as JSON. docs/reference/socket-api.md specifies the
// replies.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/real_time.h"
#include "daemon/loop/statistics.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/recorder.h"
#include "daemon/recording/run_json.h"
#include "daemon/socket/service.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// The objects from which a status is read. The objects must exist longer than this struct.
struct StatusSources {
  const control::RigSettings& rig;
  const Provenance& provenance;
  Service& service;
  const Recorder& recorder;
  const LoopStatistics& loop;
  const BusStatistics& bus;
  const std::string& board;  ///< description of the board in one line
  Nanoseconds origin = 0;
  const RealTimeReport* real_time = nullptr;  ///< report on the real-time settings; nullptr in virtual time
  const rig::GpioSettings* gpio = nullptr;    ///< settings of the digital lines; nullptr if the rig has none
  const SharedState* shared = nullptr;  ///< state that the threads share; must not be nullptr if `gpio` is
                                        ///< set
};

/// Returns a fault as {"code", "name", "channel"}; the channel is null if the fault concerns the complete
/// rig. Returns null if there is no fault.
[[nodiscard]] nlohmann::ordered_json fault_title_json(const control::Fault& fault,
                                                      const std::vector<std::string>& channel_names);
[[nodiscard]] nlohmann::ordered_json status_json(const StatusSources& sources);
[[nodiscard]] nlohmann::ordered_json statistics_json(const StatusSources& sources,
                                                     const std::vector<EventCount>& events,
                                                     bool with_histograms);

/// Returns the JSON as one line. Bytes that are not valid UTF-8 are replaced.
[[nodiscard]] std::string line_of(const nlohmann::ordered_json& json);

/// Returns null if no finger is pressurised. Otherwise returns an object with three members. `channels` is a
/// list of `name` and `command_kpa`, `command` is the shell command that vents these channels, and `text`
/// states both in one or two sentences.
[[nodiscard]] nlohmann::ordered_json under_pressure_json(
    const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot);

}  // namespace softgrip::daemon
