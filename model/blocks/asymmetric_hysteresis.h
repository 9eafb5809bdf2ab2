#pragma once
// Loading and unloading loops that differ in shape.

#include "model/block.h"
#include "model/blocks/bouc_wen.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Two shapes of it, each with its own neutral value.
///
/// delta, epsilon and the share of beta skew the chain's own Bouc-Wen element, which levels off faster or
/// follows the pressure closer one way than the other (bouc_wen.h says whose form it is). They have no output
/// of their own and do nothing in a chain without bouc_wen.
///
/// gain adds an element that unloading winds up and loading unwinds, each over its own pressure: while the
/// pressure falls, z approaches the unloading length; while it rises, z fades over the loading length. Rate
/// independent; nothing on the first loading. With both lengths equal the settled loop is point symmetric, as
/// Bouc-Wen's own is; with different ones it is not. Exact for any step size.
template <class T>
class AsymmetricHysteresis {
 public:
  static constexpr BlockInfo info{.id = "asymmetric_hysteresis",
                                  .station = Station::actuator,
                                  .kind = Kind::element,
                                  .inverse = Inverse::implicit,
                                  .title = "Asymmetric hysteresis",
                                  .meaning = "Loading and unloading loops differ in shape.",
                                  .equation =
                                      "bouc_wen: h' += beta_share beta |p'| - delta |h| |p'| - epsilon h p'; "
                                      "y += gain z; falling: "
                                      "z' = |p'| (1 - z/unloading); rising: z' = -|p'| z/loading"};
  static constexpr std::array parameters{
      ParameterSpec{.name = "gain_mm_per_kpa",
                    .unit = "mm/kPa",
                    .default_value = 0.02,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.02,
                    .meaning = "added per pressure at the start of unloading",
                    .neutral = 0.0},
      ParameterSpec{.name = "unloading_kpa",
                    .unit = "kPa",
                    .default_value = 20.0,
                    .lower = 0.01,
                    .upper = 10000.0,
                    .scale = 5.0,
                    .meaning = "fall of the pressure over which it builds up"},
      ParameterSpec{.name = "loading_kpa",
                    .unit = "kPa",
                    .default_value = 5.0,
                    .lower = 0.01,
                    .upper = 10000.0,
                    .scale = 5.0,
                    .meaning = "rise of the pressure over which it fades"},
      ParameterSpec{.name = "delta_per_kpa",
                    .unit = "1/kPa",
                    .default_value = 0.01,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.02,
                    .meaning =
                        "added to how fast the state of bouc_wen levels off on loading, taken from it on "
                        "unloading; at most its eta",
                    .neutral = 0.0,
                    .if_left_out = 0.0},
      ParameterSpec{.name = "epsilon_per_kpa",
                    .unit = "1/kPa",
                    .default_value = 0.01,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.02,
                    .meaning = "added to eta of bouc_wen on loading, taken from it on unloading",
                    .neutral = 0.0,
                    .if_left_out = 0.0},
      ParameterSpec{
          .name = "beta_share",
          .unit = "",
          .default_value = 0.1,
          .lower = -0.9,
          .upper = 0.9,
          .scale = 0.1,
          .meaning = "share of beta of bouc_wen that is added on loading, taken from it on unloading",
          .neutral = 0.0,
          .if_left_out = 0.0}};

  AsymmetricHysteresis(std::span<const T> values, const Preparation&)
      : gain_(values[0]),
        unloading_per_kpa_(1.0 / values[1]),
        loading_per_kpa_(1.0 / values[2]),
        skew_{values[3], values[4], values[5]} {}

  /// Called once by the chain, which has made all its blocks by then.
  void shape(BoucWen<T>& hysteresis) const { hysteresis.skew(skew_); }

  void reset(const T& input) {
    falling_ = value_of(input) < 0.0;
    wound_kpa_ = T(0.0);
    wound_kpa_ = moved(input, falling_);
    pressure_ = input;
    output_ = gain_ * wound_kpa_;
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    const T change = in.end - in.begin;
    falling_ = is_falling(change);
    const T before = wound_kpa_;
    wound_kpa_ = moved(change, falling_);
    pressure_ = in.end;
    output_ = gain_ * wound_kpa_;
    // The cubic through both ends and their slopes.
    const T size = falling_ ? T(-change) : change;
    const T bow =
        size * (falling_ ? unloading_per_kpa_ : loading_per_kpa_) * (wound_kpa_ - before) * (1.0 / 12.0);
    return {in.duration_s, begin, output_, gain_ * ((before + wound_kpa_) * 0.5 + bow)};
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    const U change = end_kpa - pressure_;
    return gain_ * moved(change, is_falling(change));
  }

 private:
  template <class U>
  [[nodiscard]] bool is_falling(const U& change) const {
    const double value = value_of(change);
    return value < 0.0 || (value == 0.0 && falling_);
  }

  // z after a monotone change: dz/d|p| = 1 - z/unloading or -z/loading.
  template <class U>
  [[nodiscard]] U moved(const U& change, bool falling) const {
    const T& per_kpa = falling ? unloading_per_kpa_ : loading_per_kpa_;
    const U size = falling ? U(-change) : change;
    return wound_kpa_ + size * phi1(U(-(per_kpa * size))) * ((falling ? 1.0 : 0.0) - per_kpa * wound_kpa_);
  }

  T gain_;
  T unloading_per_kpa_;  // 1/unloading
  T loading_per_kpa_;
  BoucWenSkew<T> skew_;
  bool falling_ = false;
  T wound_kpa_{0.0};  // z
  T pressure_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
