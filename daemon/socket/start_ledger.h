#pragma once
// Stores recent starts, so that a stop can refer to one of them.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace softgrip::daemon {

/// A start that was passed to the loop.
struct KnownStart {
  std::uint32_t request = 0;
  std::string id;            ///< id given by the client; empty if it gave none
  std::uint64_t client = 0;  ///< the client that requested it
};

/// Stores the newest `most` starts and the running one.
class StartLedger {
 public:
  static constexpr std::size_t most = 256;

  /// `running`: the request of the running or last sequence, or 0.
  void add(KnownStart start, std::uint32_t running);
  /// Stores the id of a start that must not run, because a stop for it arrived first. Keeps the newest `most`
  /// ids.
  void forbid(std::string start_id);

  [[nodiscard]] bool has(std::uint32_t request) const;
  /// Returns the client of a request; 0 if it is unknown.
  [[nodiscard]] std::uint64_t client_of(std::uint32_t request) const;
  [[nodiscard]] std::optional<std::uint32_t> request_of(std::string_view start_id) const;
  [[nodiscard]] bool is_forbidden(std::string_view start_id) const;

 private:
  std::deque<KnownStart> starts_;  ///< oldest first
  std::deque<std::string> forbidden_;
};

}  // namespace softgrip::daemon
