#pragma once
// The starts of late, so that a stop can name one of them.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace softgrip::daemon {

/// A start that was handed to the loop.
struct KnownStart {
  std::uint32_t request = 0;
  std::string id;            ///< that the client gave it; empty: none
  std::uint64_t client = 0;  ///< that made it
};

/// Keeps the newest `most` starts and the one that runs.
class StartLedger {
 public:
  static constexpr std::size_t most = 256;

  /// `running`: the request whose sequence runs or ran last, or 0.
  void add(KnownStart start, std::uint32_t running);
  /// A stop has named a start that has not come: it must not run when it comes. Keeps the newest `most`.
  void forbid(std::string start_id);

  [[nodiscard]] bool has(std::uint32_t request) const;
  /// 0 if it is not known.
  [[nodiscard]] std::uint64_t client_of(std::uint32_t request) const;
  [[nodiscard]] std::optional<std::uint32_t> request_of(std::string_view start_id) const;
  [[nodiscard]] bool is_forbidden(std::string_view start_id) const;

 private:
  std::deque<KnownStart> starts_;  ///< the oldest first
  std::deque<std::string> forbidden_;
};

}  // namespace softgrip::daemon
