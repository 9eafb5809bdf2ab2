#pragma once
// A Modbus master that follows docs/reference/plc-map.md, and the register blocks that it sends to
// softgrip-plc.

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
  int command = -1;         ///< index of the command in the order of all commands; -1: no command
  std::uint64_t halts = 0;  ///< stops and vents that had been executed when the block was written

  [[nodiscard]] modbus::Bytes bytes() const;
};

/// The result of a command, which a master reads after the answer to its block.
struct End {
  std::uint16_t done = 0;
  plc::Outcome outcome = plc::Outcome::none;
  plc::Reason reason = plc::Reason::none;
};

/// A connection. A master sends its next request after the response to the last one.
struct Wire {
  std::size_t master = 0;
  plc::Masters::Id id = 0;
  modbus::RequestStream stream;
  std::optional<Block> flying;
  Nanoseconds arrives = 0;
  std::size_t arrived_bytes = 0;  ///< number of bytes of the pending block that have arrived
  bool left = false;              ///< the master has opened another connection
  std::optional<End> reply;
  std::optional<std::uint16_t> heartbeat;  ///< the last heartbeat that arrived on this connection
};

class MasterInWorld {
 public:
  enum class Progress : std::uint8_t { begins, synchronises, ready, waits };

  /// Queues a command. The master sends it when the handshake allows.
  void want(std::uint16_t code);
  /// Reads the last answer and continues the handshake. Returns the number of the command that was read as
  /// refused, or -1.
  struct Read {
    int refused = -1;
    bool accepted = false;
  };
  Read read(const End& end, const Block& of, Nanoseconds now);
  /// Begins the next queued command and assigns the index `number` to it. Returns false if no command begins.
  bool next(int number, Nanoseconds now);
  /// Returns the present block of the master.
  [[nodiscard]] Block block(std::uint64_t halts);

  bool alive = true;        ///< false: the program has stopped, and its last block is repeated
  bool beats = true;        ///< true: the heartbeat of the master changes
  std::uint16_t heard = 0;  ///< the heartbeat of this master that arrived last
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
