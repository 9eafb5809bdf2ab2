#pragma once
// One Modbus module on a link: what an exchange asks it, and what its answers mean.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "drivers/board/judged_input.h"
#include "drivers/board/read_back_history.h"
#include "drivers/modbus/exchange_plan.h"
#include "drivers/modbus/modbus_link.h"

namespace softgrip::drivers {

struct ModbusModuleSettings {
  std::string name;  ///< in messages, when a board has several; else the map's
  BoardMap map;
  std::uint8_t unit = 1;  ///< unit id; replies with another one are refused
  std::size_t link = 0;   ///< which of the board's links leads to it
};

/// Holds what one exchange wrote and read. Nothing but the constructor and the texts allocates.
class ModbusModule {
 public:
  /// `link` outlives the module; `index` is what the wiring calls it.
  ModbusModule(ModbusModuleSettings settings, std::size_t index, const std::vector<ChannelWiring>& wiring,
               ModbusLink& link);

  [[nodiscard]] const ModbusModuleSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const ExchangePlan& plan() const noexcept { return plan_; }
  [[nodiscard]] bool drives_outputs() const noexcept { return !plan_.writes.empty(); }
  /// Number of clients in the last read; 0: the module does not count them.
  [[nodiscard]] unsigned clients() const noexcept;

  /// After the link was opened: the map's setup, unless a tripped watchdog comes first.
  [[nodiscard]] BusStatus set_up(Nanoseconds deadline) noexcept;
  /// One question that changes nothing, to measure the link; `ok` at once if the plan has none.
  [[nodiscard]] BusStatus probe(Nanoseconds deadline) noexcept;

  /// Fails with `write_refused` where a command is beyond the range of its output; its end is encoded.
  [[nodiscard]] BusStatus encode(std::span<const double> commands_kpa) noexcept;
  /// The outputs; once per session what clears a tripped watchdog; what feeds it.
  [[nodiscard]] BusStatus write(Nanoseconds deadline) noexcept;
  /// Now and then an exchange begins with the reading, so that what somebody else has written since the last
  /// one is seen before it is overwritten: begin_exchange() decides that for the exchange that it begins.
  /// Only after one whose read-back was as written: an output that did not follow differs by itself.
  void begin_exchange() noexcept;
  [[nodiscard]] bool reads_first() const noexcept { return reads_first_; }

  /// What write() has not read yet.
  [[nodiscard]] BusStatus read(Nanoseconds deadline) noexcept;
  /// What the board says of its outputs; `overwritten` is said only where the reading was first.
  /// With `write_refused`, found_kpa() returns what the outputs were instead.
  [[nodiscard]] BusStatus check() noexcept;
  /// NaN where the channel is not wired to the module, or where the last check() found what was written.
  [[nodiscard]] double found_kpa(std::size_t channel) const noexcept { return found_kpa_[channel]; }
  void forget_found() noexcept;
  /// Puts what the module knows of a channel into its reading.
  void fill(std::size_t channel, Reading& reading) const noexcept;

  /// What went wrong last.
  [[nodiscard]] const char* detail() const noexcept { return detail_; }
  /// All questions of one exchange, in their order.
  [[nodiscard]] std::vector<TransactionSize> transactions() const;

 private:
  BusStatus ask(const ModbusRequest& request, Nanoseconds deadline) noexcept;
  BusStatus write_fixed(std::span<const FixedWrite> writes, Nanoseconds deadline) noexcept;
  BusStatus write_outputs(Nanoseconds deadline) noexcept;
  BusStatus feed(FixedWrite write, Nanoseconds deadline) noexcept;
  BusStatus read_step(std::size_t step, Nanoseconds deadline) noexcept;
  void take_reply(std::size_t step) noexcept;
  BusStatus first_write(Nanoseconds deadline) noexcept;
  BusStatus name_refusal(BusStatus status, Nanoseconds deadline) noexcept;
  [[nodiscard]] ModbusRequest request_of(const ReadStep& step) const noexcept;
  [[nodiscard]] ModbusRequest request_of(std::size_t write, bool combined) const noexcept;
  [[nodiscard]] bool combines() const noexcept { return plan_.combined_read.has_value() && !reads_first_; }
  [[nodiscard]] bool is_tripped() const noexcept;
  [[nodiscard]] double raw_at(const Slot& slot, RegisterKind kind) const noexcept;
  [[nodiscard]] double read_back_kpa(std::size_t channel) const noexcept;
  [[nodiscard]] JudgedInput input(const InputWiring& wiring, const Slot& slot,
                                  const std::optional<Slot>& status) const noexcept;
  BusStatus fail(BusStatus status, const char* format, std::size_t channel, double value) noexcept;
  BusStatus say(BusStatus status, const char* text) noexcept;

  ModbusModuleSettings settings_;
  const std::vector<ChannelWiring>& wiring_;
  ExchangePlan plan_;
  ModbusLink& link_;
  std::vector<std::uint16_t> output_words_;
  std::vector<double> requested_raws_;  ///< what each output was told, after rounding and clamping
  ReadBackHistory accepted_;
  std::vector<double> found_kpa_;
  std::vector<std::vector<std::uint16_t>> replies_;  ///< one per read of the plan; bits as 0 or 1
  Nanoseconds sampled_at_ = 0;
  std::uint32_t unlooked_ = 0;  ///< exchanges since one began with the reading
  bool confirmed_ = false;      ///< the last exchange read back what it had written
  bool reads_first_ = false;
  bool alternate_due_ = false;  ///< the last write of the heartbeat had its first value
  bool clear_due_ = false;      ///< a session is new: a tripped watchdog may be cleared
  bool setup_due_ = false;      ///< it was tripped when the session was opened
  std::array<char, 200> own_detail_{};
  const char* detail_ = "";
};

}  // namespace softgrip::drivers
