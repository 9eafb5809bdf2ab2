#include "daemon/recording/event_log.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "control/elements/model_health.h"
#include "control/tick/sequence.h"
#include "daemon/recording/csv_row.h"

namespace softgrip::daemon {

namespace {

using control::Event;
using Kind = control::Event::Kind;

constexpr std::uint8_t whole_rig = 0xff;

void describe_state(const Event& event, EventEntry& entry) {
  entry.code = control::name_of(static_cast<control::State>(event.detail));
  entry.text = fmt::format("The state is now {}.", entry.code);
}

void describe_fault(const Event& event, EventEntry& entry) {
  const control::FaultInfo& info = control::info_of(static_cast<control::FaultCode>(event.detail));
  entry.code = info.id;
  entry.text = fmt::format("Fault {} {}: {}", info.id, info.name, info.meaning);
  entry.severity = Severity::error;
}

void describe_acknowledged(const Event& event, EventEntry& entry) {
  const control::FaultInfo& info = control::info_of(static_cast<control::FaultCode>(event.detail));
  entry.code = info.id;
  entry.text = fmt::format("Fault {} {} was acknowledged.", info.id, info.name);
}

void describe_step(const Event& event, const control::PreparedSequence* sequence, EventEntry& entry) {
  entry.code = fmt::format("{}", event.detail);
  const bool known = sequence != nullptr && event.detail < sequence->steps.size();
  const control::Step* step = known ? &sequence->steps[event.detail].step : nullptr;
  entry.text = step != nullptr ? fmt::format("Step {} begins: {}.", event.detail, step->name)
                               : fmt::format("Step {} begins.", event.detail);
}

void describe_result(const Event& event, EventEntry& entry) {
  const auto result = static_cast<control::GripResult>(event.detail);
  entry.code = control::title_of(result);
  entry.text = fmt::format("The grip's result is {}.", entry.code);
  const bool bad = result == control::GripResult::part_lost || result == control::GripResult::error;
  entry.severity = bad ? Severity::warning : Severity::information;
}

void describe_refusal(const Event& event, EventEntry& entry) {
  const auto refusal = static_cast<control::RefusalCode>(event.detail);
  entry.code = control::id_of(refusal);
  entry.text = fmt::format("The request was refused: {}.", control::name_of(refusal));
  entry.severity = Severity::warning;
}

void describe_health(const Event& event, EventEntry& entry) {
  const auto health = static_cast<control::HealthState>(event.detail);
  entry.code = control::name_of(health);
  entry.text = fmt::format("The model is now {} (residual {:.3g} mm RMS).", entry.code, event.value);
  const bool good = health == control::HealthState::healthy || health == control::HealthState::unknown;
  entry.severity = good ? Severity::information : Severity::warning;
}

std::string quoted_name(const control::PreparedSequence* sequence) {
  return sequence != nullptr ? fmt::format(" '{}'", sequence->name) : std::string();
}

void describe_start(const control::PreparedSequence* sequence, EventEntry& entry) {
  entry.code = sequence != nullptr ? sequence->name : "";
  entry.text = fmt::format("The sequence{} begins.", quoted_name(sequence));
}

void describe_end(const Event& event, const control::PreparedSequence* sequence, EventEntry& entry) {
  entry.code = control::name_of(static_cast<control::SequenceEnd>(event.detail));
  entry.text = fmt::format("The sequence{} ended: {}.", quoted_name(sequence), entry.code);
}

}  // namespace

EventEntry describe(const Event& event, const std::vector<std::string>& channel_names,
                    const control::PreparedSequence* sequence) {
  EventEntry entry;
  entry.kind = name_of(event.kind);
  entry.request = event.request;
  entry.value = event.value;
  if (event.channel != whole_rig && event.channel < channel_names.size())
    entry.channel = channel_names[event.channel];
  switch (event.kind) {
    case Kind::state_changed:
      describe_state(event, entry);
      break;
    case Kind::fault_latched:
      describe_fault(event, entry);
      break;
    case Kind::fault_acknowledged:
      describe_acknowledged(event, entry);
      break;
    case Kind::sequence_started:
      describe_start(sequence, entry);
      break;
    case Kind::sequence_finished:
      describe_end(event, sequence, entry);
      break;
    case Kind::step_started:
      describe_step(event, sequence, entry);
      break;
    case Kind::grip_result:
      describe_result(event, entry);
      break;
    case Kind::request_refused:
      describe_refusal(event, entry);
      break;
    case Kind::model_health_changed:
      describe_health(event, entry);
      break;
    case Kind::reading_invalid:
      entry.code = name_of(static_cast<model::Validity>(event.detail));
      entry.text = fmt::format("The reading is not valid: {}.", entry.code);
      entry.severity = Severity::warning;
      break;
    case Kind::reading_valid:
      entry.text = "The reading is valid again.";
      break;
  }
  if (!entry.channel.empty()) entry.text = fmt::format("{}: {}", entry.channel, entry.text);
  return entry;
}

EventEntry describe(const BusEvent& event) {
  EventEntry entry;
  entry.kind = name_of(event.kind);
  const std::string_view detail(event.detail.data());
  const std::string_view separator = detail.empty() ? "" : ": ";
  switch (event.kind) {
    case BusEvent::Kind::connected:
      entry.text = "A session with the board is up.";
      break;
    case BusEvent::Kind::failed:
      entry.code = drivers::name_of(event.status);
      entry.text = fmt::format("The exchange with the board failed: {}{}{}.", entry.code, separator, detail);
      entry.severity = Severity::error;
      break;
    case BusEvent::Kind::recovered:
      entry.text = "The board answers again.";
      break;
    case BusEvent::Kind::loop_silent:
      entry.text = "No commands from the loop: the safe outputs are written.";
      entry.severity = Severity::error;
      break;
    case BusEvent::Kind::loop_back:
      entry.text = "The loop's commands are written again.";
      break;
  }
  return entry;
}

std::string_view name_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::state_changed:
      return "state_changed";
    case Kind::fault_latched:
      return "fault_latched";
    case Kind::fault_acknowledged:
      return "fault_acknowledged";
    case Kind::sequence_started:
      return "sequence_started";
    case Kind::sequence_finished:
      return "sequence_finished";
    case Kind::step_started:
      return "step_started";
    case Kind::grip_result:
      return "grip_result";
    case Kind::request_refused:
      return "request_refused";
    case Kind::model_health_changed:
      return "model_health_changed";
    case Kind::reading_invalid:
      return "reading_invalid";
    case Kind::reading_valid:
      return "reading_valid";
  }
  return "?";
}

std::string_view name_of(BusEvent::Kind kind) noexcept {
  switch (kind) {
    case BusEvent::Kind::connected:
      return "bus_connected";
    case BusEvent::Kind::failed:
      return "bus_failed";
    case BusEvent::Kind::recovered:
      return "bus_recovered";
    case BusEvent::Kind::loop_silent:
      return "loop_silent";
    case BusEvent::Kind::loop_back:
      return "loop_back";
  }
  return "?";
}

std::string_view name_of(Severity severity) noexcept {
  switch (severity) {
    case Severity::information:
      return "information";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "?";
}

std::uint64_t EventLog::add(EventEntry entry) {
  const std::scoped_lock lock(mutex_);
  entry.id = ++last_id_;
  entries_.push_back(std::move(entry));
  if (entries_.size() > capacity_) entries_.pop_front();
  return last_id_;
}

std::vector<EventEntry> EventLog::since(std::uint64_t id, std::size_t limit) const {
  const std::scoped_lock lock(mutex_);
  const auto first =
      std::find_if(entries_.begin(), entries_.end(), [id](const EventEntry& entry) { return entry.id > id; });
  const auto count = std::min<std::size_t>(limit, static_cast<std::size_t>(entries_.end() - first));
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

std::uint64_t EventLog::newest() const {
  const std::scoped_lock lock(mutex_);
  return last_id_;
}

}  // namespace softgrip::daemon
