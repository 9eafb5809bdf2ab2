#pragma once
// Which transactions one exchange takes, and where in their replies each channel's numbers stand. Worked out
// once, from board map and wiring, so that the exchange itself only walks a list.

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

/// One write of consecutive outputs; `first_word` counts in ExchangePlan::output_words.
struct WriteStep {
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;  ///< registers
  std::size_t first_word = 0;

  bool operator==(const WriteStep&) const = default;
};

/// Where a number stands in the replies: in which read, from which register (or bit) of it.
struct Slot {
  std::size_t step = 0;
  std::size_t offset = 0;

  bool operator==(const Slot&) const = default;
};

/// Of one channel, as far as it is wired to the module.
struct ChannelSlots {
  std::optional<std::size_t> output_word;  ///< where the channel's output is encoded
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
  std::optional<Slot> tripped;  ///< the first, if the watchdog has several
  std::optional<Slot> clients;
  /// The read with which the first write is done in one transaction by function code 23.
  std::optional<std::size_t> combined_read;
  /// The read that carries the inputs: its moment is the readings' `sampled_at`. Without wired inputs the
  /// first read, if there is one.
  std::size_t sampling_read = 0;

  /// Round trips of one exchange, the watchdog's feeding write not counted.
  [[nodiscard]] std::size_t transactions() const noexcept {
    return writes.size() + reads.size() - (combined_read.has_value() ? 1 : 0);
  }
};

/// The plan with the fewest transactions that the map allows, for what is wired to `module`. Only wired
/// outputs are ever written: between two wired ones that are not neighbours a write ends and another begins,
/// since nobody knows what the terminal in between drives. Needs wiring_problems() to be empty.
[[nodiscard]] ExchangePlan plan_exchange(const BoardMap& map, const std::vector<ChannelWiring>& wiring,
                                         std::size_t module = 0);

/// "FC16 writes 2 from 10, FC3 reads 4 from 0": the plan in the addresses of the wire.
[[nodiscard]] std::string describe(const ExchangePlan& plan);

}  // namespace softgrip::drivers
