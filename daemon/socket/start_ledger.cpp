#include "daemon/socket/start_ledger.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace softgrip::daemon {

void StartLedger::add(KnownStart start, std::uint32_t running) {
  starts_.push_back(std::move(start));
  if (starts_.size() <= capacity) return;
  const bool oldest_runs = starts_.front().request == running;
  starts_.erase(oldest_runs ? std::next(starts_.begin()) : starts_.begin());
}

void StartLedger::forbid(std::string start_id) {
  if (is_forbidden(start_id)) return;
  forbidden_.push_back(std::move(start_id));
  if (forbidden_.size() > capacity) forbidden_.pop_front();
}

bool StartLedger::has(std::uint32_t request) const {
  return std::ranges::find(starts_, request, &KnownStart::request) != starts_.end();
}

std::uint64_t StartLedger::client_of(std::uint32_t request) const {
  const auto found = std::ranges::find(starts_, request, &KnownStart::request);
  return found == starts_.end() ? 0 : found->client;
}

std::optional<std::uint32_t> StartLedger::request_of(std::string_view start_id) const {
  const auto found = std::ranges::find(starts_, start_id, &KnownStart::id);
  if (start_id.empty() || found == starts_.end()) return std::nullopt;
  return found->request;
}

bool StartLedger::is_forbidden(std::string_view start_id) const {
  return std::ranges::find(forbidden_, start_id) != forbidden_.end();
}

}  // namespace softgrip::daemon
