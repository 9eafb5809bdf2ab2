#pragma once
// Plans the transactions of one exchange, and the position of each channel's numbers in the replies. The plan
// is computed once from board map and wiring. Each exchange executes the transactions of this plan.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers {

/// One read of registers (function codes 3, 4) or bits (1, 2).
struct ReadStep {
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;

  bool operator==(const ReadStep&) const = default;
};

/// One write of consecutive outputs. `first_word` is the index of the first register of this write among all
/// registers that the exchange writes.
struct WriteStep {
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;  ///< number of registers that the write contains
  std::size_t first_word = 0;

  bool operator==(const WriteStep&) const = default;
};

/// The position of a number in the replies of an exchange. The position consists of the index of the read,
/// and the index of the register or bit in the reply to this read.
struct Slot {
  std::size_t step = 0;
  std::size_t offset = 0;

  bool operator==(const Slot&) const = default;
};

/// The positions of one channel's numbers in the requests and replies. A member is empty if its terminal is
/// not on this module.
struct ChannelSlots {
  std::optional<std::size_t> output_word;  ///< index of the channel's first register among all registers that
                                           ///< the exchange writes
  std::optional<Slot> displacement;
  std::optional<Slot> displacement_status;
  std::optional<Slot> pressure;
  std::optional<Slot> pressure_status;
  std::optional<Slot> temperature;
  std::optional<Slot> temperature_status;
  std::optional<Slot> read_back;
};

struct ExchangePlan {
  std::size_t output_words = 0;  ///< number of registers that one exchange writes
  std::vector<WriteStep> writes;
  std::vector<ReadStep> reads;
  std::vector<ChannelSlots> channels;
  std::optional<Slot> tripped;  ///< position of the first register or bit that reports a tripped watchdog
  std::optional<Slot> clients;
  /// Index of the read that is combined with the first write in one transaction of function code 23.
  std::optional<std::size_t> combined_read;
  /// Index of the read that contains the first wired input; 0 if no input is wired. The time of this read is
  /// `sampled_at` of the readings.
  std::size_t sampling_read = 0;

  /// Returns the number of round trips of one exchange, without the write that feeds the watchdog.
  [[nodiscard]] std::size_t transactions() const noexcept {
    return writes.size() + reads.size() - (combined_read.has_value() ? 1 : 0);
  }
};

/// Returns the plan with the smallest number of transactions that the map allows for the channels of
/// `module`. Only wired outputs are written. Two wired outputs that are not adjacent need two writes, because
/// a terminal between them may drive an unknown device. The caller must have checked the wiring with
/// wiring_problems().
[[nodiscard]] ExchangePlan plan_exchange(const BoardMap& map, const std::vector<ChannelWiring>& wiring,
                                         std::size_t module = 0);

/// Describes the plan with the addresses in the requests, for example "FC16 writes 2 from 10, FC3 reads 4
/// from 0".
[[nodiscard]] std::string describe(const ExchangePlan& plan);

}  // namespace softgrip::drivers
