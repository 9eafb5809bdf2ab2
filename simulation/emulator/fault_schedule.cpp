#include "simulation/emulator/fault_schedule.h"

#include <algorithm>

#include "base/time.h"

namespace softgrip::simulation {

FaultSchedule::FaultSchedule(std::vector<FaultSpec> faults)
    : faults_(std::move(faults)), states_(faults_.size()) {}

void FaultSchedule::start(Nanoseconds now) {
  if (!started_at_) started_at_ = now;
}

bool FaultSchedule::advance(Nanoseconds now) {
  bool changed = false;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const auto begins = begins_at(i);
    if (begins && *begins <= now) {
      states_[i].spent = true;
      begin(i, *begins);
      changed = true;
    }
    const auto ends = ends_at(i);
    if (ends && *ends <= now) {
      states_[i].active = false;
      changed = true;
    }
  }
  return changed;
}

std::optional<Nanoseconds> FaultSchedule::next_change() const {
  std::optional<Nanoseconds> next;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    for (const auto& moment : {begins_at(i), ends_at(i)}) {
      if (moment) next = next ? std::min(*next, *moment) : *moment;
    }
  }
  return next;
}

bool FaultSchedule::trigger(std::string_view name, Nanoseconds now) {
  const auto index = find(name);
  if (index) begin(*index, now);
  return index.has_value();
}

bool FaultSchedule::clear(std::string_view name) {
  const auto index = find(name);
  if (index) {
    states_[*index].active = false;
    states_[*index].spent = true;
  }
  return index.has_value();
}

void FaultSchedule::count_reply(std::size_t index) {
  State& state = states_[index];
  ++state.replies;
  if (faults_[index].replies && state.replies >= *faults_[index].replies) state.active = false;
}

std::optional<std::size_t> FaultSchedule::first_active(FaultKind kind) const {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (states_[i].active && faults_[i].kind == kind) return i;
  }
  return std::nullopt;
}

void FaultSchedule::begin(std::size_t index, Nanoseconds now) {
  State& state = states_[index];
  state.active = true;
  state.since = now;
  state.replies = 0;
}

std::optional<Nanoseconds> FaultSchedule::begins_at(std::size_t index) const {
  const State& state = states_[index];
  if (!started_at_ || !faults_[index].at_s || state.spent) return std::nullopt;
  return *started_at_ + nanoseconds(*faults_[index].at_s);
}

std::optional<Nanoseconds> FaultSchedule::ends_at(std::size_t index) const {
  const State& state = states_[index];
  if (!state.active || !faults_[index].for_s) return std::nullopt;
  return state.since + nanoseconds(*faults_[index].for_s);
}

std::optional<std::size_t> FaultSchedule::find(std::string_view name) const {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (faults_[i].name == name) return i;
  }
  return std::nullopt;
}

}  // namespace softgrip::simulation
