#include "control/feedforward/invertibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "control/feedforward/pressure_plan.h"
#include "control/feedforward/running_model.h"
#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/chain.h"
#include "model/dual.h"
#include "model/named.h"

namespace softgrip::control {
namespace {

using model::BlockInfo;
using model::Inverse;
using model::Kind;
using model::Station;

constexpr std::string_view wrong_way_first = ": the model has an inverse response";
constexpr std::string_view usual_cause =
    "the usual cause is a latency in the data that the model lacks: run `softgrip diagnose`";

constexpr std::string_view creep_alone =
    ": at this pressure, the model moves only by creep, because the model has no elastic element (a spring, "
    "or a play with threshold 0)";
constexpr std::string_view planned_needs_none =
    "use feedforward `planned`, which does not require an elastic element";

constexpr std::string_view no_inverse_needed = "use feedforward `planned` or `none` with this model";

/// Smallest immediate gain of a model with an element that responds immediately to the pressure. A
/// Kelvin-Voigt spring without effect has the gain 1e-9 mm/kPa, which is below this limit.
constexpr double least_gain_mm_per_kpa = 1e-8;

/// The smallest slope of displacement over pressure that was found so far, and the pressure of this slope.
struct Worst {
  double gain_mm_per_kpa = std::numeric_limits<double>::max();
  double pressure_kpa = 0;
  bool rising = false;
};

/// Computes the slopes of displacement over pressure at `pressure_kpa`, for rising and for falling pressure.
/// Each slope is computed for a pressure change without duration and for a pressure change over one tick.
/// Stores the smallest slope in `worst`.
void look(const model::Chain<double>& chain, double pressure_kpa, double tick_s, Worst& worst) {
  constexpr double aside_kpa = 1e-7;
  for (const bool rising : {true, false}) {
    const model::Dual<double> there(pressure_kpa + (rising ? aside_kpa : -aside_kpa), 1);
    for (const double duration_s : {0.0, tick_s}) {
      const double gain = chain.peek(duration_s, there).v;
      if (std::isnan(gain) || gain < worst.gain_mm_per_kpa)
        worst = {.gain_mm_per_kpa = gain, .pressure_kpa = pressure_kpa, .rising = rising};
    }
  }
}

/// Moves a chain through its working range and checks the slope of displacement over pressure at every step.
/// The first loading and the full unloading reach the outermost hysteresis states from any initial state.
/// Inner loops and a slow pass reach the hysteresis states between the outermost ones. In the slow pass,
/// creep changes the state of the blocks that depend on displacement. The pressures go from 0 kPa up and down
/// to the limits.
Worst worst_gain(const model::Model& model, const LimitSettings& limits, double tick_s) {
  constexpr int steps = 200;
  constexpr std::array<double, 10> turns{1, 0, 1, 0.3, 0.8, 0.5, 0.6, 0, 0.4, 0};
  Worst worst;
  const auto walk = [&](double end_kpa, double step_s) {
    model::Chain<double> chain(model, {}, tick_s);
    chain.reset(0);
    double from = 0;
    for (const double turn : turns) {
      const double to = turn * end_kpa;
      for (int i = 0; i < steps; ++i) {
        const double pressure = from + (to - from) * i / steps;
        chain.step(step_s, pressure);
        look(chain, pressure, tick_s, worst);
      }
      from = to;
    }
  };
  for (const double step_s : {0.0, 0.5}) {
    walk(limits.pressure_max_kpa, step_s);
    if (limits.pressure_min_kpa < 0) walk(limits.pressure_min_kpa, step_s);
  }
  return worst;
}

/// Returns the sentence that explains the refusal of a model whose Bouc-Wen element has an inverse response
/// or no immediate gain (beta >= alpha + stiff). Otherwise returns an empty text. `stiff` is the immediate
/// gain of all elements except the Bouc-Wen element, and `stiff_name` is the name of this gain in the
/// sentence.
std::string wrong_way(const model::Model& model, double stiff, std::string_view stiff_name) {
  const model::Chain<double> chain(model);
  const auto* bouc_wen = chain.find<model::BoucWen<double>>();
  if (bouc_wen == nullptr) return {};
  const double beta = bouc_wen->beta_mm_per_kpa();
  const double gain = bouc_wen->alpha_mm_per_kpa() + stiff;
  if (beta < gain) return {};
  return "beta " + std::string(beta > gain ? ">" : "=") + " alpha" + std::string(stiff_name) + " (" +
         significant(beta) + (beta > gain ? " > " : " = ") + significant(gain) +
         model::in_unit(" mm/kPa)", model.output_unit) + std::string(wrong_way_first);
}

tl::expected<void, Refusal> check_gain(const model::Model& model, const LimitSettings& limits, double tick_s,
                                       double stiff, std::string_view stiff_name) {
  std::string text = wrong_way(model, stiff, stiff_name);
  if (!text.empty()) return tl::unexpected(Refusal{std::move(text), usual_cause});
  const Worst worst = worst_gain(model, limits, tick_s);
  if (worst.gain_mm_per_kpa >= least_gain_mm_per_kpa) return {};
  const bool backwards = !(worst.gain_mm_per_kpa >= 0);
  return tl::unexpected(Refusal{"the instantaneous gain is " + significant(worst.gain_mm_per_kpa) +
                                    model::in_unit(" mm/kPa at ", model.output_unit) +
                                    significant(worst.pressure_kpa) + " kPa while the pressure " +
                                    (worst.rising ? "rises" : "falls") +
                                    std::string(backwards ? wrong_way_first : creep_alone),
                                backwards ? usual_cause : planned_needs_none});
}

/// Returns true if the feedforward can invert the block or does not need to invert it. Blocks of the sensor
/// do not move the finger, so their inverse is not needed.
bool is_undone(const BlockInfo& info) {
  if (info.station == Station::sensor || info.inverse == Inverse::ignored) return true;
  if (info.inverse == Inverse::implicit) return true;
  if (info.station != Station::valve) return false;
  return info.inverse == Inverse::preview ||
         model::is<model::ValveLag, model::AsymmetricValveLag, model::ChamberLag, model::PressureRegulator,
                   model::RateLimit, model::PressureSaturation, model::ValveDeadband>(info);
}

tl::expected<void, Refusal> check_bouc_wen(const model::Model& model, const LimitSettings& limits,
                                           double tick_s) {
  const auto part = model::only(model, [](const BlockInfo& info) {
    return model::is<model::BoucWen, model::AsymmetricBoucWen, model::DuhemHysteresis>(
        info);  // the block of the asymmetry is a part of the hysteresis element
  });
  if (!model::position_of<model::BoucWen>(part)) {
    return tl::unexpected(Refusal{
        "the feedforward `bouc_wen` is the inverse of a `bouc_wen` block, but the model has no such block; "
        "the feedforward `full_model` is the inverse of the complete model"});
  }
  return check_gain(part, limits, tick_s, 0, "");
}

bool has_element(const model::Model& model) {
  return std::any_of(model.blocks.begin(), model.blocks.end(), [](const model::BlockSpec& block) {
    return model::catalogue()[block.type].info.kind == Kind::element;
  });
}

/// Returns the largest distance of the finger from its displacement at the lowest command, in the first 10 s
/// after a step from the lowest to the highest command [mm].
double largest_after_step_mm(const model::Model& model, const LimitSettings& limits) {
  constexpr double step_s = 0.005;
  constexpr int steps = 2000;
  model::Chain<double> chain(without_dead_time(model), {}, step_s);
  chain.reset(limits.pressure_min_kpa);
  const double begin_mm = chain.after(Station::load);
  chain.step(0, limits.pressure_max_kpa);
  double largest_mm = 0;
  for (int i = 0; i < steps; ++i) {
    largest_mm = std::max(largest_mm, std::abs(chain.after(Station::load) - begin_mm));
    chain.step(step_s, limits.pressure_max_kpa);
  }
  return largest_mm;
}

/// Checks that the settled displacement rises with the command, and that the finger stays deflected under a
/// constant command. With a falling displacement, the PID controller has a positive feedback, and a plan has
/// no solution. If the finger returns to its initial displacement, the settled gain is near 0, and a
/// controller must raise the command without end.
tl::expected<void, Refusal> check_settled_gain(const model::Model& model, const LimitSettings& limits) {
  // With a smaller share, holding the finger would need more than 20 times the pressure that moves it there.
  constexpr double least_share = 0.05;
  const double gain = settled_line(model, limits).gain_mm_per_kpa;
  const double settled_mm = gain * (limits.pressure_max_kpa - limits.pressure_min_kpa);
  const double largest_mm = largest_after_step_mm(model, limits);
  if (gain > 0 && settled_mm >= least_share * largest_mm) return {};
  const std::string text = "the model's settled gain between the lowest and the highest command is " +
                           significant(gain) + model::in_unit(" mm/kPa", model.output_unit);
  if (gain < 0 && settled_mm <= -least_share * largest_mm) {
    return tl::unexpected(Refusal{
        text + ", but a controller requires a gain above 0",
        "if the finger moves in the negative direction, turn the sign of the sensor's calibration and of the "
        "logs (`softgrip import --scale displacement=-1`), and identify the model again"});
  }
  return tl::unexpected(
      Refusal{text + ": the finger does not stay deflected under a constant command, but a controller "
                     "requires that at least 5 % of the largest displacement after a step remains"});
}

/// Checks that the model has an element that moves the finger. Only then can a plan be computed.
tl::expected<void, Refusal> check_planned(const model::Model& model) {
  if (has_element(model)) return {};
  return tl::unexpected(Refusal{"the model has no element that moves the finger"});
}

tl::expected<void, Refusal> check_full_model(const model::Model& model, const LimitSettings& limits,
                                             double tick_s) {
  std::vector<BlockInfo> blocks;
  for (const model::BlockSpec& spec : model.blocks) blocks.push_back(model::catalogue()[spec.type].info);
  const std::string names = not_undone(blocks);
  if (!names.empty()) {
    return tl::unexpected(Refusal{"the model contains " + names + ", which has no inverse",
                                  check_settled_gain(model, limits) ? no_inverse_needed : ""});
  }
  const model::Model body = body_of(model);
  if (!has_element(body)) return tl::unexpected(Refusal{"the model has no element that moves the finger"});
  const model::Chain<double> chain(body);
  const auto* spring = chain.find<model::KelvinVoigt<double>>();
  return check_gain(body, limits, tick_s, spring != nullptr ? spring->instantaneous_mm_per_kpa() : 0,
                    spring != nullptr ? " + 1/k0" : "");
}

/// Checks that the feedforward of this kind can be computed for the model.
tl::expected<void, Refusal> check_kind(const model::Model& model, FeedforwardKind kind,
                                       const LimitSettings& limits, double tick_s) {
  switch (kind) {
    case FeedforwardKind::none:
      break;
    case FeedforwardKind::bouc_wen:
      return check_bouc_wen(model, limits, tick_s);
    case FeedforwardKind::full_model:
      return check_full_model(model, limits, tick_s);
    case FeedforwardKind::planned:
      return check_planned(model);
  }
  return {};
}

}  // namespace

std::string not_undone(std::span<const BlockInfo> blocks) {
  std::string names;
  for (const BlockInfo& block : blocks) {
    if (!is_undone(block)) names += (names.empty() ? "`" : ", `") + std::string(block.id) + "`";
  }
  return names;
}

std::string Refusal::with_advice() const {
  return advice.empty() ? text : text + "; " + std::string(advice);
}

tl::expected<void, Refusal> check_feedforward(const model::Model& model, const FeedforwardSettings& settings,
                                              const LimitSettings& limits, double tick_s) {
  if (!(settings.extra_latency_s >= 0 && settings.extra_latency_s <= 1)) {
    return tl::unexpected(Refusal{"extra_latency_s must be between 0 and 1 s"});
  }
  const auto possible = check_kind(model, settings.kind, limits, tick_s);
  if (!possible || !has_element(model)) return possible;
  return check_settled_gain(model, limits);
}

}  // namespace softgrip::control
