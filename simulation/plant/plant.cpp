#include "simulation/plant/plant.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "model/chain.h"

namespace softgrip::simulation {
namespace {

using model::Chain;
using Contact = model::Contact<double>;

// Position of the contact block while no object is present. No finger reaches this position, so the contact
// block does not change the displacement.
constexpr double out_of_reach_mm = 1000;
constexpr double most_stiffening = 1e6;

// Longest time step of the model. In each time step, a chain approximates the response of a lag to a jump by
// one parabola. For the model bench_twin, the error is 2e-8 mm with time steps of 5 ms, and 0.1 mm with time
// steps of 0.5 s.
constexpr double longest_step_s = 5e-3;

Contact contact_for(const std::optional<PlantObject>& object) {
  if (!object.has_value()) return {std::array{out_of_reach_mm, 0.0}, {}};
  const double stiffening = object->yielding > 0 ? 1 / object->yielding - 1 : most_stiffening;
  return {std::array{object->position_mm, std::clamp(stiffening, 0.0, most_stiffening)}, {}};
}

std::size_t contact_type() {
  return model::find_block(Contact::info.id).value();
}

/// Returns the model with an additional contact block that represents the object. The block follows all
/// contact blocks of the model's load.
model::Model with_object_place(const model::Model& model) {
  return model::with_block(model, {contact_type(), {out_of_reach_mm, 0.0}});
}

std::size_t object_place(const model::Model& model) {
  std::size_t place = 0;
  for (std::size_t i = 0; i < model.blocks.size(); ++i) {
    if (model.blocks[i].type == contact_type()) place = i;
  }
  return place;
}

}  // namespace

struct Plant::Parts {
  explicit Parts(const PlantSettings& settings)
      : model(with_object_place(settings.model)),
        place(object_place(model)),
        chain(model, {}, settings.sample_time_s, derived_seed(settings.seed, 0)),
        displacement_noise_mm(settings.displacement_noise_mm),
        pressure_noise_kpa(settings.pressure_noise_kpa),
        temperature_noise_c(settings.temperature_noise_c),
        displacement_seed(derived_seed(settings.seed, 1)),
        pressure_seed(derived_seed(settings.seed, 2)),
        temperature_seed(derived_seed(settings.seed, 3)) {
    around.temperature_c = settings.temperature_c;
  }

  model::Model model;
  std::size_t place;
  Chain<double> chain;
  double displacement_noise_mm;
  double pressure_noise_kpa;
  double temperature_noise_c;
  std::uint64_t displacement_seed;
  std::uint64_t pressure_seed;
  std::uint64_t temperature_seed;
  model::Surroundings around;
  std::optional<PlantObject> object;
  LineFault line;
  SensorFault sensor;
  double command_kpa = 0;  ///< output pressure of the board
  double applied_kpa = 0;  ///< input of the model: the command as the line faults change it
  std::uint64_t samples = 0;
  double reading_mm = 0;
  double pressure_kpa = 0;  ///< pressure that the pressure monitor measures

  void apply() noexcept {
    if (line.kind == LineFault::Kind::blocked) return;
    const double lost = line.kind == LineFault::Kind::leaking ? std::clamp(line.share, 0.0, 1.0) : 0;
    applied_kpa = command_kpa * (1 - lost);
  }

  void sense() noexcept {
    pressure_kpa = chain.pressure_kpa() + pressure_noise_kpa * normal_at(pressure_seed, samples);
    if (sensor.kind == SensorFault::Kind::stuck) return;
    const double offset = sensor.kind == SensorFault::Kind::offset ? sensor.value_mm : 0;
    reading_mm = chain.reading_mm() + displacement_noise_mm * normal_at(displacement_seed, samples) + offset;
  }
};

Plant::Plant(const PlantSettings& settings) : parts_(std::make_unique<Parts>(settings)) {
  set_object(settings.object);
  parts_->sense();
}

Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;
Plant::~Plant() = default;

void Plant::command(double command_kpa) noexcept {
  if (!std::isfinite(command_kpa)) return;
  parts_->command_kpa = command_kpa;
  parts_->apply();
}

void Plant::advance(double duration_s) noexcept {
  Parts& parts = *parts_;
  if (!(duration_s > 0)) return;
  // The board holds its output. Therefore, the command jumps at the start of the time step and then remains
  // constant.
  if (parts.chain.command_kpa() != parts.applied_kpa) parts.chain.step(0, parts.applied_kpa, parts.around);
  const long pieces = std::max(1L, std::lround(std::ceil(duration_s / longest_step_s - 1e-6)));
  const double piece_s = duration_s / static_cast<double>(pieces);
  for (long i = 0; i < pieces; ++i) parts.chain.step(piece_s, parts.applied_kpa, parts.around);
  ++parts.samples;
  parts.sense();
}

double Plant::held_command_kpa() const noexcept {
  return parts_->command_kpa;
}
double Plant::reading_mm() const noexcept {
  return parts_->reading_mm;
}
double Plant::displacement_mm() const noexcept {
  return parts_->chain.after(model::Station::load);
}
double Plant::measured_pressure_kpa() const noexcept {
  return parts_->pressure_kpa;
}
double Plant::measured_temperature_c() const noexcept {
  return parts_->around.temperature_c +
         parts_->temperature_noise_c * normal_at(parts_->temperature_seed, parts_->samples);
}
double Plant::pressure_kpa() const noexcept {
  return parts_->chain.pressure_kpa();
}
bool Plant::sees_nothing() const noexcept {
  return parts_->sensor.kind == SensorFault::Kind::out_of_range;
}

void Plant::set_object(const std::optional<PlantObject>& object) noexcept {
  Parts& parts = *parts_;
  if (object == parts.object) return;
  parts.object = object;
  auto& place = std::get<Contact>(parts.chain.block(parts.place));
  const double output = place.output();
  place = contact_for(object);
  place.reset(output);
}

const std::optional<PlantObject>& Plant::object() const noexcept {
  return parts_->object;
}

void Plant::set_fault(const LineFault& fault) noexcept {
  parts_->line = fault;
  parts_->apply();
}

void Plant::set_fault(const SensorFault& fault) noexcept {
  parts_->sensor = fault;
  parts_->sense();
}

}  // namespace softgrip::simulation
