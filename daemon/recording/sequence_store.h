#pragma once
// Stores the sequences of the loop as long as a thread uses them.

#include <cstdint>
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
/// entry. An entry remains until its request is refused, or until its sequence has ended and has been
/// recorded.
class SequenceStore {
 public:
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
  /// Removes the sequences of all requests with a number below `request`. The loop has accepted the start of
  /// `request`, so it never runs these sequences.
  void drop_before(std::uint32_t request) {
    const std::scoped_lock lock(mutex_);
    sequences_.erase(sequences_.begin(), sequences_.lower_bound(request));
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<const LoadedSequence>> sequences_;
};

}  // namespace softgrip::daemon
