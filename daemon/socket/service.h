#pragma once
// Passes requests to the loop, and passes the events of the loop to the threads without real-time scheduling.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/loop/shared_state.h"
#include "daemon/recording/event_log.h"
#include "daemon/recording/sequence_store.h"

namespace softgrip::daemon {

/// All functions must be called from the same thread. The referenced objects must exist longer than this
/// object.
class Service {
 public:
  /// `origin` is time 0 of the event log.
  Service(std::vector<std::string> channel_names, Nanoseconds origin, SharedState& shared, EventLog& log,
          SequenceStore& sequence_store);

  /// Passes a request to the loop and returns the id of the request. If the queue is full because the loop
  /// has not taken the earlier requests yet, returns an empty value. Vent and stop have separate queues,
  /// which the loop reads before all other queues. A vent or stop request always gets an id: if its queue is
  /// full, the id is that of a waiting request with the same effect. `client` appears in the resulting
  /// events; it may be empty.
  std::optional<std::uint32_t> submit(control::Request::Kind kind,
                                      std::shared_ptr<const LoadedSequence> sequence = nullptr,
                                      const std::string& client = {});

  /// Requests the loop to stop the sequence that the request `start` has begun or will begin, and no other
  /// sequence. Returns the id of this stop request. If an earlier stop of this start has no reply yet,
  /// returns the id of the earlier stop. If the queue is full because the loop has not taken the earlier
  /// requests yet, returns nothing.
  std::optional<std::uint32_t> submit_stop(std::uint32_t start, const std::string& client = {});

  /// Moves the events of loop and bus into the log, and stores the replies of the loop.
  void pump();

  /// Returns the loop's reply to a request, or `pending` if there is no reply yet. The first call that
  /// returns a reply removes the stored reply.
  struct Reply {
    enum class Kind : std::uint8_t { pending, accepted, refused };
    Kind kind = Kind::pending;
    control::RefusalCode refusal = control::RefusalCode::none;
    control::Fault fault;  ///< fault that was reset, or fault whose cause is still present; `none` for all
                           ///< other replies
  };
  [[nodiscard]] Reply take_reply(std::uint32_t request);
  /// Discards the loop's reply to a request.
  void discard_reply(std::uint32_t request);

  /// Returns the result of the newest sequence that has ended, and the request that started this sequence.
  struct FinishedSequence {
    std::uint32_t request = 0;  ///< request that started the sequence; 0: no sequence has ended
    control::SequenceEnd end = control::SequenceEnd::done;
  };
  [[nodiscard]] const FinishedSequence& last_finished() const noexcept { return last_finished_; }

  /// Returns the sequence that runs or ran last; nullptr before the first sequence.
  [[nodiscard]] const std::shared_ptr<const LoadedSequence>& sequence() const noexcept { return sequence_; }
  /// Returns the id of the request that started sequence(); 0 before the first sequence.
  [[nodiscard]] std::uint32_t sequence_request() const noexcept { return sequence_request_; }

  /// Returns the name of the client that made a request; empty if the name is unknown. The names of old
  /// requests are removed when many newer requests have arrived.
  [[nodiscard]] std::string client_of(std::uint32_t request) const;
  /// Returns true if the request has started a sequence, and this sequence has not ended yet.
  [[nodiscard]] bool is_running(std::uint32_t request) const noexcept {
    return request != 0 && request == sequence_request_ && last_finished_.request != request;
  }

  /// Reason of the present bus failure: the first failure since the last successful exchange, or the reason
  /// why no connection can be opened. `kind` is the name of the BusStatus, and `text` is a sentence. Both are
  /// empty while the board responds.
  struct BusFailure {
    std::string kind;
    std::string text;
  };
  [[nodiscard]] const BusFailure& bus_failure() const noexcept { return bus_failure_; }
  [[nodiscard]] const std::vector<std::string>& channel_names() const noexcept { return channel_names_; }

  /// Returns the newest state that the loop has published.
  [[nodiscard]] const Snapshot& snapshot() noexcept;

 private:
  void process_event(const StampedEvent& event);
  void update_overall_result(const StampedEvent& event);
  void store_client_name(std::uint32_t request, const std::string& client);
  bool push(const control::Request& request, std::shared_ptr<const LoadedSequence> sequence);
  void register_request(std::uint32_t request, const std::string& client);

  std::vector<std::string> channel_names_;
  Nanoseconds origin_;
  SharedState& shared_;
  Broadcast<StampedEvent>::Reader events_;
  EventLog& log_;
  SequenceStore& sequence_store_;
  std::uint32_t last_request_ = 0;
  std::uint32_t last_vent_ = 0;
  std::uint32_t last_stop_ = 0;
  std::map<std::uint32_t, Reply> replies_;  // replies of the loop by id of the request; a reply is removed
                                            // when it is returned
  std::map<std::uint32_t, std::uint32_t> pending_stops_;  // id of the stop request by id of the start, for
                                                          // stop requests that have no reply yet
  std::vector<control::GripResult> results_;              // grip results by channel in the present sequence
  control::GripResult overall_ = control::GripResult::none;
  std::map<std::uint32_t, std::string> clients_;  // names of the clients that made the newest requests, by id
                                                  // of the request
  std::shared_ptr<const LoadedSequence> sequence_;
  std::uint32_t sequence_request_ = 0;
  FinishedSequence last_finished_;
  BusFailure bus_failure_;
  std::uint64_t events_dropped_ = 0;  // number of lost events that were already reported
};

}  // namespace softgrip::daemon
