#pragma once
// Models the dead time between command and pressure. A delay line stores the signal of the last `delay_s`
// seconds.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/block.h"
#include "model/dual.h"

namespace softgrip::model {

/// Delays a signal. The solution is exact for piecewise parabolic signals and any delay. If the delayed
/// signal has a kink within a sample, the sample is divided at the kink, and two segments are passed on. A
/// jump is passed on as a jump, at the start of the first step that ends after the jump. The output is
/// differentiable with respect to the delay.
template <class T>
class TransportDelay {
 public:
  static constexpr BlockInfo info =
      block_info("transport_delay", Station::valve, Kind::pressure, Inverse::preview, "Transport delay",
                 "Dead time between commanded pressure and pressure.", "p(t) = u(t - delay)");
  static constexpr std::array parameters{parameter(
      "delay_s", "s", "dead time", Typical{0.05}, Within{0.0, 1000.0}, Scale{0.05}, Neutral{0.0}, Latency{})};

  TransportDelay(std::span<const T> values, const Preparation& preparation)
      : delay_s_(values[0]), line_(initial_size(value_of(values[0]), preparation.sample_time_s)) {
    reset(T(0.0));
  }

  void reset(const T& input) {
    head_ = 0;
    count_ = 0;
    front_begin_ = input;
    if (!is_zero(delay_s_)) push(Segment<T>::straight(delay_s_, input, input));
  }

  [[nodiscard]] T output() const { return front_begin_; }
  [[nodiscard]] const T& delay_s() const { return delay_s_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (is_zero(delay_s_)) {
      front_begin_ = in.end;
      next(in);
      return;
    }
    push(in);
    T remaining = in.duration_s;
    while (!is_zero(remaining) && count_ > 0) {
      const Piece& front = line_[head_];
      const Segment<T> whole{front.duration_s, front_begin_, front.end, front.mean};
      if (ends_in(whole.duration_s, remaining)) {
        pop();
        remaining -= whole.duration_s;
        next(whole);
      } else if (ends_with(whole.duration_s, remaining)) {
        pop();
        next(Segment<T>{remaining, whole.begin, whole.end, whole.mean});
        return;
      } else {
        const T fraction = remaining / whole.duration_s;
        const Segment<T> first = whole.before(fraction);
        const Segment<T> rest = whole.beyond(fraction);
        line_[head_] = {whole.duration_s - remaining, rest.end, rest.mean};
        front_begin_ = rest.begin;
        next(Segment<T>{remaining, first.begin, first.end, first.mean});
        return;
      }
    }
  }

 private:
  struct Piece {
    T duration_s;
    T end;
    T mean;
  };

  // Returns the initial number of pieces of the delay line: 4 per sample. Each sample needs two pieces (a
  // jump and a ramp). This number is doubled, because samples may be shorter than the nominal sample time. If
  // the result would be above 2^22, the result is 2^22, and step() enlarges the line if necessary.
  static std::size_t initial_size(double delay_s, double sample_time_s) {
    if (sample_time_s <= 0) return 64;
    constexpr double most = 1 << 22;
    const std::size_t needed =
        static_cast<std::size_t>(std::min(most, 16.0 + std::floor(4.0 * delay_s / sample_time_s)));
    std::size_t size = 64;
    while (size < needed) size *= 2;
    return size;
  }

  // Rounding errors must not decide if a kink or a jump lies before or after the end of a sample. Therefore,
  // durations with a relative difference of up to 1e-9 are treated as equal. For number types with
  // derivatives, the tolerance is zero, because a tolerance would remove the derivatives.
  static constexpr double snap = std::is_arithmetic_v<T> ? 1e-9 : 0.0;
  static bool ends_in(const T& piece_s, const T& remaining_s) {
    const double piece = value_of(piece_s);
    const double remaining = value_of(remaining_s);
    return piece < remaining * (1.0 - snap) || (piece == 0.0 && remaining == 0.0);
  }
  static bool ends_with(const T& piece_s, const T& remaining_s) {
    if constexpr (std::is_arithmetic_v<T>) return piece_s <= remaining_s * (1.0 + snap);
    return same(piece_s, remaining_s);
  }

  /// Returns the index in line_ of the i-th oldest piece.
  [[nodiscard]] std::size_t place(std::size_t i) const { return (head_ + i) & (line_.size() - 1); }

  void push(const Segment<T>& s) {
    if (count_ == line_.size()) grow();
    line_[place(count_)] = {s.duration_s, s.end, s.mean};
    ++count_;
  }
  void pop() {
    front_begin_ = line_[head_].end;
    head_ = place(1);
    --count_;
  }
  void grow() {
    std::rotate(line_.begin(), line_.begin() + static_cast<std::ptrdiff_t>(head_), line_.end());
    head_ = 0;
    line_.resize(2 * line_.size());
  }

  T delay_s_;
  T front_begin_{0.0};  // start value of the oldest piece, which is the output of the block
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  std::vector<Piece> line_;  // ring buffer of the pieces; its size is a power of two
};

}  // namespace softgrip::model
