#pragma once
// Stores sequences that were passed to the loop until no thread uses them.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "control/tick/sequence.h"

namespace softgrip::daemon {

/// A sequence as read and as fitted to the rig.
struct LoadedSequence {
  control::Sequence written;
  control::PreparedSequence prepared;
  std::string sha256;          ///< of the text
  document::Problems remarks;  ///< warnings only: what it will not do as written
};

/// By the request that starts them. The loop holds a bare pointer into an entry; the entry stays until its
/// request was refused or its run has ended and been recorded.
class SequenceStore {
 public:
  void put(std::uint32_t request, std::shared_ptr<const LoadedSequence> sequence);
  /// nullptr if there is none.
  [[nodiscard]] std::shared_ptr<const LoadedSequence> find(std::uint32_t request) const;
  /// Its start was refused, or never reached the loop.
  void drop(std::uint32_t request);
  /// Drops those of requests before `request`: a later start was accepted, so nothing runs from them.
  void drop_before(std::uint32_t request);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<const LoadedSequence>> sequences_;
};

}  // namespace softgrip::daemon
