#pragma once
// Creates the text of run.json.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/parameter.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/provenance.h"
#include "daemon/recording/sequence_store.h"

namespace softgrip::daemon {

/// State of one recording, and data that only this recording has.
struct RunStory {
  std::string state = "recording";  ///< state of the recording: "recording", "complete", "stopped_early"
                                    ///< (rows could not be written)
  std::string reason;               ///< reason why the recording was started: "sequence", "fault", "always"
  std::string started_at;           ///< start time, UTC, ISO 8601; empty in virtual time
  double duration_s = 0;
  std::uint64_t rows = 0;
  std::uint64_t dropped_rows = 0;
  std::shared_ptr<const LoadedSequence> sequence;
  std::uint32_t request = 0;  ///< id of the request that started the sequence of this recording
  std::vector<EventEntry> events;
  std::uint64_t events_left_out = 0;  ///< number of events that did not fit into the file
  std::string error;                  ///< disk error of the recording; empty if there was none
};

/// Returns the parameters of a sequence as an object: {"squeeze_kpa": 4}.
[[nodiscard]] nlohmann::ordered_json parameters_json(const std::vector<control::Argument>& parameters);

[[nodiscard]] std::string run_json(const Provenance& provenance, const RunStory& story);

}  // namespace softgrip::daemon
