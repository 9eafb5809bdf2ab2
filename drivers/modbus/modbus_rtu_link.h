#pragma once
// A serial line with Modbus RTU modules on it, one question at a time.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/board/round_trip.h"
#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/rtu_frame.h"

namespace softgrip::drivers {

/// RTU has no transaction id: an answer belongs to the question before it, and nothing in it proves that. So
/// a question is only sent into a line that was silent for as long as the specification asks; bytes that come
/// while nothing was asked end the link; and after anything went wrong, open() listens for as long as an
/// answer that was under way could still take.
///
/// open() opens the device by its name, so that an adapter that was pulled out and put back is found again.
class ModbusRtuLink final : public ModbusLink {
 public:
  explicit ModbusRtuLink(SerialLine line);
  ~ModbusRtuLink() override;

  [[nodiscard]] BusStatus open(Nanoseconds deadline) noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override { return port_ >= 0; }
  [[nodiscard]] BusStatus ask(std::uint8_t unit, const ModbusRequest& request,
                              Nanoseconds deadline) noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> data() const noexcept override { return data_; }
  [[nodiscard]] const char* detail() const noexcept override { return detail_.data(); }
  void forget_measurements() noexcept override { answers_.reset(); }
  void keep_measurement() noexcept override;
  [[nodiscard]] Board::Budget cost(std::span<const TransactionSize> transactions,
                                   const std::string& plan) const override;
  [[nodiscard]] std::string describe() const override;

 private:
  BusStatus wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept;
  BusStatus listen(Nanoseconds deadline) noexcept;
  BusStatus wait_for_silence(Nanoseconds deadline) noexcept;
  BusStatus send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;
  BusStatus receive(std::uint8_t unit, const ModbusRequest& request, std::span<const std::uint8_t> asked,
                    Nanoseconds deadline) noexcept;
  BusStatus judge(std::size_t have, std::uint8_t unit, const ModbusRequest& request,
                  std::span<const std::uint8_t> asked, bool& over) noexcept;
  BusStatus fail(BusStatus status, const char* what, const char* why) noexcept;
  [[nodiscard]] Nanoseconds wire_time(TransactionSize size) const noexcept;

  SerialLine line_;
  Nanoseconds character_;
  Nanoseconds silence_;
  int port_ = -1;
  Nanoseconds silent_since_ = 0;
  bool answer_may_come_ = false;  ///< the last session ended while one was due
  RtuFrame outgoing_{};
  // Larger than an echo and any reply, so that bytes behind one are seen at once.
  std::array<std::uint8_t, 768> incoming_{};
  std::span<const std::uint8_t> data_ = {};
  RoundTrip answers_;  ///< what modules and adapter needed beside bytes and silence
  TransactionSize last_size_;
  Nanoseconds last_round_trip_ = 0;
  std::array<char, 200> detail_{};
};

}  // namespace softgrip::drivers
