#pragma once
// Events in words: what the socket API, the recordings and the log show.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "control/tick/parameter.h"
#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// How much attention an event wants.
enum class Severity : std::uint8_t { information, warning, error };

/// One event, as everybody outside the loop sees it.
struct EventEntry {
  std::uint64_t id = 0;  ///< counts from 1, without gaps
  double time_s = 0;     ///< since the daemon's start, or since the recording's
  std::string kind;      ///< "fault_latched", "bus_failed", ...; a contract
  Severity severity = Severity::information;
  std::string channel;        ///< its name, or empty for the whole rig
  std::string code;           ///< "F101", "R02", "HOLDING", a state, a step; by kind; may be empty
  std::string text;           ///< one sentence
  std::uint32_t request = 0;  ///< the request it answers, or 0
  std::string client;         ///< name of the client that made the request; empty: unknown
  double value = 0;           ///< a number that goes with it, or 0
  std::vector<control::Argument> parameters;  ///< of sequence_started: what the sequence runs with
};

/// Describes an event of the controller. `time_s` and `id` are left to the caller. `sequence` is the one that
/// runs or is started, or nullptr.
[[nodiscard]] EventEntry describe(const control::Event& event, const std::vector<std::string>& channel_names,
                                  const control::PreparedSequence* sequence);
/// Describes an event of the bus.
[[nodiscard]] EventEntry describe(const BusEvent& event);
/// Describes an event of the digital lines.
[[nodiscard]] EventEntry describe(const PanelEvent& event);
/// "information", "warning", "error"
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;

/// "F202 reading_out_of_range of left"; without a finger where it concerns the whole rig.
[[nodiscard]] std::string title_of(const control::Fault& fault,
                                   const std::vector<std::string>& channel_names);

/// Returns the meaning of a refusal and its remedy, as sentences. `cause`: for cause_persists, the remaining
/// cause.
[[nodiscard]] std::string sentences_of(control::RefusalCode refusal, const control::Fault& cause,
                                       const std::vector<std::string>& channel_names);

/// How often something has happened since the daemon's start.
struct EventCount {
  std::string kind;
  std::string code;     ///< left out of kinds whose codes are names or numbers of a sequence
  std::string channel;  ///< empty for the whole rig
  std::uint64_t count = 0;
};

/// The newest events, for all threads but the loop, and how many of each sort there were.
class EventLog {
 public:
  explicit EventLog(std::size_t capacity) : capacity_(capacity) {}

  /// Gives the event its id, which it returns.
  std::uint64_t add(EventEntry entry);
  /// Those after `id`, oldest first, at most `limit`.
  [[nodiscard]] std::vector<EventEntry> since(std::uint64_t id, std::size_t limit) const;
  /// The id of the newest event; 0 if there is none.
  [[nodiscard]] std::uint64_t newest() const;
  /// The id of the oldest that is kept; 0 if there is none.
  [[nodiscard]] std::uint64_t oldest() const;
  /// By kind, code and channel; those that never happened are not there.
  [[nodiscard]] std::vector<EventCount> counts() const;

 private:
  using Sort = std::tuple<std::string, std::string, std::string>;  // kind, code, channel

  mutable std::mutex mutex_;
  std::size_t capacity_;
  std::uint64_t last_id_ = 0;
  std::deque<EventEntry> entries_;
  std::map<Sort, std::uint64_t> counts_;
};

}  // namespace softgrip::daemon
