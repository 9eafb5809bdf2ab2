#include "sysid/structure/ladder.h"

#include "model/exponential.h"

namespace softgrip::sysid {
namespace {

/// Largest number of durations that are stored. Their weights need about 5 MB.
constexpr std::size_t most_durations = 16'384;

}  // namespace

LadderWeights::LadderWeights(const std::vector<double>& time_constants_s) {
  for (const double tau_s : time_constants_s) rates_hz_.push_back(1 / tau_s);
}

void LadderWeights::find(double duration_s) {
  if (index_.size() >= most_durations) {
    index_.clear();
    stored_.clear();
  }
  const auto [place, is_new] = index_.try_emplace(duration_s, stored_.size());
  last_s_ = duration_s;
  at_ = place->second;
  if (!is_new) return;
  stored_.resize(stored_.size() + pairs());
  for (std::size_t i = 0; i < rates_hz_.size(); ++i) {
    const auto w = model::ExponentialWeights<double>::make(duration_s, rates_hz_[i], rates_hz_[i]);
    PairWeights& pair = stored_[at_ + i / 2];
    pair.loss[i % 2] = w.loss;
    pair.begin[i % 2] = w.end_begin;
    pair.rise[i % 2] = w.end_rise;
    pair.bend[i % 2] = w.end_bend;
  }
}

}  // namespace softgrip::sysid
