#include "daemon/recording/recorder.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/periodic_schedule.h"

namespace softgrip::daemon {

namespace {

constexpr std::size_t batch_records = 256;
constexpr std::size_t text_bytes = 256 * 1024;
/// Time from the end of the last motion to the end of the recording, because the finger settles in this time
/// [ns].
constexpr Nanoseconds tail = ns_per_s / 2;
/// Shortest time between two versions of run.json [ns].
constexpr Nanoseconds json_pause = ns_per_s / 4;
/// Time from a disk error to the next attempt to record [ns].
constexpr Nanoseconds retry_pause = 60 * ns_per_s;
constexpr std::size_t events_per_file = 10'000;

using Kind = control::Event::Kind;

/// Returns the first 60 bytes of the name, with each byte that is not a letter, a digit, '-' or '_' replaced
/// by '_'.
std::string file_name_of(std::string_view name) {
  std::string text;
  for (const char c : name.substr(0, 60)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    text += plain ? c : '_';
  }
  return text;
}

/// Returns the space that the next version of run.json needs at most [bytes].
std::size_t room_for(const RunStory& story) {
  constexpr std::size_t event_bytes = 512;
  const std::size_t sequence_bytes = story.sequence ? 2 * story.sequence->written.text.size() : 0;
  return RunFolder::least_room + sequence_bytes + event_bytes * story.events.size();
}

}  // namespace

struct Recorder::Recording {
  explicit Recording(RunFolder where) : folder(std::move(where)) {}

  RunFolder folder;
  RunStory story;
  Nanoseconds begin = 0;
  Nanoseconds last_motion = 0;
  std::uint64_t dropped_before = 0;
  bool json_due = true;
  Nanoseconds json_at = 0;
  Nanoseconds synced_at = 0;
  std::string text;  // rows that were not yet passed to the kernel
  std::uint64_t rows_in_text = 0;
  Nanoseconds last_row = 0;  // time of the last row in `text`
};

Recorder::Recorder(const rig::RecorderSettings& settings, const Provenance& provenance,
                   std::string only_folder, Nanoseconds origin, SharedState& shared, EventLog& events,
                   SequenceStore& sequence_store)
    : settings_(settings),
      provenance_(provenance),
      only_folder_(std::move(only_folder)),
      always_(!only_folder_.empty() || settings.mode == rig::RecorderSettings::Mode::always),
      origin_(origin),
      shared_(shared),
      loop_events_(shared.events),
      events_(events),
      sequence_store_(sequence_store),
      rows_(provenance.channel_names, provenance.measures_pressure, provenance.measures_temperature),
      batch_(batch_records) {}

Recorder::~Recorder() = default;

void Recorder::drain() {
  for (std::size_t count = shared_.records.pop(batch_); count > 0; count = shared_.records.pop(batch_)) {
    for (std::size_t i = 0; i < count; ++i) take(batch_[i]);
    if (recording_ && recording_->text.size() >= text_bytes) flush(false);
  }
  // In virtual time, hours of a run pass in seconds, and no program reads the file while it grows. Therefore,
  // only complete buffers are passed to the kernel.
  if (recording_ && !provenance_.virtual_time) flush(false);
  show();
}

void Recorder::finish() {
  drain();
  take_events(std::numeric_limits<Nanoseconds>::max());
  if (recording_) end("complete");
  show();
}

void Recorder::take_events(Nanoseconds until) {
  for (;;) {
    if (StampedEvent next; !waiting_ && loop_events_.pop(next)) waiting_ = next;
    if (recording_) recording_->story.events_left_out += loop_events_.lost() - events_lost_;
    events_lost_ = loop_events_.lost();
    if (!waiting_ || waiting_->at > until) return;
    take(*std::exchange(waiting_, std::nullopt));
  }
}

void Recorder::take(const Record& row) {
  take_events(row.at);
  now_ = row.at;
  // The end of the sequence is read from the state and not from an event, because events can be lost.
  if (!control::may_rise(row.state)) running_ = {};
  const bool moves = control::moves(row.state);
  if (recording_ && !always_ && !moves && row.at - recording_->last_motion > tail) end("complete");
  if (!recording_ && may_begin(row.at) && (always_ || moves)) begin(row.at, nullptr);
  if (recording_) return write(row);
  past_rows_.push_back(row);
  forget_before(row.at - nanoseconds(settings_.history_s));
}

void Recorder::take(const StampedEvent& event) {
  now_ = event.at;
  const bool starts = event.event.kind == Kind::sequence_started;
  if (starts) {
    running_ = {event.event.request, sequence_store_.find(event.event.request)};
    sequence_store_.start_taken(SequenceStore::Reader::recorder, event.event.request);
  }
  // A sequence that starts within the settling time after the last motion ends the present recording and
  // begins a new one.
  if (recording_ && !always_ && starts && recording_->story.request != 0) end("complete");
  if (starts && !recording_ && event.at < blocked_) report_unrecorded_start();
  const bool opens = always_ || starts || event.event.kind == Kind::fault_latched;
  if (!recording_ && may_begin(event.at) && opens) begin(event.at, &event.event);
  if (recording_) return write(event);
  past_events_.push_back(event);
  forget_before(event.at - nanoseconds(settings_.history_s));
}

bool Recorder::may_begin(Nanoseconds at) const {
  return at >= blocked_ && (always_ || settings_.mode != rig::RecorderSettings::Mode::off);
}

/// Reports that the running sequence has started in the pause after a disk error.
void Recorder::report_unrecorded_start() {
  const std::string name = running_.sequence ? fmt::format(" '{}'", running_.sequence->prepared.name) : "";
  tell("recording_skipped", Severity::warning,
       only_folder_.empty()
           ? fmt::format("The start of the sequence{} is not recorded, because after a disk error nothing is "
                         "recorded for {} s.",
                         name, retry_pause / ns_per_s)
           : fmt::format("The sequence{} is not recorded, because a disk error ended the recording.", name));
}

void Recorder::forget_before(Nanoseconds at) {
  while (!past_rows_.empty() && past_rows_.front().at < at) past_rows_.pop_front();
  while (!past_events_.empty() && past_events_.front().at < at) past_events_.pop_front();
}

void Recorder::begin(Nanoseconds at, const control::Event* event) {
  const std::string path = folder_for(at, event);
  auto folder = RunFolder::create(path, rows_.header(), !provenance_.virtual_time);
  if (!folder) {
    block();
    tell("recording_failed", Severity::error, fmt::format("Nothing is recorded: {}.", folder.error()));
    const std::scoped_lock lock(status_mutex_);
    status_.error = folder.error();
    return;
  }
  ++recordings_;
  recording_ = std::make_unique<Recording>(std::move(*folder));
  Recording& now = *recording_;
  now.begin = at;
  now.last_motion = at;
  now.dropped_before = shared_.records_dropped.load(std::memory_order_relaxed);
  now.synced_at = at;
  now.text.reserve(2 * text_bytes);
  const bool fault = !always_ && event != nullptr && event->kind == Kind::fault_latched;
  now.story.reason = always_ ? "always" : fault ? "fault" : "sequence";
  if (fault && !past_rows_.empty()) now.begin = past_rows_.front().at;
  if (fault && !past_events_.empty()) now.begin = std::min(now.begin, past_events_.front().at);
  if (!provenance_.virtual_time) now.story.started_at = utc_text(wall_time(now.begin));
  if (fault) {
    for (const Record& row : past_rows_) write(row);
    for (const StampedEvent& past : past_events_) write(past);
  }
  // A recording that begins in the middle of a sequence, after a disk error, states this sequence.
  if (now.story.request == 0) {
    now.story.sequence = running_.sequence;
    now.story.request = running_.request;
  }
  past_rows_.clear();
  past_events_.clear();
  write_json();
  tell("recording_started", Severity::information, fmt::format("Recording to {}.", path));
}

std::string Recorder::folder_for(Nanoseconds at, const control::Event* event) const {
  if (!only_folder_.empty()) return only_folder_;
  std::string name =
      provenance_.virtual_time ? fmt::format("run-{:04}", recordings_ + 1) : utc_text(wall_time(at));
  for (char& c : name) c = c == ':' ? '-' : c;
  if (event != nullptr && event->kind == Kind::fault_latched && !always_) {
    name += "_fault";
  } else if (running_.sequence) {
    name += "_" + file_name_of(running_.sequence->prepared.name);
  }
  const std::string first = settings_.directory + "/" + name;
  std::string path = first;
  std::error_code ignored;
  for (int n = 2; n < 1000 && std::filesystem::exists(path, ignored); ++n)
    path = fmt::format("{}-{}", first, n);
  return path;
}

void Recorder::write(const Record& row) {
  Recording& now = *recording_;
  if (control::moves(row.state)) now.last_motion = row.at;
  now.last_row = row.at;
  ++now.rows_in_text;
  rows_.append(now.text, row, now.begin);
}

void Recorder::write(const StampedEvent& event) {
  Recording& now = *recording_;
  if (event.event.kind == Kind::sequence_started) {
    now.story.sequence = event.event.request == running_.request ? running_.sequence
                                                                 : sequence_store_.find(event.event.request);
    now.story.request = event.event.request;
  }
  if (now.story.events.size() == events_per_file) {
    ++now.story.events_left_out;
    return;
  }
  const control::PreparedSequence* sequence = now.story.sequence ? &now.story.sequence->prepared : nullptr;
  EventEntry entry = describe(event.event, provenance_.channel_names, sequence);
  entry.time_s = seconds(event.at - now.begin);
  now.story.events.push_back(std::move(entry));
  now.json_due = true;
}

/// Passes the waiting rows to the kernel. run.json contains the number of the rows that were passed
/// successfully, and the time of the last of these rows. If the disk is full, the waiting rows are lost.
bool Recorder::append_rows() {
  Recording& now = *recording_;
  if (now.text.empty()) return true;
  const bool good = now.folder.append(now.text, room_for(now.story));
  if (good) {
    now.story.rows += now.rows_in_text;
    now.story.duration_s = seconds(now.last_row - now.begin);
  }
  now.rows_in_text = 0;
  now.text.clear();
  return good;
}

void Recorder::flush(bool last) {
  Recording& now = *recording_;
  bool good = append_rows();
  const bool sync_due = settings_.sync_interval_s > 0 && !provenance_.virtual_time &&
                        (last || now_ - now.synced_at >= nanoseconds(settings_.sync_interval_s));
  if (good && sync_due) {
    good = now.folder.sync();
    now.synced_at = now_;
  }
  if (!good && !last) {
    end("stopped_early");
    return;
  }
  if (now.json_due && !provenance_.virtual_time && now_ - now.json_at >= json_pause) write_json();
}

bool Recorder::write_json() {
  Recording& now = *recording_;
  now.story.dropped_rows = shared_.records_dropped.load(std::memory_order_relaxed) - now.dropped_before;
  now.story.error = now.folder.error();
  now.json_due = false;
  now.json_at = now_;
  return now.folder.replace_json(run_json(provenance_, now.story));
}

void Recorder::end(const char* state) {
  flush(true);
  Recording& now = *recording_;
  now.story.state = now.folder.healthy() ? state : "stopped_early";
  now.folder.release_room();
  write_json();
  if (const std::string& error = now.folder.error(); !error.empty()) {
    block();
    tell("recording_failed", Severity::error,
         fmt::format("The recording ended early; control continues: {}.", error));
  } else if (const std::string& json_error = now.folder.json_error(); !json_error.empty()) {
    tell("recording_failed", Severity::error,
         fmt::format("Recorded all {} rows in {}, but run.json could not be written: {}.", now.story.rows,
                     now.folder.path(), json_error));
  } else {
    tell("recording_finished", Severity::information,
         fmt::format("Recorded {} rows in {}.", now.story.rows, now.folder.path()));
  }
  show();
  recording_.reset();
  const std::scoped_lock lock(status_mutex_);
  status_.active = false;
}

void Recorder::block() {
  // If the user has chosen the folder, a second attempt would fail: the folder exists after the first
  // attempt, and a recording is never overwritten.
  blocked_ = only_folder_.empty() ? now_ + retry_pause : std::numeric_limits<Nanoseconds>::max();
}

void Recorder::tell(const char* kind, Severity severity, std::string text) {
  events_.add(event_of(kind, severity, seconds(now_ - origin_), std::move(text)));
}

void Recorder::show() {
  const std::scoped_lock lock(status_mutex_);
  status_.dropped_rows = shared_.records_dropped.load(std::memory_order_relaxed);
  status_.active = recording_ != nullptr;
  if (!recording_) return;
  status_.folder = recording_->folder.path();
  status_.rows = recording_->story.rows;
  const RunFolder& folder = recording_->folder;
  status_.error = folder.error().empty() ? folder.json_error() : folder.error();
}

RecorderStatus Recorder::status() const {
  const std::scoped_lock lock(status_mutex_);
  return status_;
}

}  // namespace softgrip::daemon
