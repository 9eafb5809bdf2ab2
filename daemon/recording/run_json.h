#pragma once
// Defines the data of run.json, and creates the text of run.json.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/tick/sequence.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/sequence_store.h"

namespace softgrip::daemon {

/// A file that the recorded run used, with its hash.
struct SourceFile {
  std::string role;  ///< purpose of the file: "rig", "board", "model" or "plant"
  std::string path;
  std::string sha256;
};

/// Data that are the same in all recordings of a daemon.
struct Provenance {
  std::string software_version;
  std::string rig;  ///< name of the recorded rig
  std::vector<SourceFile> files;
  std::vector<std::string> channel_names;
  bool simulated = false;          ///< true: there is no real board; fingers, valves and sensors are
                                   ///< simulated
  bool measures_pressure = false;  ///< true: at least one channel has a measured pressure
  bool measures_temperature = false;
  double rate_hz = 0;
  std::uint32_t decimation = 1;
  std::optional<std::uint64_t> seed;  ///< seed of a simulated board; empty for a real board
  bool virtual_time = false;          ///< true: the run is in virtual time, so its recording contains no
                                      ///< wall-clock time
};

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

/// Returns an event as an object. Members that the event does not have are absent. An event of a recording
/// has no id and no client.
[[nodiscard]] nlohmann::ordered_json event_json(const EventEntry& event);

[[nodiscard]] std::string run_json(const Provenance& provenance, const RunStory& story);

}  // namespace softgrip::daemon
