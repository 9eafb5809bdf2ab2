#pragma once
// Models hysteresis as a sum of play operators (Kuhnen, European Journal of Control 9, 2003, section 2).

#include <cstddef>
#include <string_view>
#include <vector>

#include "model/block.h"
#include "model/envelope_map.h"
#include "model/play.h"
#include "model/static_map.h"

namespace softgrip::model {

/// Adds w1 play_r1(p) + w2 play_r2(p) + ... to the displacement y. A play with threshold 0 is the elastic
/// gain. The block is rate independent. If all weights are 0 or positive, y rises with the pressure and has
/// an inverse. If the finger was loaded before the log, the operators start in the positions to which the
/// earlier load moved them. In this case, the first loading is not steeper than later loadings, and y is 0 in
/// the initial state. If the envelopes are nonlinear (see EnvelopeMap), the plays are generalised plays. The
/// loops are then wider at pressures where the envelopes are steeper.
template <class T>
class PrandtlIshlinskii {
 public:
  static constexpr BlockInfo info = block_info(
      "prandtl_ishlinskii", Station::actuator, Kind::element, Inverse::implicit,
      "Prandtl-Ishlinskii hysteresis", "Rate-independent hysteresis as a sum of play operators.",
      "y += w1 o1 + w2 o2 + ..., |b(p) - o| <= r in every operator; o moves only to keep this condition; "
      "b(p) = p (1 - (1 - x)(bend - skew (1 - 2 x))), x = p / envelope_kpa for p from 0 to envelope_kpa; "
      "straight lines outside this range");
  static constexpr std::array parameters{
      parameter("trained_kpa", "kPa",
                "largest pressure before the start of the log; 0 if the finger was never loaded",
                Typical{15.0}, Within{0.0, 1e4}, Scale{10.0}, Placed{}, IfLeftOut{0.0}),
      parameter("envelope_bend", "",
                "bend of the envelope curves; a value above 0 makes these curves steeper at high pressures",
                Typical{0.0}, Within{-EnvelopeMap<double>::most_bend, EnvelopeMap<double>::most_bend},
                Scale{0.1}, IfLeftOut{0.0}),
      parameter(
          "envelope_skew", "",
          "skew of the envelope curves; a value above 0 makes these curves less steep at medium pressures",
          Typical{0.0}, Within{-EnvelopeMap<double>::most_skew, EnvelopeMap<double>::most_skew}, Scale{0.1},
          IfLeftOut{0.0}),
      parameter(
          "envelope_kpa", "kPa",
          "pressure at which the nonlinear range of the envelope curves ends; 0 for straight envelope curves",
          Typical{0.0}, Within{0.0, 1e4}, Scale{10.0}, Placed{}, IfLeftOut{0.0})};
  static constexpr std::array repeated{parameter("r#_kpa", "kPa",
                                                 "threshold of play operator #, above the threshold of the "
                                                 "previous operator; 0 for an elastic element",
                                                 Typical{2.0}, Within{0.0, 1e4}, Scale{2.0}, Placed{}),
                                       parameter("w#_mm_per_kpa", "mm/kPa", "weight of play operator #",
                                                 Typical{0.1}, Within{0.0, 1e4}, Scale{0.1}, Neutral{0.0})};
  static constexpr std::size_t max_parts = 24;

  PrandtlIshlinskii(std::span<const T> values, const Preparation&)
      : trained_kpa_(values[0]), envelopes_(values[1], values[2], values[3]) {
    for (std::size_t i = parameters.size(); i + 1 < values.size(); i += 2)
      operators_.push_back({Play<T>(values[i]), values[i + 1]});
  }

  static std::string_view objection(std::span<const double> values) {
    if ((values[1] != 0 || values[2] != 0) && !(values[3] > 0))
      return "nonlinear envelopes require envelope_kpa above 0";
    for (std::size_t i = parameters.size() + 2; i < values.size(); i += 2) {
      if (values[i] <= values[i - 2]) return "the thresholds must rise from operator to operator";
    }
    return {};
  }

  void reset(const T& input) {
    untouched_ = output_ = T(0.0);
    for (Operator& each : operators_) {
      each.play.reset(envelopes_.value(trained_kpa_));
      each.play.settle(T(0.0));
      untouched_ += each.weight * each.play.output();
      each.play.settle(envelopes_.value(input));
      output_ += each.weight * each.play.output();
    }
    output_ -= untouched_;
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    if (!envelopes_.bends()) return moved(in);
    return moved(mapped(
        in, [this](const T& p) { return envelopes_.value(p); }, envelopes_.value(in.begin)));
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    const U end = envelopes_.value(end_kpa);
    U sum(0.0);
    for (const Operator& each : operators_) sum = sum + each.weight * each.play.peek(end);
    return sum - untouched_;
  }

 private:
  struct Operator {
    Play<T> play;
    T weight;
  };

  /// Advances all operators by one segment and returns the displacement of the block.
  /// @param in  pressure after the envelope map.
  Segment<T> moved(const Segment<T>& in) {
    const T begin = output_;
    T end = -untouched_, mean = -untouched_;
    const bool lasts = !is_zero(in.duration_s);
    for (Operator& each : operators_) {
      each.play.step(in, [&](const Segment<T>& part) {
        if (lasts) mean += each.weight * part.mean * (part.duration_s / in.duration_s);
      });
      end += each.weight * each.play.output();
    }
    output_ = end;
    return {in.duration_s, begin, end, lasts ? mean : T((begin + end) * 0.5)};
  }

  T trained_kpa_;
  EnvelopeMap<T> envelopes_;
  std::vector<Operator> operators_;
  T untouched_{0.0};  ///< weighted sum of the operators at zero pressure after the earlier load of the finger
  T output_{0.0};
};

}  // namespace softgrip::model
