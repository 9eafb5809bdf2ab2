#pragma once
// The recorder: takes rows and events from the loop and writes recordings.

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/loop/shared_state.h"
#include "daemon/recording/csv_row.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/run_folder.h"
#include "daemon/recording/run_json.h"
#include "daemon/recording/sequence_store.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// Status of the recorder.
struct RecorderStatus {
  bool active = false;
  std::string folder;      ///< folder of the present or last recording; empty before the first recording
  std::uint64_t rows = 0;  ///< rows of this recording in run.csv
  std::uint64_t dropped_rows = 0;  ///< rows that were lost since the daemon's start
  std::string error;               ///< disk error of the present or last recording
};

/// Decides when recordings start and end, and writes them. In the mode `always`, one recording contains all
/// data. In the mode `sequences`, a recording starts with a sequence and ends 0.5 s after the last motion of
/// the sequence. A fault outside a sequence gets its own recording, which starts history_s before the fault.
/// A disk error is reported as an event and ends the recording. After a pause, the recorder tries to begin a
/// new recording. Each sequence that starts in the pause is reported as an event. All functions except
/// status() must be called from the same thread.
class Recorder {
 public:
  /// If `only_folder` is not empty, the recorder ignores the recording mode and records all data from start
  /// to stop in this folder. `origin` is time 0 of the event log. All referenced objects must exist longer
  /// than the recorder.
  Recorder(const rig::RecorderSettings& settings, const Provenance& provenance, std::string only_folder,
           Nanoseconds origin, SharedState& shared, EventLog& events, SequenceStore& sequence_store);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  Recorder(Recorder&&) = delete;
  Recorder& operator=(Recorder&&) = delete;
  ~Recorder();

  /// Takes the new rows and events of the loop, and passes the rows to the kernel. Must be called at least
  /// every flush_interval_s.
  void drain();
  /// Takes the last rows and events as drain() does, and ends the recording.
  void finish();

  /// Returns the status. Any thread may call this function.
  [[nodiscard]] RecorderStatus status() const;

 private:
  struct Recording;
  /// A sequence that was started.
  struct StartedSequence {
    std::uint32_t request = 0;  ///< id of the request that started the sequence; 0: there is no sequence
    std::shared_ptr<const LoadedSequence> sequence;  ///< nullptr if the sequence is no longer stored
  };

  /// Takes the events of the loop up to and including the time `until`.
  void take_events(Nanoseconds until);
  void take(const Record& row);
  void take(const StampedEvent& event);
  void write(const Record& row);
  void write(const StampedEvent& event);
  [[nodiscard]] bool may_begin(Nanoseconds at) const;
  void report_unrecorded_start();
  void forget_before(Nanoseconds at);
  /// Begins a recording at the time `at`. `event` is the first event of the recording; nullptr if the
  /// recording begins with a row.
  void begin(Nanoseconds at, const control::Event* event);
  [[nodiscard]] std::string folder_for(Nanoseconds at, const control::Event* event) const;
  void end(const char* state);
  bool append_rows();
  void flush(bool last);
  bool write_json();
  void block();
  void tell(const char* kind, Severity severity, std::string text);
  void show();

  const rig::RecorderSettings& settings_;
  const Provenance& provenance_;
  std::string only_folder_;
  bool always_;  // true: one recording contains all data from start to stop
  Nanoseconds origin_;
  SharedState& shared_;
  Broadcast<StampedEvent>::Reader loop_events_;
  std::optional<StampedEvent> waiting_;  // event that is newer than the newest row, and therefore waits
  std::uint64_t events_lost_ = 0;        // number of lost events that were already reported
  EventLog& events_;
  SequenceStore& sequence_store_;
  CsvRows rows_;
  std::vector<Record> batch_;
  std::deque<Record> past_rows_;  // rows before the next recording, kept while no recording is active
  std::deque<StampedEvent> past_events_;
  StartedSequence running_;  // sequence that runs at the time now_
  std::unique_ptr<Recording> recording_;
  std::uint32_t recordings_ = 0;
  Nanoseconds now_ = 0;      // time of the newest row or event
  Nanoseconds blocked_ = 0;  // time before which no recording begins, because of a disk error
  mutable std::mutex status_mutex_;
  RecorderStatus status_;
};

}  // namespace softgrip::daemon
