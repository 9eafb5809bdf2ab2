#pragma once
// Describes events for the socket API, the recordings and the event log, and stores them.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "control/tick/sequence.h"
#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// The importance of an event for users.
enum class Severity : std::uint8_t { information, warning, error };

/// One event in the form in which users and clients get it.
struct EventEntry {
  std::uint64_t id = 0;  ///< id of the event: 1, 2, 3, ...
  double time_s = 0;     ///< time since the start of the daemon or of the recording [s]
  std::string kind;      ///< name of the kind, such as "fault_latched" or "bus_failed"; clients may depend on
                         ///< these names
  Severity severity = Severity::information;
  std::string channel;        ///< name of the channel; empty if the event concerns the complete rig
  std::string code;           ///< code of the event: "F101", "R02", "HOLDING", a state or a step, depending
                              ///< on the kind; may be empty
  std::string text;           ///< the event in one sentence
  std::uint32_t request = 0;  ///< id of the request to which this event is the reply; 0: none
  std::string client;         ///< name of the client that made the request; empty if the client is unknown
  double value = 0;  ///< number that belongs to the event, such as a distance or a count; 0 if there is none
  std::vector<control::Argument> parameters;  ///< for sequence_started: the values of the parameters
};

/// Describes an event of the controller. The caller sets `time_s` and `id`. `sequence` is the sequence that
/// runs or has just been started; nullptr if there is none.
[[nodiscard]] EventEntry describe(const control::Event& event, const std::vector<std::string>& channel_names,
                                  const control::PreparedSequence* sequence);
/// Describes an event of the bus.
[[nodiscard]] EventEntry describe(const BusEvent& event);
/// Describes an event of the digital lines.
[[nodiscard]] EventEntry describe(const PanelEvent& event);
/// Returns an event with a text of its own.
[[nodiscard]] EventEntry event_of(std::string kind, Severity severity, double time_s, std::string text);
/// Returns the name of a severity: "information", "warning" or "error".
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;

/// Returns "F202 reading_out_of_range of left", or the code and the name without a channel if the fault
/// concerns the complete rig.
[[nodiscard]] std::string title_of(const control::Fault& fault,
                                   const std::vector<std::string>& channel_names);

/// Returns the meaning of a refusal and its remedy, as sentences. For the refusal cause_persists, `cause` is
/// the fault condition that is still present.
[[nodiscard]] std::string sentences_of(control::RefusalCode refusal, const control::Fault& cause,
                                       const std::vector<std::string>& channel_names);

/// The number of events of one kind, code and channel since the daemon's start.
struct EventCount {
  std::string kind;
  std::string code;     ///< code of the events; empty for kinds whose codes are names or numbers from a
                        ///< sequence, which are not counted separately
  std::string channel;  ///< channel of the events; empty if the events concern the complete rig
  std::uint64_t count = 0;
};

/// Stores the newest events for all threads except the loop. Also counts the events of each kind.
class EventLog {
 public:
  explicit EventLog(std::size_t capacity) : capacity_(capacity) {}

  /// Assigns an id to the event, stores it and returns the id.
  std::uint64_t add(EventEntry entry);
  /// Returns the events whose id is larger than `id`, oldest first, but at most `limit` events.
  [[nodiscard]] std::vector<EventEntry> since(std::uint64_t id, std::size_t limit) const;
  /// Returns the id of the newest event; 0 if there is none.
  [[nodiscard]] std::uint64_t newest() const;
  /// Returns the id of the oldest stored event; 0 if there is none.
  [[nodiscard]] std::uint64_t oldest() const;
  /// Returns the number of events by kind, code and channel. Events that never occurred are not in the list.
  [[nodiscard]] std::vector<EventCount> counts() const;

 private:
  using Sort = std::tuple<std::string, std::string, std::string>;  // kind, code and channel of an event

  mutable std::mutex mutex_;
  std::size_t capacity_;
  std::uint64_t last_id_ = 0;
  std::deque<EventEntry> entries_;
  std::map<Sort, std::uint64_t> counts_;
};

}  // namespace softgrip::daemon
