#include "daemon/recording/sequence_store.h"

#include <utility>

namespace softgrip::daemon {

void SequenceStore::put(std::uint32_t request, std::shared_ptr<const LoadedSequence> sequence) {
  const std::scoped_lock lock(mutex_);
  sequences_.insert_or_assign(request, std::move(sequence));
}

std::shared_ptr<const LoadedSequence> SequenceStore::find(std::uint32_t request) const {
  const std::scoped_lock lock(mutex_);
  const auto found = sequences_.find(request);
  return found == sequences_.end() ? nullptr : found->second;
}

void SequenceStore::drop(std::uint32_t request) {
  const std::scoped_lock lock(mutex_);
  sequences_.erase(request);
}

void SequenceStore::drop_before(std::uint32_t request) {
  const std::scoped_lock lock(mutex_);
  sequences_.erase(sequences_.begin(), sequences_.lower_bound(request));
}

}  // namespace softgrip::daemon
