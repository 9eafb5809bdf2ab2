#pragma once
// Simulates a Modbus client (master) that follows docs/reference/plc-map.md. Defines the blocks of registers
// that the master sends to softgrip-plc.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "base/time.h"
#include "drivers/modbus_server/requests.h"
#include "tools/plc/client_connections.h"
#include "tools/plc/codes.h"

namespace softgrip::world {

/// A block of registers that a master has written.
struct Block {
  std::array<std::uint16_t, 7> words{};
  bool only_reads = false;
  int command = -1;         ///< index of the command in the list of all commands of the world; -1: no command
  std::uint64_t halts = 0;  ///< number of stops and vents that were executed before the block was written

  [[nodiscard]] modbus::Bytes bytes() const;
};

/// The result of a command. A master reads the result after the response to its block.
struct End {
  std::uint16_t done = 0;
  plc::Outcome outcome = plc::Outcome::none;
  plc::Reason reason = plc::Reason::none;
};

/// A connection of a master. The master sends a request after it has received the response to its previous
/// request.
struct Wire {
  std::size_t master = 0;
  plc::ClientConnections::Id id = 0;
  modbus::RequestStream stream;
  std::optional<Block> flying;
  Nanoseconds arrives = 0;
  std::size_t arrived_bytes = 0;  ///< number of bytes of the pending block that the gateway has received
  bool left = false;              ///< true: the master has opened a newer connection
  std::optional<End> reply;
  std::optional<std::uint16_t> heartbeat;  ///< last heartbeat that the gateway has received on this
                                           ///< connection
};

class MasterInWorld {
 public:
  enum class Progress : std::uint8_t { begins, synchronises, ready, waits };

  /// Queues a command. The master sends the command when the handshake permits it.
  void want(std::uint16_t code);
  /// Evaluates the last response and continues the handshake. If the master has read that a command was
  /// refused, returns the index of the command; otherwise returns -1.
  struct Read {
    int refused = -1;
    bool accepted = false;
  };
  Read read(const End& end, const Block& of, Nanoseconds now);
  /// Begins the next queued command and gives it the index `number`. Returns false if no command can begin.
  bool next(int number, Nanoseconds now);
  /// Returns the block of registers that the master would write at this moment.
  [[nodiscard]] Block block(std::uint64_t halts);

  bool alive = true;        ///< false: the program of the master has stopped, but the last block is sent
                            ///< repeatedly
  bool beats = true;        ///< true: the master changes its heartbeat
  std::uint16_t heard = 0;  ///< last heartbeat of this master that the gateway has received
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
