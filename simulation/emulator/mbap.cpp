#include "simulation/emulator/mbap.h"

namespace softgrip::simulation {
namespace {

// What a client may send before its first complete frame is cut off. Requests are cut as they arrive, so
// more than two frames never wait.
constexpr std::size_t max_pending = 16 * (mbap_header_size + max_pdu_size);

}  // namespace

void RequestStream::append(std::span<const std::uint8_t> bytes) {
  if (broken_) return;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  if (pending_.size() > max_pending) broken_ = true;
}

std::optional<Request> RequestStream::next() {
  if (broken_ || pending_.size() < mbap_header_size) return std::nullopt;
  const std::uint16_t protocol = word_at(pending_, 2);
  const std::size_t length = word_at(pending_, 4);  // of the unit id and the PDU
  if (protocol != 0 || length < 2 || length > max_pdu_size + 1) {
    broken_ = true;
    return std::nullopt;
  }
  const std::size_t whole = mbap_header_size - 1 + length;
  if (pending_.size() < whole) return std::nullopt;

  const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(whole);
  Request request{word_at(pending_, 0), pending_[6],
                  Bytes(pending_.begin() + static_cast<std::ptrdiff_t>(mbap_header_size), end)};
  pending_.erase(pending_.begin(), end);
  return request;
}

Bytes frame(std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  Bytes bytes;
  bytes.reserve(mbap_header_size + pdu.size());
  append_word(bytes, transaction);
  append_word(bytes, 0);
  append_word(bytes, static_cast<std::uint16_t>(pdu.size() + 1));
  bytes.push_back(unit);
  bytes.insert(bytes.end(), pdu.begin(), pdu.end());
  return bytes;
}

}  // namespace softgrip::simulation
