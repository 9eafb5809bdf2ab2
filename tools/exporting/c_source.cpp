#include "tools/exporting/c_source.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

#include "base/numbers.h"
#include "base/text.h"
#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/feedforward/invertibility.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"
#include "model/file/model_file.h"
#include "model/named.h"

namespace softgrip::tools {
namespace {

/// C functions with which the other fragments divide segments, in the order in which they appear in the C
/// file.
constexpr std::string_view cutting = R"(
static double at_share(segment s, double share) {
  return s.begin + (s.end - s.begin) * share + bend_of(s) * (share * (1.0 - share));
}

static segment part_beyond(segment s, double share) {
  const double value = at_share(s, share);
  const double middle = at_share(s, (share + 1.0) * 0.5);
  return bent(s.duration_s * (1.0 - share), value, s.end, (value + s.end + middle * 4.0) * (1.0 / 6.0));
}
)";
constexpr std::string_view cutting_before = R"(
static segment part_before(segment s, double share) {
  const double value = at_share(s, share);
  const double middle = at_share(s, share * 0.5);
  return bent(s.duration_s * share, s.begin, value, (s.begin + value + middle * 4.0) * (1.0 / 6.0));
}
)";
constexpr std::string_view passing = R"(
static double fraction_at(segment s, double level) {
  const double sum = (s.end - s.begin) + bend_of(s);
  const double discriminant = sum * sum - 4.0 * bend_of(s) * (level - s.begin);
  double root;
  if (discriminant <= 0.0) return (level - s.begin) / (s.end - s.begin);
  root = sqrt(discriminant);
  return 2.0 * (level - s.begin) / (sum < 0.0 ? sum - root : sum + root);
}
)";
constexpr std::string_view phi_one = R"(
/* (exp(w) - 1) / w */
static double phi_one(double w) {
  if (fabs(w) < 0.004) return 1.0 + w * 0.5 + w * w * (1.0 / 6.0 + w * (1.0 / 24.0) + w * w * (1.0 / 120.0));
  return expm1(w) / w;
}
)";

/// The C source of a block. Each `#` in a text is replaced by the index of the block.
struct CBlock {
  std::string_view text;
  std::string_view state;  ///< C declaration of the block's state
  std::string_view reset;  ///< C expression for the output of the block at rest
  std::string_view step;   ///< for a valve block, a C statement that calls the next block; otherwise a C
                           ///< expression for the output segment
  /// For a valve block, the name of the time constant that the inverse compensates; empty: the inverse
  /// compensates no time constant of this block.
  std::string_view lead;
};

template <template <class> class Block>
constexpr std::string_view block_id = Block<double>::info.id;

const std::map<std::string_view, CBlock>& c_blocks() {
  static const CBlock two_way{c_text::two_way_lag, "double block_#;", "block_# = input",
                              "two_way_lag_step(&s->block_#, values_#[0], values_#[1], in, s, next)",
                              "(rate >= 0.0 ? values_#[0] : values_#[1])"};
  static const std::map<std::string_view, CBlock> blocks{
      {block_id<model::TransportDelay>,
       {c_text::transport_delay, "transport_delay block_#;",
        "transport_delay_reset(&s->block_#, values_#[0], input)",
        "transport_delay_step(&s->block_#, values_#[0], in, s, next)", ""}},
      {block_id<model::ValveLag>,
       {c_text::valve_lag, "double block_#;", "block_# = input",
        "valve_lag_step(&s->block_#, values_#[0], in, s, next)", "values_#[0]"}},
      {block_id<model::AsymmetricValveLag>, two_way},
      {block_id<model::ChamberLag>, two_way},
      {block_id<model::RateLimit>,
       {c_text::rate_limit, "double block_#;", "block_# = input",
        "rate_limit_step(&s->block_#, values_#[0], values_#[1], in, s, next)", ""}},
      {block_id<model::BoucWen>,
       {c_text::bouc_wen, "bouc_wen block_#;", "bouc_wen_reset(&b->block_#, values_#, input)",
        "bouc_wen_step(&b->block_#, values_#, in)", ""}},
      {block_id<model::PrandtlIshlinskii>,
       {c_text::prandtl_ishlinskii, "play block_#[PARTS_#];",
        "prandtl_ishlinskii_reset(b->block_#, values_#, PARTS_#, input)",
        "prandtl_ishlinskii_step(b->block_#, values_#, PARTS_#, in)", ""}},
      {block_id<model::KelvinVoigt>,
       {c_text::kelvin_voigt, "double block_#[PARTS_# + 1];",
        "kelvin_voigt_reset(b->block_#, values_#, PARTS_#, input)",
        "kelvin_voigt_step(b->block_#, values_#, PARTS_#, in)", ""}},
      {block_id<model::PressureDependentCreep>,
       {c_text::pressure_dependent_creep, "double block_#[PARTS_#];",
        "pressure_dependent_creep_reset(b->block_#, values_#, PARTS_#, input)",
        "pressure_dependent_creep_step(b->block_#, values_#, PARTS_#, in)", ""}},
      {block_id<model::LinearModes>,
       {c_text::linear_modes, "mode block_#[PARTS_# + 1];",
        "linear_modes_reset(b->block_#, values_#, PARTS_#, input)",
        "linear_modes_step(b->block_#, values_#, PARTS_#, in)", ""}},
      {block_id<model::Characteristic>,
       {c_text::characteristic, "double block_#;", "b->block_# = characteristic_of(values_#, output)",
        "characteristic_step(&b->block_#, values_#, sum)", ""}},
  };
  return blocks;
}

std::string numbered(std::string_view text, std::size_t number) {
  std::string out;
  for (const char c : text) out += c == '#' ? std::to_string(number) : std::string(1, c);
  return out;
}

/// Returns true if the exported functions of a model with this name could have the name of a function in a
/// fragment.
bool is_in_use(const std::string& name) {
  return name == "body" || name == "mode" || name == "play" || name == "two_way_lag" ||
         c_blocks().contains(name);
}

std::string c_name(const std::string& name) {
  std::string valid;
  for (const char c : name) valid += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  const bool is_free =
      !valid.empty() && std::isdigit(static_cast<unsigned char>(valid.front())) == 0 && !is_in_use(valid);
  return is_free ? valid : "model_" + valid;
}

class Generator {
 public:
  Generator(const model::Model& model, double tick_s, std::string name)
      : model_(model), tick_s_(tick_s), name_(std::move(name)) {
    for (std::size_t i = 0; i < model.blocks.size(); ++i) {
      const model::BlockInfo& info = model::catalogue()[model.blocks[i].type].info;
      (info.kind == model::Kind::pressure  ? valve_
       : info.kind == model::Kind::element ? elements_
                                           : maps_)
          .push_back(i);
    }
  }

  std::string run(bool with_inverse) {
    text_ += "#define TICK_S " + shortest(tick_s_) + "\n";
    if (with_inverse) text_ += "#define HAS_INVERSE\n";
    add_values();
    add_fragments();
    add_body();
    if (with_inverse) text_ += c_text::inverse;
    add_chain();
    if (with_inverse) add_inverse();
    return text_;
  }

 private:
  [[nodiscard]] std::string_view id(std::size_t i) const {
    return model::catalogue()[model_.blocks[i].type].info.id;
  }
  [[nodiscard]] const CBlock& block(std::size_t i) const { return c_blocks().at(id(i)); }
  void add_values() {
    for (std::size_t i = 0; i < model_.blocks.size(); ++i) {
      const std::vector<double>& values = model_.blocks[i].values;
      const std::string number = std::to_string(i);
      text_ += "/* " + std::string(id(i)) + " */\nstatic const double values_" + number + "[] = {" +
               with_commas(values, shortest) + "};\n";
      const model::BlockDescriptor& type = model::catalogue()[model_.blocks[i].type];
      if (type.repeated.empty()) continue;
      const std::size_t parts = (values.size() - type.parameters.size()) / type.repeated.size();
      text_ += "#define PARTS_" + number + " " + std::to_string(parts) + "\n";
    }
  }

  void add_fragments() {
    text_ += c_text::common;
    const bool is_cut_before =
        model::has_any<model::TransportDelay, model::AsymmetricValveLag, model::ChamberLag>(model_);
    const bool passes = model::has_any<model::PrandtlIshlinskii>(model_);
    if (is_cut_before || passes) text_ += cutting;
    if (is_cut_before) text_ += cutting_before;
    if (passes) text_ += passing;
    if (model::has_any<model::BoucWen, model::Characteristic>(model_)) text_ += phi_one;
    std::vector<const char*> added;
    for (std::size_t i = 0; i < model_.blocks.size(); ++i) {
      const std::string_view fragment = block(i).text;
      if (std::find(added.begin(), added.end(), fragment.data()) != added.end()) continue;
      if (model::is<model::TransportDelay>(model_.blocks[i]))
        text_ += "\n#define DELAY_PIECES " + std::to_string(delay_pieces()) + "\n";
      text_ += fragment;
      added.push_back(fragment.data());
    }
  }

  /// Returns the size of the delay buffer [segments], a power of two. The command of a sampling interval is
  /// one segment, and each block before the delay divides a segment into at most two segments. The remaining
  /// segments are a margin for the segments at both ends of the delay.
  [[nodiscard]] std::size_t delay_pieces() const {
    std::size_t needed = 16;
    std::size_t per_tick = 1;
    for (const std::size_t i : valve_) {
      if (model::is<model::TransportDelay>(model_.blocks[i])) {
        const double ticks = model_.blocks[i].values[0] / tick_s_;
        const auto buffered = static_cast<double>(std::max(per_tick, least_per_tick)) * ticks;
        needed = std::max(needed, 16 + static_cast<std::size_t>(buffered));
      }
      per_tick *= 2;
    }
    std::size_t pieces = 64;
    while (pieces < needed) pieces *= 2;
    return pieces;
  }

  /// Adds the blocks behind the valve. The outputs of the elements are added, and their sum passes through
  /// the characteristic maps.
  void add_body() {
    text_ +=
        "\n/* State of the blocks after the valve: from the pressure to the displacement. */\ntypedef struct "
        "{\n";
    for (const auto* list : {&elements_, &maps_}) {
      for (const std::size_t i : *list) text_ += "  " + numbered(block(i).state, i) + "\n";
    }
    text_ +=
        "  double output;\n} body;\n\nstatic double body_reset(body *b, double input) {\n  double output = "
        "0.0;\n";
    for (const std::size_t i : elements_) text_ += "  output += " + numbered(block(i).reset, i) + ";\n";
    for (const std::size_t i : maps_) text_ += "  output = " + numbered(block(i).reset, i) + ";\n";
    text_ +=
        "  (void)input;\n  return b->output = output;\n}\n\nstatic double body_step(body *b, segment in) {\n";
    text_ += "  segment sum = bent(in.duration_s, 0.0, 0.0, 0.0);\n";
    for (const std::size_t i : elements_) {
      text_ += "  {\n    const segment out = " + numbered(block(i).step, i) +
               ";\n    sum.begin += out.begin;\n    sum.end += out.end;\n    sum.mean += out.mean;\n  }\n";
    }
    for (const std::size_t i : maps_) text_ += "  sum = " + numbered(block(i).step, i) + ";\n";
    text_ += "  return b->output = sum.end;\n}\n";
  }

  void add_chain() {
    text_ +=
        "\n/* State of the complete model: from the command to the displacement. */\ntypedef struct {\n  "
        "double command_kpa;\n";
    for (const std::size_t i : valve_) text_ += "  " + numbered(block(i).state, i) + "\n";
    text_ += "  body body;\n} " + name_ + "_state;\n";
    text_ += "\nstatic void at_body(void *chain, segment in) {\n  " + name_ +
             "_state *s = chain;\n  body_step(&s->body, in);\n}\n";
    std::string next = "at_body";
    for (std::size_t k = valve_.size(); k-- > 0;) {
      const std::size_t i = valve_[k];
      std::string step = numbered(block(i).step, i);
      step.replace(step.rfind("next"), 4, next);
      next = numbered("at_#", i);
      text_ += "\nstatic void " + next + "(void *chain, segment in) {\n  " + name_ +
               "_state *s = chain;\n  " + step + ";\n}\n";
    }
    text_ += model::in_unit(
                 "\n/* Sets the steady state at the constant command command_kpa, which is reached after one "
                 "increase "
                 "of the command from 0 to command_kpa. Returns the displacement [mm]. */\ndouble ",
                 model_.output_unit) +
             name_ + "_reset(" + name_ +
             "_state *s, double command_kpa) {\n  const double input = command_kpa;\n"
             "  s->command_kpa = command_kpa;\n";
    for (const std::size_t i : valve_) {
      std::string reset = numbered(block(i).reset, i);
      if (reset.starts_with("block_")) reset = "s->" + reset;
      text_ += "  (void)(" + reset + ");\n";
    }
    text_ += "  return body_reset(&s->body, input);\n}\n";
    text_ += model::in_unit(
                 "\n/* Simulates TICK_S, in which the command changes linearly to command_kpa. Returns the "
                 "displacement [mm]. */\ndouble ",
                 model_.output_unit) +
             name_ + "_step(" + name_ +
             "_state *s, double command_kpa) {\n"
             "  const segment in = straight(TICK_S, s->command_kpa, command_kpa);\n  s->command_kpa = "
             "command_kpa;\n  " +
             next + "(s, in);\n  return s->body.output;\n}\n";
  }

  void add_inverse() {
    const std::string type = name_ + "_inverse_state";
    text_ +=
        "\n/* State of the inverse. `body` is a separate copy of the blocks after the valve. */\ntypedef "
        "struct {\n  body body;\n  double "
        "pressure_kpa;\n"
        "  double led_kpa[" +
        std::to_string(valve_.size() + 1) + "];\n} " + type + ";\n";
    text_ += "\nvoid " + name_ + "_inverse_reset(" + type +
             " *s, double pressure_kpa) {\n  int i;\n"
             "  s->pressure_kpa = pressure_kpa;\n  for (i = 0; i < " +
             std::to_string(valve_.size() + 1) +
             "; ++i) s->led_kpa[i] = pressure_kpa;\n  body_reset(&s->body, pressure_kpa);\n}\n";
    text_ +=
        "\n/* Returns the command that leads to displacement_mm after one tick. The delay of the valve is "
        "not compensated. The\n   pressure at the actuator is limited to [lowest_kpa, highest_kpa] and is "
        "stored in s->pressure_kpa. */\ndouble " +
        name_ + "_inverse_step(" + type +
        " *s, double displacement_mm, double lowest_kpa, double highest_kpa) {\n"
        "  const double pressure_kpa = body_solve(&s->body, s->pressure_kpa, displacement_mm, lowest_kpa, "
        "highest_kpa);\n  double led = pressure_kpa;\n  body_step(&s->body, straight(TICK_S, "
        "s->pressure_kpa, "
        "pressure_kpa));\n  s->pressure_kpa = pressure_kpa;\n";
    // Compute backwards from the actuator to the command: for each lag, the required output and its rate.
    for (std::size_t k = valve_.size(); k-- > 0;) {
      const CBlock& lag = block(valve_[k]);
      if (lag.lead.empty()) continue;
      const std::string at = "s->led_kpa[" + std::to_string(k) + "]";
      text_ += "  {\n    const double rate = (led - " + at + ") / TICK_S;\n    " + at +
               " = led;\n    led += " + numbered(lag.lead, valve_[k]) + " * rate;\n  }\n";
    }
    text_ += "  return led;\n}\n";
  }

  /// Smallest number of segments per sampling interval for which the delay buffer must have room.
  static constexpr std::size_t least_per_tick = 4;

  const model::Model& model_;
  double tick_s_;
  std::string name_;
  std::vector<std::size_t> valve_, elements_, maps_;
  std::string text_;
};

/// Returns the names of the blocks without a C version, or "" if all blocks have one.
std::string without_c(const model::Model& model) {
  std::string names;
  for (const model::BlockSpec& spec : model.blocks) {
    const std::string_view id = model::catalogue()[spec.type].info.id;
    const bool sharp = model::is<model::BoucWen>(spec) && spec.values.back() != 1;
    if (c_blocks().contains(id) && !sharp) continue;
    names += (names.empty() ? "" : ", ") + std::string(id) + (sharp ? " of an exponent above 1" : "");
  }
  return names;
}

std::string why_no_inverse(const model::Model& model, double tick_s, double pressure_max_kpa) {
  control::FeedforwardSettings settings;
  settings.kind = control::FeedforwardKind::full_model;
  control::LimitSettings limits;
  limits.pressure_max_kpa = pressure_max_kpa;
  const auto there = control::check_feedforward(model, settings, limits, tick_s);
  return there ? std::string() : there.error().with_advice();
}

}  // namespace

tl::expected<CSource, std::string> c_source(const model::Model& model, double tick_s, double pressure_max_kpa,
                                            const std::string& software) {
  if (const std::string names = without_c(model); !names.empty())
    return tl::unexpected("there is no C version of " + names);
  CSource source;
  source.name = c_name(model.name);
  source.no_inverse = why_no_inverse(model, tick_s, pressure_max_kpa);
  std::string about = "/* " + model.name +
                      ", a model of a soft finger and its valve, in C99: " + model::model_hash(model) +
                      ", by " + software + ".\n";
  if (!source.no_inverse.empty()) about += "   The model has no inverse: " + source.no_inverse + "\n";
  for (std::size_t at = 2; (at = about.find("*/", at)) != std::string::npos;) about.replace(at, 2, "* ");
  source.text =
      about +
      model::in_unit("   Pressures are in kPa, each displacement is in mm. One call simulates one tick. */\n",
                     model.output_unit) +
      "#include <math.h>\n\n" + Generator(model, tick_s, source.name).run(source.no_inverse.empty());
  return source;
}

}  // namespace softgrip::tools
