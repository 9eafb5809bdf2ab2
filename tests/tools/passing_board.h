#pragma once
// A board that forwards every call to another board. A test overrides single calls to change their behaviour.

#include "drivers/board/board.h"

namespace softgrip::tools::testing {

class PassingBoard : public drivers::Board {
 public:
  explicit PassingBoard(drivers::Board& board) : board_(board) {}
  [[nodiscard]] std::size_t channels() const noexcept override { return board_.channels(); }
  [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds deadline) noexcept override {
    return board_.connect(deadline);
  }
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override {
    return board_.exchange(commands_kpa, readings, deadline);
  }
  [[nodiscard]] const char* detail() const noexcept override { return board_.detail(); }
  [[nodiscard]] std::string describe() const override { return board_.describe(); }
  [[nodiscard]] Budget budget() const override { return board_.budget(); }
  [[nodiscard]] bool has_watchdog() const noexcept override { return board_.has_watchdog(); }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
    return board_.watchdog_time();
  }

 private:
  drivers::Board& board_;
};

}  // namespace softgrip::tools::testing
