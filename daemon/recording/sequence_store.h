#pragma once
// Stores the sequences of the loop as long as a thread uses them.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "control/tick/sequence.h"

namespace softgrip::daemon {

/// A sequence as it was read from its file, and the same sequence fitted to the rig.
struct LoadedSequence {
  control::Sequence written;
  control::PreparedSequence prepared;
  std::string sha256;          ///< hash of the text of the sequence
  document::Problems remarks;  ///< warnings about differences between the sequence file and the motion of the
                               ///< rig
};

/// Stores each sequence by the number of the request that starts it. The loop has a plain pointer to the
/// entry. An entry remains until its request is refused, or until both readers have taken the start of a
/// later sequence.
class SequenceStore {
 public:
  /// The two threads that read the events of the loop and look up the sequences of these events.
  enum class Reader : std::uint8_t { service, recorder };
  /// Largest number of ended sequences that are stored for a recorder that lags. If the recorder lags more,
  /// the oldest of these sequences are removed.
  static constexpr std::size_t most_ended = 64;

  void put(std::uint32_t request, std::shared_ptr<const LoadedSequence> sequence) {
    const std::scoped_lock lock(mutex_);
    sequences_.insert_or_assign(request, std::move(sequence));
  }
  /// Returns the sequence of a request; nullptr if it is not stored.
  [[nodiscard]] std::shared_ptr<const LoadedSequence> find(std::uint32_t request) const {
    const std::scoped_lock lock(mutex_);
    const auto found = sequences_.find(request);
    return found == sequences_.end() ? nullptr : found->second;
  }
  /// Removes the sequence of a request whose start was refused or did not reach the loop.
  void drop(std::uint32_t request) {
    const std::scoped_lock lock(mutex_);
    sequences_.erase(request);
  }
  /// Notes that a reader has taken the event with the start of `request`. The loop has accepted this start,
  /// so it never runs the sequences of the requests with smaller numbers. Removes such a sequence if the
  /// other reader has also taken the start of a later sequence.
  void start_taken(Reader reader, std::uint32_t request) {
    const std::scoped_lock lock(mutex_);
    (reader == Reader::service ? service_at_ : recorder_at_) = request;
    sequences_.erase(sequences_.begin(), sequences_.lower_bound(std::min(service_at_, recorder_at_)));
    const auto ended = std::distance(sequences_.begin(), sequences_.lower_bound(service_at_));
    constexpr auto most = static_cast<std::ptrdiff_t>(most_ended);
    if (ended > most) sequences_.erase(sequences_.begin(), std::next(sequences_.begin(), ended - most));
  }

 private:
  mutable std::mutex mutex_;
  std::uint32_t service_at_ = 0;   // newest start that the service has taken
  std::uint32_t recorder_at_ = 0;  // newest start that the recorder has taken
  std::map<std::uint32_t, std::shared_ptr<const LoadedSequence>> sequences_;
};

}  // namespace softgrip::daemon
