#pragma once
// The replies of the socket API about the daemon, as JSON. docs/reference/socket-api.md is the contract.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/settings.h"
#include "daemon/loop/real_time.h"
#include "daemon/loop/statistics.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/provenance.h"
#include "daemon/recording/recorder.h"
#include "daemon/socket/service.h"
#include "rig/gpio_settings.h"

namespace softgrip::daemon {

/// Everything a status is made of. References outlive it.
struct StatusSources {
  const control::RigSettings& rig;
  const Provenance& provenance;
  Service& service;
  const Recorder& recorder;
  const LoopStatistics& loop;
  const BusStatistics& bus;
  const std::string& board;  ///< in one line
  Nanoseconds origin = 0;
  const RealTimeReport* real_time = nullptr;  ///< absent in virtual time
  const rig::GpioSettings* gpio = nullptr;    ///< absent without digital lines
  const SharedState* shared = nullptr;        ///< needed with them
};

/// {"code", "name", "channel"} of a fault, the channel null where it concerns the whole rig; null of none.
[[nodiscard]] nlohmann::ordered_json fault_title_json(const control::Fault& fault,
                                                      const std::vector<std::string>& channel_names);
[[nodiscard]] nlohmann::ordered_json status_json(const StatusSources& sources);
[[nodiscard]] nlohmann::ordered_json statistics_json(const StatusSources& sources,
                                                     const std::vector<EventCount>& events,
                                                     bool with_histograms);
[[nodiscard]] nlohmann::ordered_json event_json(const EventEntry& event);

/// One line; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string line_of(const nlohmann::ordered_json& json);

}  // namespace softgrip::daemon
