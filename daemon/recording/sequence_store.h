#pragma once
// Stores the sequences of the loop until no thread uses them.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "control/tick/sequence.h"

namespace softgrip::daemon {

/// A sequence as read from its file, and as fitted to the rig.
struct LoadedSequence {
  control::Sequence written;
  control::PreparedSequence prepared;
  std::string sha256;          ///< hash of the text of the sequence
  document::Problems remarks;  ///< warnings only: differences between the file and the motion
};

/// Stores sequences by the number of the request that starts them. The loop has a plain pointer to an entry.
/// The entry remains until its request was refused, or until its run has ended and has been recorded.
class SequenceStore {
 public:
  void put(std::uint32_t request, std::shared_ptr<const LoadedSequence> sequence);
  /// Returns the sequence of a request; nullptr if there is none.
  [[nodiscard]] std::shared_ptr<const LoadedSequence> find(std::uint32_t request) const;
  /// Removes a sequence whose start was refused or never reached the loop.
  void drop(std::uint32_t request);
  /// Removes the sequences of requests before `request`: a later start was accepted, so they do not run.
  void drop_before(std::uint32_t request);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<const LoadedSequence>> sequences_;
};

}  // namespace softgrip::daemon
