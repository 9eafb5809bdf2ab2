#pragma once
// Stores the newest starts, so that a request to stop can name one of them.

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
  std::string id;            ///< id that the client gave the start; empty if the client gave no id
  std::uint64_t client = 0;  ///< connection of the client that requested the start
};

/// Stores the newest `capacity` starts, and in addition the start of the running sequence.
class StartLedger {
 public:
  static constexpr std::size_t capacity = 256;

  /// Adds a start. `running` is the id of the request whose sequence runs or ran last; 0 if there was none.
  void add(KnownStart start, std::uint32_t running);
  /// Stores the id of a start that must not run, because a stop with this id arrived before the start. Keeps
  /// the newest `capacity` ids.
  void forbid(std::string start_id);

  [[nodiscard]] bool has(std::uint32_t request) const;
  /// Returns the client that made the request; 0 if the request is not stored.
  [[nodiscard]] std::uint64_t client_of(std::uint32_t request) const;
  [[nodiscard]] std::optional<std::uint32_t> request_of(std::string_view start_id) const;
  [[nodiscard]] bool is_forbidden(std::string_view start_id) const;

 private:
  std::deque<KnownStart> starts_;  ///< stored starts, the oldest first
  std::deque<std::string> forbidden_;
};

}  // namespace softgrip::daemon
