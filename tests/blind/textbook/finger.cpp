#include "finger.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace textbook {
namespace {

constexpr std::array<double, 3> prony_tau_s{0.3, 6, 120};
constexpr std::size_t plays = 10, slips = 8;

// Returns the nominal stress of rubber in uniaxial tension, divided by the initial slope of the stress. The
// rubber is incompressible and follows the Mooney-Rivlin law with C2 = C1/4.
double rubber_stress(double stretch) noexcept {
  return 2 * (0.8 + 0.2 / stretch) * (stretch - 1 / (stretch * stretch)) / 6;
}

}  // namespace

const std::vector<std::string>& makes() {
  static const std::vector<std::string> all{"play", "maxwell_slip", "preisach", "hyperelastic_tube",
                                            "fractional"};
  return all;
}

std::vector<OwnNumber> own_numbers(const std::string& make) {
  const bool fractional = make == "fractional";
  return {{&FingerNumbers::width, 0.05, 0.15},
          {&FingerNumbers::curvature, -0.12, 0.12},
          {&FingerNumbers::creep, 0.08, 0.2},
          {&FingerNumbers::creep_tilt, fractional ? 0.1 : -0.1, fractional ? 0.25 : 0.1}};
}

FingerNumbers draw_finger(const std::string& make, std::uint64_t seed) {
  std::mt19937_64 random(seed * 7919 + 17);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  FingerNumbers n;
  n.make = make;
  n.span_mm = between(10, 25);
  for (const OwnNumber& own : own_numbers(make)) n.*own.member = between(own.low, own.high);
  n.envelope = between(0.05, 0.2);
  return n;
}

Finger::Finger(const FingerNumbers& numbers) : numbers_(numbers) {
  if (std::find(makes().begin(), makes().end(), numbers.make) == makes().end())
    throw std::invalid_argument("unknown make " + numbers.make);
  double sum = 0;
  for (std::size_t i = 0; i < branches; ++i) {
    tau_s_[i] = 0.02 * std::pow(10.0, static_cast<double>(i) / 3);
    weight_[i] = std::pow(tau_s_[i], numbers.creep_tilt);
    sum += weight_[i];
  }
  for (std::size_t i = 0; i < branches; ++i)
    weight_[i] *= tau_s_[i] > numbers.longest_creep_s ? 0 : numbers.creep / sum;
  if (numbers.make != "preisach") memory_.assign(numbers.make == "maxwell_slip" ? slips : plays, 0);
  for (std::size_t i = 0; i < slices; ++i) {
    stretch_[i] = 1;
    thickness_[i] = 1 + 0.15 * std::sin(2.1 * static_cast<double>(i) + 10 * numbers.envelope);
  }
  constexpr double long_s = 1e6;
  constexpr int stairs = 50;
  Finger held = *this;
  for (int i = 1; i <= 2 * stairs; ++i)
    full_ = held.raw(working_kpa * std::min(1.0, i * 1.0 / stairs), long_s);
}

// Generalised play (Krasnosel'skii and Pokrovskii). Both envelopes are the same nonlinear function, shifted
// in opposite directions.
double Finger::play(double q) noexcept {
  const double bent = q + numbers_.envelope * q * q * (1 - 0.5 * q);
  double sum = 0;
  for (std::size_t i = 0; i < plays; ++i) {
    const double r = numbers_.width * static_cast<double>(i) / plays * 3;
    memory_[i] = std::clamp(memory_[i], bent - r, bent + r);
    sum += memory_[i] / plays;
  }
  return sum;
}

// Maxwell-slip model: a spring in parallel with Coulomb elements, driven by the force q. Solves K y +
// sum(clamp(k (y - anchor), -f, f)) = q for the displacement y. K is the stiffness of the spring. Each
// Coulomb element has a stiffness k, a friction limit f and an anchor.
double Finger::maxwell_slip(double q) noexcept {
  constexpr double stiffness = 0.6 / slips;
  const auto limit = [this](std::size_t i) {
    return numbers_.width * static_cast<double>(i + 1) / (4.5 * slips);
  };
  for (int iteration = 0; iteration < 30; ++iteration) {
    double force = balance_ - q, slope = 1;
    for (std::size_t i = 0; i < slips; ++i) {
      const double elastic = stiffness * (balance_ - memory_[i]);
      force += std::clamp(elastic, -limit(i), limit(i));
      if (std::abs(elastic) < limit(i)) slope += stiffness;
    }
    balance_ -= force / slope;
    if (std::abs(force) < 1e-13) break;
  }
  for (std::size_t i = 0; i < slips; ++i) {
    const double reach = limit(i) / stiffness;
    memory_[i] = std::clamp(memory_[i], balance_ - reach, balance_ + reach);
  }
  return balance_;
}

// Preisach model: each relay switches on when the input rises above a, and off when it falls below b. Here 0
// <= b <= a, and the weight of a relay is 2 (1 + envelope b). The relays that are on lie below a stepped line
// in the (a, b) plane. The corners of this line are the turning points of the input that the model remembers:
// the highest maximum, the lowest minimum after it, the highest maximum after this minimum, and so on.
double Finger::preisach(double q) noexcept {
  const auto triangle = [this](double high, double low) {
    const double d = high - low;
    return d * d * (1 + numbers_.envelope * high - numbers_.envelope * d * 2 / 3);
  };
  q = std::max(0.0, q);
  const bool rising = q > input_;
  // While the input falls, the last entry of memory_ is a maximum. While the input rises, the last entry is a
  // minimum, or memory_ is empty.
  if (rising == (memory_.size() % 2 == 1)) memory_.push_back(input_);
  input_ = q;
  while (memory_.size() >= 2) {
    const double before =
        memory_[memory_.size() -
                2];  // if the input passes this earlier turning point, the last two turning points are erased
    if (rising ? q < before : q > before) break;
    memory_.resize(memory_.size() - 2);
  }
  double sum = 0, low = 0;
  for (std::size_t i = 0; i < memory_.size(); i += 2) {
    const double after = i + 1 < memory_.size() ? memory_[i + 1] : q;
    sum += triangle(memory_[i], low) - triangle(memory_[i], after);
    low = after;
  }
  if (memory_.size() % 2 == 0) sum += triangle(q, low);
  return (1 - 2 * numbers_.width) * q + 2 * numbers_.width * sum;
}

// A bending tube, divided into slices. The pressure acts on a cross-section that grows with the deformation.
// The viscoelastic rubber resists; a Prony series describes its relaxation.
double Finger::tube(double q, double step_s) noexcept {
  const double pull = 0.25 * std::max(0.0, q);
  double bend = 0;
  for (std::size_t i = 0; i < slices; ++i) {
    double held = 0;
    double total = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double part = prony_tau_s[k] > numbers_.longest_creep_s ? 0 : numbers_.creep / 2;
      held += part * relaxed_[i][k];
      total += part;
    }
    for (int iteration = 0; iteration < 20; ++iteration) {
      const auto balance = [&](double stretch) {
        return thickness_[i] * (total * rubber_stress(stretch) - held) -
               pull * (1 + numbers_.envelope * (stretch - 1));
      };
      const double miss = balance(stretch_[i]);
      if (std::abs(miss) < 1e-13) break;
      stretch_[i] -= miss / ((balance(stretch_[i] + 1e-6) - miss) / 1e-6);
    }
    for (std::size_t k = 0; k < 3; ++k)
      relaxed_[i][k] += (rubber_stress(stretch_[i]) - relaxed_[i][k]) * -std::expm1(-step_s / prony_tau_s[k]);
    bend += (stretch_[i] - 1) / slices;
  }
  return 2 * bend;
}

double Finger::creep(double q, double step_s) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < branches; ++i) {
    branch_[i] += (q - branch_[i]) * -std::expm1(-step_s / tau_s_[i]);
    sum += weight_[i] * branch_[i];
  }
  return sum;
}

double Finger::raw(double pressure_kpa, double step_s) {
  const double q = pressure_kpa / working_kpa;
  if (numbers_.make == "hyperelastic_tube") return 0.9 * tube(q, step_s) + 0.1 * play(q);
  const double elastic = numbers_.make == "maxwell_slip" ? maxwell_slip(q)
                         : numbers_.make == "preisach"   ? preisach(q)
                                                         : play(q);
  return elastic + creep(q, step_s);
}

double Finger::step(double pressure_kpa, double step_s) {
  const double z = raw(pressure_kpa, step_s) / full_;
  return numbers_.span_mm * z * (1 + numbers_.curvature * (z - 1));
}

}  // namespace textbook
