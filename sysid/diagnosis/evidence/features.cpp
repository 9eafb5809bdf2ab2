#include "sysid/diagnosis/evidence/features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace softgrip::sysid {
namespace {

constexpr std::array<double, 4> lags_s{0.05, 0.1, 0.2, 0.4};
constexpr std::array<double, 7> averages_s{0.3, 1, 3, 10, 30, 100, 300};
/// Dwells count by their logarithm from here on.
constexpr double shortest_s = 0.02;

using ByRecord = std::vector<std::vector<double>>;

/// Value of `values` a while before every sample, straight between samples; the first value before the log.
std::vector<double> delayed(const Record& record, const std::vector<double>& values, double lag_s) {
  std::vector<double> result(record.size());
  std::size_t j = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double at_s = record.time_s[i] - lag_s;
    while (j + 1 < record.size() && record.time_s[j + 1] <= at_s) ++j;
    if (at_s <= record.time_s.front()) {
      result[i] = values.front();
    } else {
      const double share = (at_s - record.time_s[j]) / (record.time_s[j + 1] - record.time_s[j]);
      result[i] = values[j] + share * (values[j + 1] - values[j]);
    }
  }
  return result;
}

/// First-order average of the drive; `state` carries it from record to record.
std::vector<double> averaged(const Record& record, double tau_s, double& state) {
  std::vector<double> result(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    state += (record.drive_kpa[i] - state) * -std::expm1(-record.duration_s[i] / tau_s);
    result[i] = state;
  }
  return result;
}

std::vector<double> slope(const Record& record, const std::vector<double>& values) {
  const std::vector<double> before = delayed(record, values, 0.1);
  std::vector<double> result(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) result[i] = (values[i] - before[i]) / 0.1;
  return result;
}

class Builder {
 public:
  Builder(const std::vector<Record>& records, const Samples& samples)
      : records_(records), samples_(samples) {}

  void group(std::string id, std::string phrase) {
    features_.groups.push_back({std::move(id), std::move(phrase), {}});
  }
  void add(const ByRecord& values) {
    features_.groups.back().columns.push_back(features_.columns.size());
    features_.columns.push_back(pooled(samples_, values));
  }
  /// One column from a function of (record, its number).
  template <class Make>
  void each(Make&& make) {
    ByRecord values;
    for (std::size_t k = 0; k < records_.size(); ++k) values.push_back(make(records_[k], k));
    add(values);
  }
  Features take() { return std::move(features_); }

 private:
  const std::vector<Record>& records_;
  const Samples& samples_;
  Features features_;
};

void add_pressure(Builder& b, const std::vector<DriveHistory>& h, double campaign_s) {
  b.group("pressure", "the pressure and its rate");
  b.each([](const Record& r, std::size_t) { return r.drive_kpa; });
  b.each([&](const Record&, std::size_t k) { return h[k].rate_kpa_per_s; });
  b.group("recent_pressure", "the pressure of the last 0.4 s");
  for (const double lag : lags_s) {
    b.each([&](const Record& r, std::size_t) {
      std::vector<double> change = delayed(r, r.drive_kpa, lag);
      for (std::size_t i = 0; i < change.size(); ++i) change[i] = r.drive_kpa[i] - change[i];
      return change;
    });
  }
  b.group("slow_pressure", "the pressure over the last seconds and minutes");
  for (const double tau : averages_s) {
    if (tau > campaign_s) continue;
    double state = 0;
    b.each([&](const Record& r, std::size_t) { return averaged(r, tau, state); });
  }
}

void add_turns(Builder& b, const std::vector<DriveHistory>& h) {
  b.group("turning_points", "where and when the pressure last turned or stopped");
  b.each([&](const Record&, std::size_t k) {
    std::vector<double> t = h[k].since_turn_s;
    for (double& v : t) v = std::log(std::max(v, shortest_s));
    return t;
  });
  b.each([&](const Record&, std::size_t k) { return h[k].turn_kpa; });
  b.each([&](const Record&, std::size_t k) {
    std::vector<double> amplitude = h[k].amplitude_kpa;
    for (double& v : amplitude) v = std::isfinite(v) ? v : 0;
    return amplitude;
  });
  b.each([&](const Record&, std::size_t k) {
    // How long the last rest was: an actuator may recover in it.
    std::vector<double> rests;
    double last_s = 0;
    for (std::size_t i = 0; i < h[k].branch.size(); ++i) {
      if (h[k].branch[i] == Branch::rest) last_s = h[k].dwell_s[i];
      rests.push_back(std::log(std::max(last_s, shortest_s)));
    }
    return rests;
  });
  b.each([&](const Record&, std::size_t k) {
    std::vector<double> branch;
    for (const Branch one : h[k].branch)
      branch.push_back(one == Branch::loading ? 1 : one == Branch::unloading ? -1 : 0);
    return branch;
  });
}

bool varies(const std::vector<Record>& records, std::vector<double> Record::*column) {
  double low = 1e300, high = -1e300;
  for (const Record& r : records) {
    if ((r.*column).empty()) return false;
    for (const double v : r.*column) {
      if (!std::isfinite(v)) return false;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  return high - low > 1e-6 * std::max(1.0, std::abs(high));
}

}  // namespace

Features features_of(const std::vector<Record>& records, const ByRecord& prediction_mm,
                     const Samples& samples) {
  std::vector<DriveHistory> h;
  double campaign_s = 0;
  for (const Record& record : records) {
    h.push_back(history_of(record));
    campaign_s += record.length_s();
  }
  Builder b(records, samples);
  add_pressure(b, h, campaign_s);
  add_turns(b, h);
  b.group("displacement", "the displacement that the model expects and its rate");
  b.add(prediction_mm);
  b.each([&](const Record& r, std::size_t k) { return slope(r, prediction_mm[k]); });
  b.group("largest_load", "the largest load so far");
  b.each([&](const Record&, std::size_t k) { return h[k].largest_kpa; });
  b.group("campaign_time", "the time in the campaign");
  b.each([](const Record& r, std::size_t) {
    std::vector<double> t = r.time_s;
    for (double& v : t) v += r.campaign_time_s;
    return t;
  });
  if (varies(records, &Record::temperature_c)) {
    b.group("temperature", "the temperature");
    b.each([](const Record& r, std::size_t) { return r.temperature_c; });
  }
  if (varies(records, &Record::supply_kpa)) {
    b.group("supply", "the supply pressure");
    b.each([](const Record& r, std::size_t) { return r.supply_kpa; });
  }
  return b.take();
}

}  // namespace softgrip::sysid
