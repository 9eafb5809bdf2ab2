#pragma once
// A master that keeps to docs/reference/plc-map.md, and what it has on its way to softgrip-plc.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "base/time.h"
#include "drivers/modbus_server/requests.h"
#include "tools/plc/codes.h"
#include "tools/plc/masters.h"

namespace softgrip::world {

/// A block that a master has written.
struct Block {
  std::array<std::uint16_t, 7> words{};
  bool only_reads = false;
  int command = -1;         ///< its number among all that were asked; -1: none
  std::uint64_t halts = 0;  ///< how many stops and vents had been executed when it was written

  [[nodiscard]] modbus::Bytes bytes() const;
};

/// The end of a command, as a master reads it after its block was answered.
struct End {
  std::uint16_t done = 0;
  plc::Outcome outcome = plc::Outcome::none;
  plc::Reason reason = plc::Reason::none;
};

/// A connection. A master sends its next request when the last one is answered.
struct Wire {
  std::size_t master = 0;
  plc::Masters::Id id = 0;
  modbus::RequestStream stream;
  std::optional<Block> flying;
  Nanoseconds arrives = 0;
  std::size_t arrived_bytes = 0;  ///< of the block that is on its way
  bool left = false;              ///< its master has another one
  std::optional<End> reply;
  std::optional<std::uint16_t> heartbeat;  ///< the last that arrived here
};

class MasterInWorld {
 public:
  enum class Progress : std::uint8_t { begins, synchronises, ready, waits };

  /// Queues a command. The master sends it when the handshake allows.
  void want(std::uint16_t code);
  /// Reads the last answer and continues with the handshake. Returns the number of the command that it has
  /// read as refused, or -1.
  struct Read {
    int refused = -1;
    bool accepted = false;
  };
  Read read(const End& end, const Block& of, Nanoseconds now);
  /// The next command, if there is one: `number` is what it is called from now on.
  bool next(int number, Nanoseconds now);
  /// Its block as it is now.
  [[nodiscard]] Block block(std::uint64_t halts);

  bool alive = true;        ///< else its program has stopped, and its last block is written on
  bool beats = true;        ///< its heartbeat changes
  std::uint16_t heard = 0;  ///< its heartbeat that has arrived last
  [[nodiscard]] std::uint16_t counter() const noexcept { return counter_; }
  [[nodiscard]] std::uint16_t code() const noexcept { return code_; }

 private:
  Progress progress_ = Progress::begins;
  std::uint16_t counter_ = 0;
  std::uint16_t code_ = 0;
  int command_ = -1;
  std::uint16_t heartbeat_ = 0;
  Nanoseconds asked_at_ = 0;
  std::deque<std::uint16_t> wanted_;
};

}  // namespace softgrip::world
