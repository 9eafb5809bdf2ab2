#include "sysid/identification/combinations.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

using model::Model;

/// Returns the parameter values of the first block of this type. The model must contain such a block.
template <template <class> class Block>
const std::vector<double>& values_of(const Model& model) {
  return model.blocks[*model::position_of<Block>(model)].values;
}

double instantaneous(const Model& model) {
  return values_of<model::BoucWen>(model)[0] + 1 / values_of<model::KelvinVoigt>(model)[0];
}

void add_hysteresis(std::vector<Combination>& list) {
  const auto bw = [](const Model& m, std::size_t i) { return values_of<model::BoucWen>(m)[i]; };
  list.push_back({"saturation_growing_per_kpa", "1/kPa", "gamma + eta", 0.01,
                  [bw](const Model& m) { return bw(m, 2) + bw(m, 3); },
                  model::Formerly{"levelling_growing_per_kpa"}});
  list.push_back({"saturation_shrinking_per_kpa", "1/kPa", "gamma - eta", 0.01,
                  [bw](const Model& m) { return bw(m, 2) - bw(m, 3); },
                  model::Formerly{"levelling_shrinking_per_kpa"}});
  list.push_back({"hysteresis_limit_mm", "mm", "beta / (gamma + eta)", 0,
                  [bw](const Model& m) { return bw(m, 1) / (bw(m, 2) + bw(m, 3)); }});
}

void add_creep(const Model& model, std::vector<Combination>& list) {
  const std::size_t branches = (values_of<model::KelvinVoigt>(model).size() - 1) / 2;
  for (std::size_t b = 0; b < branches; ++b) {
    const std::string number = std::to_string(b + 1);
    const auto kv = [b](const Model& m, std::size_t i) {
      return values_of<model::KelvinVoigt>(m)[1 + 2 * b + i];
    };
    list.push_back({"branch" + number + "_gain_mm_per_kpa", "mm/kPa", "1/k" + number, 0,
                    [kv](const Model& m) { return 1 / kv(m, 0); }});
    list.push_back({"branch" + number + "_time_constant_s", "s", "c" + number + "/k" + number, 0,
                    [kv](const Model& m) { return kv(m, 1) / kv(m, 0); }});
  }
}

}  // namespace

std::vector<Combination> combinations_of(const Model& model) {
  std::vector<Combination> list;
  const bool hysteresis = model::position_of<model::BoucWen>(model).has_value();
  const bool creep = model::position_of<model::KelvinVoigt>(model).has_value();
  if (hysteresis && creep) {
    list.push_back({"instantaneous_gain_mm_per_kpa", "mm/kPa", "alpha + 1/k0", 0, instantaneous});
    list.push_back({"beta_over_instantaneous_gain", "", "beta / (alpha + 1/k0)", 0,
                    [](const Model& m) { return values_of<model::BoucWen>(m)[1] / instantaneous(m); }});
    list.push_back(
        {"creep_gain_mm_per_kpa", "mm/kPa", "sum of 1/k over all creep branches", 0, [](const Model& m) {
           const auto& kv = values_of<model::KelvinVoigt>(m);
           double sum = 0;
           for (std::size_t i = 1; i < kv.size(); i += 2) sum += 1 / kv[i];
           return sum;
         }});
  }
  if (hysteresis && values_of<model::BoucWen>(model)[4] == 1) add_hysteresis(list);
  if (creep) add_creep(model, list);
  if (model::position_of<model::TransportDelay>(model) && model::position_of<model::ValveLag>(model)) {
    list.push_back({"latency_s", "s", "delay + lag", 0.01, [](const Model& m) {
                      return values_of<model::TransportDelay>(m)[0] + values_of<model::ValveLag>(m)[0];
                    }});
  }
  return list;
}

double beta_over_gain(const model::Model& model) {
  for (const Combination& c : combinations_of(model)) {
    if (c.name == "beta_over_instantaneous_gain") return c.value(model);
  }
  return 0;
}

std::string wrong_way_sentence(double beta_over_gain) {
  // Largest ratio that is stated as a number. If alpha and 1/k0 are almost zero, the ratio is larger, and its
  // exact value has no meaning.
  constexpr double largest_told = 1000;
  const std::string rounded = significant(beta_over_gain, 3);
  const std::string ratio = beta_over_gain >= largest_told ? "is far above 1"
                            : rounded == "1"               ? "is slightly above 1"
                                                           : "= " + rounded + " is above 1";
  return "beta / (alpha + 1/k0) " + ratio +
         ", so the model has an inverse response (it first moves opposite to the command) and no usable "
         "inverse. The usual cause is a latency in the data";
}

}  // namespace softgrip::sysid
