#include "sysid/changes/filter_bank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "sysid/changes/bins.h"

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

std::size_t columns_of(const std::vector<SignalBank>& all) {
  std::size_t count = 0;
  for (const SignalBank& bank : all) count += bank.signals.size() * bank.lags_s.size();
  return count;
}

/// Weights of the last output, the last input and the present input in the output of a lag.
struct LagWeights {
  double output = 0, before = 0, now = 1;  ///< values for the time constant 0
};
LagWeights lag_weights(double dt_s, double time_constant_s) {
  if (time_constant_s == 0) return {};
  const double keep = std::exp(-dt_s / time_constant_s);
  const double mean = dt_s > 0 ? (1 - keep) * time_constant_s / dt_s : 1;
  return {keep, mean - keep, 1 - mean};
}

/// All filters of a bank, advanced together sample by sample. The outputs have the order of the columns.
class FilterWalk {
 public:
  explicit FilterWalk(const SignalBank& bank)
      : bank_(bank),
        output_(static_cast<Eigen::Index>(bank.lags_s.size())),
        before_(output_.size()),
        now_(output_.size()),
        outputs_(output_.size(), static_cast<Eigen::Index>(bank.signals.size())) {
    Eigen::Index column = 0;
    for (const Values& signal : bank.signals) outputs_.col(column++).setConstant(signal.front());
  }

  /// Computes the outputs at sample i >= 1.
  void step(std::size_t i, double dt_s) {
    if (dt_s != last_s_) {
      Eigen::Index l = 0;
      for (const double lag_s : bank_.lags_s) {
        const LagWeights weights = lag_weights(dt_s, lag_s);
        output_(l) = weights.output;
        before_(l) = weights.before;
        now_(l++) = weights.now;
      }
      last_s_ = dt_s;
    }
    Eigen::Index column = 0;
    for (const Values& signal : bank_.signals) {
      auto out = outputs_.col(column++);
      out = output_ * out + before_ * signal[i - 1] + now_ * signal[i];
    }
  }
  /// Returns the outputs: one row per time constant and one column per signal.
  [[nodiscard]] const Eigen::ArrayXXd& outputs() const { return outputs_; }

 private:
  const SignalBank& bank_;
  Eigen::ArrayXd output_, before_, now_;  ///< weights of the last duration, by time constant
  Eigen::ArrayXXd outputs_;
  double last_s_ = -1;
};

/// Averages the outputs of a bank over bins. The columns of `means` are the outputs.
void average(const Record& record, const SignalBank& bank, double bin_s, Eigen::Ref<Eigen::MatrixXd> means) {
  FilterWalk walk(bank);
  Eigen::ArrayXXd sums = Eigen::ArrayXXd::Zero(walk.outputs().rows(), walk.outputs().cols());
  Eigen::Index open = 0;
  double count = 0;
  const auto close = [&] {
    if (count > 0) means.row(open) = (sums / count).reshaped().transpose();
    sums.setZero();
    count = 0;
  };
  for (std::size_t i = 0; i < record.size(); ++i) {
    const Eigen::Index bin = std::min(static_cast<Eigen::Index>(bin_of(record, i, bin_s)), means.rows() - 1);
    if (bin != open) close();
    open = bin;
    if (i > 0) walk.step(i, record.duration_s[i]);
    sums += walk.outputs();
    count += 1;
  }
  close();
}

}  // namespace

std::vector<double> lagged(const Record& record, const std::vector<double>& signal, double time_constant_s) {
  if (time_constant_s == 0) return signal;
  std::vector<double> out(signal.size(), signal.front());
  double last_s = -1;
  LagWeights weights;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double dt = record.duration_s[i];
    if (dt != last_s) weights = lag_weights(dt, time_constant_s);
    last_s = dt;
    out[i] = weights.output * out[i - 1] + weights.before * signal[i - 1] + weights.now * signal[i];
  }
  return out;
}

Eigen::MatrixXd filter_columns(const Record& record, const std::vector<double>& drive_kpa, FilterKind kind,
                               double largest_kpa) {
  const std::vector<SignalBank> all = banks(record, drive_kpa, kind, largest_kpa);
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(record.size()),
                          static_cast<Eigen::Index>(columns_of(all)));
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

Eigen::MatrixXd binned_filter_columns(const Record& record, const std::vector<double>& drive_kpa,
                                      FilterKind kind, double largest_kpa, double bin_s) {
  const std::vector<SignalBank> all = banks(record, drive_kpa, kind, largest_kpa);
  Eigen::MatrixXd means = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(bin_count(record, bin_s)),
                                                    static_cast<Eigen::Index>(columns_of(all)),
                                                    std::numeric_limits<double>::quiet_NaN());
  Eigen::Index first = 0;
  for (const SignalBank& bank : all) {
    const auto columns = static_cast<Eigen::Index>(bank.signals.size() * bank.lags_s.size());
    average(record, bank, bin_s, means.middleCols(first, columns));
    first += columns;
  }
  return means;
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
