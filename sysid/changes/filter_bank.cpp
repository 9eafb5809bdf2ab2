#include "sysid/changes/filter_bank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace softgrip::sysid {
namespace {

using Values = std::vector<double>;

template <class F>
Values each(const Values& x, F&& f) {
  Values y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = f(i, x[i]);
  return y;
}

Values play(const Values& x, double threshold) {
  double z = 0;
  return each(x, [&](std::size_t, double v) { return z = std::clamp(z, v - threshold, v + threshold); });
}

/// Returns the rate of x as the change during 0.1 s.
Values rate(const Record& record, const Values& x) {
  return each(x, [&](std::size_t i, double v) {
    return i > 0 && record.duration_s[i] > 0 ? 0.1 * (v - x[i - 1]) / record.duration_s[i] : 0;
  });
}

std::vector<Values> valve_signals(const Record& record, const Values& u, double largest_kpa) {
  const Values rising = rate(record, u);
  const Values behind = lagged(record, u, 0.05);
  const auto share = [&](double v) { return v / largest_kpa; };
  const Values miss = each(u, [&](std::size_t i, double v) { return v - behind[i]; });
  const auto within = [](double v, double bound) { return std::clamp(v, -bound, bound); };
  std::vector<Values> all{u, play(u, 0.0025 * largest_kpa)};
  all.push_back(each(u, [&](std::size_t, double v) { return v * share(v); }));
  all.push_back(each(u, [&](std::size_t, double v) { return v * share(v) * share(v); }));
  all.push_back(each(rising, [](std::size_t, double v) { return std::max(v, 0.0); }));
  all.push_back(each(rising, [&](std::size_t i, double v) { return std::max(v, 0.0) * share(u[i]); }));
  all.push_back(each(rising, [&](std::size_t i, double v) { return v * share(u[i]); }));
  all.push_back(each(miss, [](std::size_t, double v) { return std::abs(v); }));
  for (const double part : {0.017, 0.05, 0.13, 0.33})
    all.push_back(each(miss, [&](std::size_t, double v) { return within(v, part * largest_kpa); }));
  for (const double part : {0.05, 0.13}) {
    all.push_back(
        each(miss, [&](std::size_t i, double v) { return within(v, part * largest_kpa) * share(u[i]); }));
  }
  all.push_back(each(miss, [&](std::size_t i, double v) { return std::abs(v) * share(u[i]); }));
  const bool known = !record.supply_kpa.empty();
  const double usual = known ? *std::max_element(record.supply_kpa.begin(), record.supply_kpa.end()) : 0;
  const auto loss = [&](std::size_t i) { return usual > 0 ? record.supply_kpa[i] / usual - 1 : 0; };
  all.push_back(each(u, [&](std::size_t i, double v) { return v * loss(i); }));
  all.push_back(each(miss, [&](std::size_t i, double v) { return within(v, 0.05 * largest_kpa) * loss(i); }));
  return all;
}

std::vector<Values> finger_signals(const Values& u, double largest_kpa) {
  const auto squared = [&](const Values& x) {
    return each(x, [&](std::size_t, double v) { return v * v / largest_kpa; });
  };
  std::vector<Values> all{u, squared(u)};
  all.push_back(each(u, [&](std::size_t, double v) { return v * v * v / (largest_kpa * largest_kpa); }));
  for (const double part : {0.02, 0.06, 0.12, 0.22, 0.35, 0.5}) {
    all.push_back(play(u, part * largest_kpa));
    all.push_back(squared(all.back()));
  }
  return all;
}

/// A list of signals. Filters with all time constants in `lags_s` are applied to each signal.
struct SignalBank {
  std::vector<Values> signals;
  std::span<const double> lags_s;
};

std::vector<SignalBank> banks(const Record& record, const Values& drive_kpa, FilterKind kind,
                              double largest_kpa) {
  std::vector<SignalBank> all;
  if (kind != FilterKind::valve) all.push_back({finger_signals(drive_kpa, largest_kpa), finger_lags_s});
  if (kind != FilterKind::finger)
    all.push_back({valve_signals(record, drive_kpa, largest_kpa),
                   std::span(valve_lags_s).subspan(kind == FilterKind::valve ? 0 : 1)});
  return all;
}

}  // namespace

std::vector<double> lagged(const Record& record, const std::vector<double>& signal, double time_constant_s) {
  if (time_constant_s == 0) return signal;
  std::vector<double> out(signal.size(), signal.front());
  double last_s = -1, keep = 0, mean = 0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double dt = record.duration_s[i];
    if (dt != last_s) {
      keep = std::exp(-dt / time_constant_s);
      mean = dt > 0 ? (1 - keep) * time_constant_s / dt : 1;
      last_s = dt;
    }
    out[i] = keep * out[i - 1] + (mean - keep) * signal[i - 1] + (1 - mean) * signal[i];
  }
  return out;
}

Eigen::MatrixXd filter_columns(const Record& record, const std::vector<double>& drive_kpa, FilterKind kind,
                               double largest_kpa) {
  const std::vector<SignalBank> all = banks(record, drive_kpa, kind, largest_kpa);
  std::size_t count = 0;
  for (const SignalBank& bank : all) count += bank.signals.size() * bank.lags_s.size();
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(record.size()), static_cast<Eigen::Index>(count));
  Eigen::Index column = 0;
  for (const SignalBank& bank : all) {
    for (const Values& signal : bank.signals) {
      for (const double lag_s : bank.lags_s) {
        const Values filtered = lagged(record, signal, lag_s);
        columns.col(column++) = Eigen::Map<const Eigen::VectorXd>(filtered.data(), columns.rows());
      }
    }
  }
  return columns;
}

Eigen::VectorXd weighted_filters(const Record& record, const std::vector<double>& drive_kpa, FilterKind kind,
                                 double largest_kpa, const Eigen::VectorXd& weights) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(record.size()));
  Eigen::Index first = 0;
  for (const SignalBank& bank : banks(record, drive_kpa, kind, largest_kpa)) {
    const auto lags = static_cast<Eigen::Index>(bank.lags_s.size());
    for (Eigen::Index l = 0; l < lags; ++l) {
      Values mixed(record.size(), 0.0);
      for (std::size_t s = 0; s < bank.signals.size(); ++s) {
        const double weight = weights(first + static_cast<Eigen::Index>(s) * lags + l);
        for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] += weight * bank.signals[s][i];
      }
      const Values filtered = lagged(record, mixed, bank.lags_s[static_cast<std::size_t>(l)]);
      sum += Eigen::Map<const Eigen::VectorXd>(filtered.data(), sum.size());
    }
    first += static_cast<Eigen::Index>(bank.signals.size()) * lags;
  }
  return sum;
}

}  // namespace softgrip::sysid
