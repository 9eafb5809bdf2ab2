#pragma once
// Plans the transactions of one exchange, and the places of each channel's numbers in the replies. The plan
// is made once from board map and wiring. An exchange then only executes the transactions of the plan.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers {

/// One read: registers (functions 3, 4) or bits (1, 2).
struct ReadStep {
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;

  bool operator==(const ReadStep&) const = default;
};

/// One write of consecutive outputs. `first_word` is the index of its first register among all registers that
/// the exchange writes.
struct WriteStep {
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;  ///< registers
  std::size_t first_word = 0;

  bool operator==(const WriteStep&) const = default;
};

/// The place of a number in the replies: index of the read, and of the register (or bit) in its reply.
struct Slot {
  std::size_t step = 0;
  std::size_t offset = 0;

  bool operator==(const Slot&) const = default;
};

/// The places of one channel's numbers. Members are empty for parts of the channel that are not wired to the
/// module.
struct ChannelSlots {
  std::optional<std::size_t> output_word;  ///< index of the channel's first register, as in first_word
  std::optional<Slot> displacement;
  std::optional<Slot> displacement_status;
  std::optional<Slot> pressure;
  std::optional<Slot> pressure_status;
  std::optional<Slot> temperature;
  std::optional<Slot> temperature_status;
  std::optional<Slot> read_back;
};

struct ExchangePlan {
  std::size_t output_words = 0;  ///< registers written in one exchange
  std::vector<WriteStep> writes;
  std::vector<ReadStep> reads;
  std::vector<ChannelSlots> channels;
  std::optional<Slot> tripped;  ///< place of the first register or bit that reports a tripped watchdog
  std::optional<Slot> clients;
  /// Index of the read that function code 23 combines with the first write in one transaction.
  std::optional<std::size_t> combined_read;
  /// Index of the read that contains the first wired input. The time of this read is the readings'
  /// `sampled_at`. Without wired inputs the index is 0.
  std::size_t sampling_read = 0;

  /// Returns the number of round trips of one exchange, without the write that feeds the watchdog.
  [[nodiscard]] std::size_t transactions() const noexcept {
    return writes.size() + reads.size() - (combined_read.has_value() ? 1 : 0);
  }
};

/// Returns the plan with the fewest transactions that the map allows for the channels of `module`. Only wired
/// outputs are written. Two wired outputs that are not adjacent therefore need two writes, because the
/// terminal between them may drive an unknown device. Requires wiring_problems() to be empty.
[[nodiscard]] ExchangePlan plan_exchange(const BoardMap& map, const std::vector<ChannelWiring>& wiring,
                                         std::size_t module = 0);

/// Describes the plan with the addresses on the wire: "FC16 writes 2 from 10, FC3 reads 4 from 0".
[[nodiscard]] std::string describe(const ExchangePlan& plan);

}  // namespace softgrip::drivers
