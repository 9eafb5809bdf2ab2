#pragma once
// Requests into the loop and events out of it, for everything that is not real-time.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/loop/wires.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/sequence_shelf.h"

namespace softgrip::daemon {

/// All calls come from one thread. References outlive it.
class Service {
 public:
  /// `origin`: time 0 of the event log.
  Service(std::vector<std::string> channel_names, Nanoseconds origin, Wires& wires, EventLog& log,
          SequenceShelf& shelf);

  /// Hands a request to the loop; returns its id, or nothing if the loop has not taken the last ones yet.
  /// Vent and stop have lanes of their own, which pass whatever else waits, and always return an id: if their
  /// lane is full, that of one that waits in it and will do the same. `client` stands in the events that come
  /// of it; may be empty.
  std::optional<std::uint32_t> submit(control::Request::Kind kind,
                                      std::shared_ptr<const LoadedSequence> sequence = nullptr,
                                      const std::string& client = {});

  /// Hands over a stop of what the request `start` began, or will begin, and of nothing else. Returns its id;
  /// that of an earlier one of the same start that waits for its answer; or nothing if the loop has not taken
  /// the last ones yet.
  std::optional<std::uint32_t> submit_stop_of(std::uint32_t start, const std::string& client = {});

  /// Moves what loop and bus had to tell into the log, and notes answers.
  void pump();

  /// What the loop said to a request. Everything but `pending` is said once.
  struct Answer {
    enum class Kind : std::uint8_t { pending, accepted, refused };
    Kind kind = Kind::pending;
    control::RefusalCode refusal = control::RefusalCode::none;
    control::Fault fault;  ///< that was acknowledged, or whose cause is still there; none where there is none
  };
  [[nodiscard]] Answer take_answer(std::uint32_t request);
  /// Nobody waits for the answer any more.
  void forget(std::uint32_t request);

  /// How the newest sequence ended that has ended, and which request had started it.
  struct Ending {
    std::uint32_t request = 0;  ///< 0: none so far
    control::SequenceEnd end = control::SequenceEnd::done;
  };
  [[nodiscard]] const Ending& last_ending() const noexcept { return ending_; }

  /// The sequence that runs or ran last; nullptr before the first.
  [[nodiscard]] const std::shared_ptr<const LoadedSequence>& sequence() const noexcept { return sequence_; }
  /// The request that started it, or 0.
  [[nodiscard]] std::uint32_t sequence_request() const noexcept { return sequence_request_; }

  /// Who made a request; empty where nobody said so, or too many came since.
  [[nodiscard]] std::string client_of(std::uint32_t request) const;
  /// A request has started a sequence that has not ended.
  [[nodiscard]] bool runs(std::uint32_t request) const noexcept {
    return request != 0 && request == sequence_request_ && ending_.request != request;
  }

  /// The first failure since the last good exchange, or why no session can be opened again: the name of its
  /// BusStatus, and a sentence. Both empty while the board answers.
  struct BusFailure {
    std::string kind;
    std::string text;
  };
  [[nodiscard]] const BusFailure& bus_failure() const noexcept { return bus_failure_; }
  [[nodiscard]] const std::vector<std::string>& channel_names() const noexcept { return channel_names_; }

  /// The newest state of the loop.
  [[nodiscard]] const Snapshot& snapshot() noexcept;

 private:
  void take(const StampedEvent& event);
  void note_result(const StampedEvent& event);
  void note_client(std::uint32_t request, const std::string& client);
  bool push(const control::Request& request, std::shared_ptr<const LoadedSequence> sequence);
  void note_submitted(std::uint32_t request, const std::string& client);

  std::vector<std::string> channel_names_;
  Nanoseconds origin_;
  Wires& wires_;
  Broadcast<StampedEvent>::Reader events_;
  EventLog& log_;
  SequenceShelf& shelf_;
  std::uint32_t last_request_ = 0;
  std::uint32_t last_vent_ = 0;
  std::uint32_t last_stop_ = 0;
  std::map<std::uint32_t, Answer> answers_;          // of requests that were submitted and not taken
  std::map<std::uint32_t, std::uint32_t> stops_of_;  // by start: its stop that waits for an answer
  std::vector<control::GripResult> results_;         // by channel, of the sequence
  control::GripResult overall_ = control::GripResult::none;
  std::map<std::uint32_t, std::string> clients_;  // who made the newest requests
  std::shared_ptr<const LoadedSequence> sequence_;
  std::uint32_t sequence_request_ = 0;
  Ending ending_;
  BusFailure bus_failure_;
  std::uint64_t events_dropped_ = 0;  // told so far
};

}  // namespace softgrip::daemon
