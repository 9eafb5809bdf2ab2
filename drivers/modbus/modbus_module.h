#pragma once
// Exchanges commands and readings with one Modbus module: sends the requests of an exchange over a link and
// evaluates the responses.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "drivers/board/read_back_history.h"
#include "drivers/board/registers.h"
#include "drivers/modbus/exchange_plan.h"
#include "drivers/modbus/modbus_link.h"

namespace softgrip::drivers {

struct ModbusModuleSettings {
  std::string name;  ///< name of the module in messages, if the board has several modules
  BoardMap map;
  std::uint8_t unit = 1;  ///< unit id of the module; a response with another unit id is refused
  std::size_t link = 0;   ///< index of the link to the module
};

/// One Modbus module of a board, with the values that the last exchange wrote and read. Only the constructor
/// and transactions() allocate memory.
class ModbusModule {
 public:
  /// Creates the object for the module `index` of the wiring. `link` must exist longer than this object.
  ModbusModule(ModbusModuleSettings settings, std::size_t index, const std::vector<ChannelWiring>& wiring,
               ModbusLink& link);

  [[nodiscard]] const ModbusModuleSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const ExchangePlan& plan() const noexcept { return plan_; }
  [[nodiscard]] bool drives_outputs() const noexcept { return !plan_.writes.empty(); }
  /// Returns the number of clients that the module reported in the last read; 0 if the module does not count
  /// clients.
  [[nodiscard]] unsigned clients() const noexcept;

  /// Prepares the module for a new session after the link was opened: writes the setup of the board map. If
  /// the watchdog has tripped, the setup is written only after the watchdog has been cleared.
  [[nodiscard]] BusStatus set_up(Nanoseconds deadline) noexcept;
  /// Sends one read of the plan, to measure the duration of a round trip. If the plan has no read, returns
  /// `ok` at once.
  [[nodiscard]] BusStatus probe(Nanoseconds deadline) noexcept;
  /// Leaves the module out of the session after set_up() or probe() has failed: until the next set_up(),
  /// probe() does nothing, and read() returns `disconnected`. detail() keeps the reason of the failure.
  void leave_out() noexcept;

  /// Encodes the commands for write(). A command outside the range of its output is limited to this range,
  /// and the function returns `write_refused`.
  [[nodiscard]] BusStatus encode(std::span<const double> commands_kpa) noexcept;
  /// Writes the outputs and feeds the watchdog. The first call in a session also clears a tripped watchdog.
  [[nodiscard]] BusStatus write(Nanoseconds deadline) noexcept;
  /// Decides if this exchange reads the outputs before it writes them; reads_first() returns the decision.
  /// Every 8th exchange reads first. Such an exchange detects values that another client has written since
  /// the last exchange, before it overwrites these values. The exchange reads first only if the last exchange
  /// read back the values that it had written. Otherwise, an output that had refused its value would look
  /// like a write of another client.
  void begin_exchange() noexcept;
  [[nodiscard]] bool reads_first() const noexcept { return reads_first_; }

  /// Performs the reads of the plan, without those that write() has already performed.
  [[nodiscard]] BusStatus read(Nanoseconds deadline) noexcept;
  /// Compares the outputs that the board reports with the written values. If an output differs, the result is
  /// `overwritten` in an exchange that reads first, and `write_refused` in any other exchange. After
  /// `write_refused`, found_kpa() returns the reported outputs.
  [[nodiscard]] BusStatus check() noexcept;
  /// Returns the output of a channel that the board reported [kPa]. Returns NaN if the channel has no output
  /// on this module, or if the output has the written value.
  [[nodiscard]] double found_kpa(std::size_t channel) const noexcept { return found_kpa_[channel]; }
  void forget_found() noexcept;
  /// Copies the values of a channel that the module has read into the reading of this channel.
  void fill(std::size_t channel, Reading& reading) const noexcept;

  /// Returns a text that gives the reason of the last failure.
  [[nodiscard]] const char* detail() const noexcept { return detail_; }
  /// Returns all requests of one exchange in the order in which they are sent.
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
  std::vector<double> requested_raws_;  ///< for each channel, the raw number of its output that encode()
                                        ///< computed, after limiting and rounding
  ReadBackHistory accepted_;
  std::vector<double> found_kpa_;
  std::vector<std::vector<std::uint16_t>> replies_;  ///< one reply per read of the plan; a bit is stored as 0
                                                     ///< or 1
  Nanoseconds sampled_at_ = 0;
  /// Number of exchanges since the last exchange that read the outputs before it wrote the outputs.
  std::uint32_t unlooked_ = 0;
  bool confirmed_ = false;  ///< true: in the last exchange, the read-back confirmed the written values
  bool reads_first_ = false;
  bool left_out_ = false;       ///< true: see leave_out()
  bool alternate_due_ = false;  ///< true: the next write of the heartbeat has the alternate value
  bool clear_due_ = false;      ///< true: the session is new, so a tripped watchdog may be cleared
  bool setup_due_ = false;      ///< true: the setup must still be written, because the watchdog had tripped
                                ///< when the session was opened
  std::array<char, 200> own_detail_{};
  const char* detail_ = "";
};

}  // namespace softgrip::drivers
