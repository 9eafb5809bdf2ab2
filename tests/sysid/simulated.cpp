#include "tests/sysid/simulated.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include "model/chain.h"
#include "model/file/model_file.h"

namespace softgrip::sysid {

model::Model loaded(const std::string& name) {
  document::Problems problems;
  auto model =
      model::load_model(std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/" + name + ".yaml", problems);
  if (!model) throw std::runtime_error(problems.format());
  return *model;
}

Log simulated(const model::Model& model, model::SignalName signal, double rate_hz, double noise_mm,
              std::uint64_t seed, double correlation) {
  Log log;
  log.name = std::string(model::name_of(signal));
  log.path = log.name + ".csv";
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  model::Chain<double> chain(model, {}, 1 / rate_hz);
  double noise = normal(random);
  const auto samples = static_cast<std::size_t>(std::lround(model::duration_s(signal) * rate_hz)) + 1;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    const double p = model::value_kpa(signal, t);
    const double y = i == 0 ? chain.reading_mm() : chain.step(1 / rate_hz, p);
    if (i > 0) noise = correlation * noise + std::sqrt(1 - correlation * correlation) * normal(random);
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(p);
    log.displacement_mm.push_back(y + noise_mm * noise);
  }
  return log;
}

model::Model scattered(model::Model model, double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!model::parameter_spec(model, i).whole) values[i] *= std::exp(share * normal(random));
  }
  return model::with_values(std::move(model), values);
}

}  // namespace softgrip::sysid
