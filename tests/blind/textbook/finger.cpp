#include "finger.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace textbook {
namespace {

constexpr std::array<double, 3> prony_tau_s{0.3, 6, 120};
constexpr std::size_t plays = 10, slips = 8, columns = 240;

// Mooney-Rivlin, uniaxial, incompressible, nominal stress over its initial slope of 3 (C1 + C2) ... C2 =
// C1/4.
double rubber_stress(double stretch) noexcept {
  return 2 * (0.8 + 0.2 / stretch) * (stretch - 1 / (stretch * stretch)) / 6;
}

}  // namespace

const std::vector<std::string>& makes() {
  static const std::vector<std::string> all{"play", "maxwell_slip", "preisach", "hyperelastic_tube",
                                            "fractional"};
  return all;
}

FingerNumbers draw_finger(const std::string& make, std::uint64_t seed) {
  std::mt19937_64 random(seed * 7919 + 17);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  FingerNumbers n;
  n.make = make;
  n.span_mm = between(10, 25);
  n.width = between(0.05, 0.15);
  n.curvature = between(-0.12, 0.12);
  n.creep = between(0.08, 0.2);
  n.creep_tilt = make == "fractional" ? between(0.1, 0.25) : between(-0.1, 0.1);
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
  for (double& w : weight_) w *= numbers.creep / sum;
  memory_.assign(numbers.make == "preisach" ? columns : numbers.make == "maxwell_slip" ? slips : plays, 0);
  if (numbers.make == "preisach")
    for (std::size_t i = 0; i < columns; ++i) memory_[i] = static_cast<double>(i) * 1.1 / columns;
  for (std::size_t i = 0; i < slices; ++i) {
    stretch_[i] = 1;
    thickness_[i] = 1 + 0.15 * std::sin(2.1 * static_cast<double>(i) + 10 * numbers.envelope);
  }
}

// Generalised play (Krasnosel'skii and Pokrovskii): both envelopes are the same bent function, shifted.
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

// A spring in parallel with Coulomb elements, driven by force: K y + sum clamp(k (y - anchor), +-f) = q.
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

// Relays that switch on at a and off at b <= a. Columns of one b hold the highest a that is on.
double Finger::preisach(double q) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const double off = static_cast<double>(i) * 1.1 / columns;
    memory_[i] = q <= off ? off : std::max(memory_[i], q);
    sum += (memory_[i] - off) * (1 + numbers_.envelope * off) * 2 * 1.1 / columns;
  }
  return (1 - 2 * numbers_.width) * q + 2 * numbers_.width * sum;
}

// Slices of a tube that bends: pressure on a section that grows against rubber with a Prony series.
double Finger::tube(double q, double step_s) noexcept {
  const double pull = 0.25 * std::max(0.0, q);
  double bend = 0;
  for (std::size_t i = 0; i < slices; ++i) {
    double held = 0;
    const double part = numbers_.creep / 2;
    for (const double h : relaxed_[i]) held += part * h;
    const double total = 1 + 3 * part;
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

double Finger::step(double pressure_kpa, double step_s) {
  const double q = pressure_kpa / working_kpa;
  double z = 0;
  if (numbers_.make == "maxwell_slip")
    z = maxwell_slip(q);
  else if (numbers_.make == "preisach")
    z = preisach(q);
  else if (numbers_.make == "hyperelastic_tube")
    z = 0.9 * tube(q, step_s) + 0.1 * play(q);
  else
    z = play(q);
  if (numbers_.make != "hyperelastic_tube") z += creep(q, step_s);
  return numbers_.span_mm * z * (1 + numbers_.curvature * (z - 1));
}

}  // namespace textbook
