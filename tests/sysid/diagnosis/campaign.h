#pragma once
// Creates records with known commands for tests. Creates residuals with known properties that match these
// records.

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns `logs` records. Each record lasts one minute and is sampled at 50 Hz. The commands consist of
/// triangles with several amplitudes and rates, of holds and of rests.
inline std::vector<Record> known_campaign(std::size_t logs) {
  std::vector<Record> records;
  double largest = 0;
  for (std::size_t k = 0; k < logs; ++k) {
    Record r;
    r.name = "log_" + std::to_string(k + 1);
    r.sample_time_s = 0.02;
    r.finest_interval_s = 0.02;
    r.campaign_time_s = 60.0 * static_cast<double>(k);
    r.largest_before_kpa = largest;
    for (std::size_t i = 0; i < 3000; ++i) {
      const double t = 0.02 * static_cast<double>(i);
      const auto cycle = static_cast<std::size_t>(t / 10);
      const double peak = 20.0 + 5.0 * static_cast<double>((cycle + k) % 5);
      const double rise_s = cycle % 2 == 0 ? 1.0 : 2.5;
      const double phase = t - 10 * static_cast<double>(cycle);
      // Each cycle of the command consists of a rise, a hold of 2 s, a fall and a rest.
      double p = 0;
      if (phase < rise_s) {
        p = peak * phase / rise_s;
      } else if (phase < rise_s + 2) {
        p = peak;
      } else if (phase < 2 * rise_s + 2) {
        p = peak * (2 * rise_s + 2 - phase) / rise_s;
      }
      r.time_s.push_back(t);
      r.duration_s.push_back(i == 0 ? 0 : 0.02);
      r.drive_kpa.push_back(p);
      r.reading_mm.push_back(0.4 * p);
      r.largest_kpa = std::max(r.largest_kpa, p);
    }
    r.readings = r.size();
    r.span_mm = 0.4 * r.largest_kpa;
    largest = std::max(largest, r.largest_kpa);
    records.push_back(std::move(r));
  }
  return records;
}

using ByRecord = std::vector<std::vector<double>>;

inline ByRecord readings_of(const std::vector<Record>& records) {
  ByRecord readings;
  for (const Record& r : records) readings.push_back(r.reading_mm);
  return readings;
}

/// Returns noise with a given standard deviation for each record. `correlation` is the correlation between
/// one sample and the next.
inline ByRecord noise_for(const std::vector<Record>& records, double deviation, double correlation,
                          std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ByRecord noise;
  for (const Record& r : records) {
    std::vector<double>& n = noise.emplace_back();
    double state = normal(random);
    for (std::size_t i = 0; i < r.size(); ++i) {
      n.push_back(deviation * state);
      state = correlation * state + std::sqrt(1 - correlation * correlation) * normal(random);
    }
  }
  return noise;
}

}  // namespace softgrip::sysid
