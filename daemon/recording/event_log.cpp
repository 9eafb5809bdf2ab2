#include "daemon/recording/event_log.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/enum_table.h"
#include "base/numbers.h"
#include "control/elements/fault.h"
#include "control/elements/model_health.h"
#include "daemon/recording/csv_row.h"

namespace softgrip::daemon {

namespace {

using control::Event;
using Kind = control::Event::Kind;

/// Kind, severity and text of an event whose text is constant.
struct Words {
  std::string_view kind;
  Severity severity;
  std::string_view text;
};
using enum Severity;

constexpr auto bus_words = enum_table<BusEvent::Kind, Words>({
    {BusEvent::Kind::connected,
     {"bus_connected", information, "Connected to the board: the board responds."}},
    {BusEvent::Kind::failed, {"bus_failed", error, ""}},
    {BusEvent::Kind::recovered, {"bus_recovered", information, "Communication with the board restored."}},
    {BusEvent::Kind::loop_silent,
     {"loop_silent", error,
      "Command time-out: the control loop sends no commands, so the safe outputs are written."}},
    {BusEvent::Kind::loop_back,
     {"loop_back", information,
      "Commands resumed: the commands of the control loop are written to the board again."}},
    {BusEvent::Kind::another_client, {"another_client", warning, ""}},
    {BusEvent::Kind::not_connected, {"bus_not_connected", error, ""}},
});

constexpr auto panel_words = enum_table<PanelEvent::Kind, Words>({
    {PanelEvent::Kind::emergency_stop_pressed,
     {"emergency_stop_pressed", warning, "The emergency stop is pressed."}},
    {PanelEvent::Kind::emergency_stop_released,
     {"emergency_stop_released", information,
      "The emergency stop is released. `softgrip acknowledge` makes the rig ready."}},
    {PanelEvent::Kind::part_in_position, {"part_in_position", information, "A part is in position."}},
    {PanelEvent::Kind::part_away, {"part_away", information, "No part is in position."}},
    {PanelEvent::Kind::enable_on, {"enable_on", information, "The enable output is on."}},
    {PanelEvent::Kind::enable_off, {"enable_off", information, "The enable output is off."}},
    {PanelEvent::Kind::loop_hangs,
     {"loop_hangs", error, "Control loop stalled: the enable output was switched off."}},
    {PanelEvent::Kind::gpio_lost,
     {"gpio_lost", error, "The GPIO chip failed: its lines are not available until the daemon restarts."}},
});

template <class Table, class Which>
EventEntry entry_of(const Table& table, Which which) {
  const Words& words = table[which];
  return event_of(std::string(words.kind), words.severity, 0, std::string(words.text));
}

using Sequence = control::PreparedSequence;

void describe_state(const Event& event, const Sequence*, EventEntry& entry) {
  entry.code = control::name_of(std::get<control::State>(event.detail));
  entry.text = fmt::format("State: {}.", entry.code);
}

void describe_fault(const Event& event, const Sequence*, EventEntry& entry) {
  const control::FaultInfo& info = control::info_of(std::get<control::FaultCode>(event.detail));
  entry.code = info.id;
  entry.text = fmt::format("Fault {} {}: {}", info.id, info.name, info.meaning);
  entry.severity = Severity::error;
}

void describe_acknowledged(const Event& event, const Sequence*, EventEntry& entry) {
  const control::FaultInfo& info = control::info_of(std::get<control::FaultCode>(event.detail));
  entry.code = info.id;
  entry.text = fmt::format("Fault {} {} was acknowledged.", info.id, info.name);
}

void describe_step(const Event& event, const Sequence* sequence, EventEntry& entry) {
  const auto index = std::get<std::uint16_t>(event.detail);
  entry.code = fmt::format("{}", index);
  const bool known = sequence != nullptr && index < sequence->steps.size();
  const control::Step* step = known ? &sequence->steps[index].step : nullptr;
  entry.text = step != nullptr ? fmt::format("Step {} started: {}.", index + 1, step->name)
                               : fmt::format("Step {} started.", index + 1);
}

void describe_result(const Event& event, const Sequence*, EventEntry& entry) {
  const control::GripResult result = std::get<control::GripAnswer>(event.detail).result;
  entry.code = control::title_of(result);
  entry.text = fmt::format("Grip result: {}.", entry.code);
  const bool bad = result == control::GripResult::part_lost || result == control::GripResult::error;
  entry.severity = bad ? Severity::warning : Severity::information;
}

void describe_refusal(const Event& event, const Sequence*, EventEntry& entry) {
  const auto& refusal = std::get<control::RequestRefusal>(event.detail);
  entry.code = control::id_of(refusal.code);
  entry.value = static_cast<double>(refusal.cause);
  // The text does not need the names of the channels, because describe() puts the name of the channel before
  // the text.
  entry.text = fmt::format("The request was refused. {}", sentences_of(refusal.code, {refusal.cause}, {}));
  entry.severity = Severity::warning;
}

void describe_health(const Event& event, const Sequence*, EventEntry& entry) {
  const auto health = std::get<control::HealthState>(event.detail);
  entry.code = control::name_of(health);
  entry.text = fmt::format("Model status: {} (residual {:.3g} mm RMS).", entry.code, event.value);
  const bool good = health == control::HealthState::healthy || health == control::HealthState::unknown;
  entry.severity = good ? Severity::information : Severity::warning;
}

void describe_contact(const Event& event, const Sequence*, EventEntry& entry) {
  const auto action = std::get<control::OnContact>(event.detail);
  entry.code = control::name_of(action);
  const char* then = "";
  switch (action) {
    case control::OnContact::hold:
      then = "the pressure at first contact is kept";
      break;
    case control::OnContact::grip:
      then = "the pressure at first contact is kept, and the grip begins";
      break;
    case control::OnContact::fail:
      then = "the pressure at first contact is kept, and the step has failed";
      break;
    case control::OnContact::ignore:
      then = "the step continues";
      break;
    case control::OnContact::squeeze:
      then = "the gripping pressure rises";
      break;
    case control::OnContact::close:
      then = "the finger closes to its target with constant feedback";
      break;
  }
  entry.text = fmt::format("Contact at {:.2f} mm: {}.", event.value, then);
  const bool unexpected = action == control::OnContact::hold || action == control::OnContact::fail;
  entry.severity = unexpected ? Severity::warning : Severity::information;
}

void describe_limit(const Event& event, const Sequence*, EventEntry& entry) {
  const bool binds = event.kind == Kind::limit_binds;
  const auto limit = std::get<control::BindingLimit>(event.detail);
  entry.code = control::name_of(limit);
  const std::string_view words = control::words_of(limit);
  entry.text = binds ? fmt::format("Limit active: {}. The command is {:.1f} kPa.", words, event.value)
                     : fmt::format("Limit cleared: {}.", words);
  const bool of_rig = limit == control::BindingLimit::rig_pressure;
  entry.severity = binds && of_rig ? Severity::warning : Severity::information;
}

std::string quoted_name(const Sequence* sequence) {
  return sequence != nullptr ? fmt::format(" '{}'", sequence->name) : std::string();
}

void describe_start(const Event&, const Sequence* sequence, EventEntry& entry) {
  entry.code = sequence != nullptr ? sequence->name : "";
  std::string values;
  if (sequence != nullptr) {
    entry.parameters = sequence->parameters;
    for (const control::Argument& parameter : sequence->parameters) {
      values +=
          fmt::format("{} {} {}", values.empty() ? " with" : ",", parameter.name, written(parameter.value));
    }
  }
  entry.text = fmt::format("The sequence{} begins{}.", quoted_name(sequence), values);
}

void describe_end(const Event& event, const Sequence* sequence, EventEntry& entry) {
  entry.code = control::name_of(std::get<control::SequenceEnd>(event.detail));
  entry.text = fmt::format("The sequence{} ended: {}.", quoted_name(sequence), entry.code);
}

void describe_reading(const Event& event, const Sequence*, EventEntry& entry) {
  if (event.kind == Kind::reading_valid) {
    entry.text = "The reading is valid again.";
    return;
  }
  entry.code = name_of(std::get<model::Validity>(event.detail));
  entry.text = fmt::format("The reading is not valid: {}.", entry.code);
  entry.severity = Severity::warning;
}

void describe_unsteady(const Event& event, const Sequence*, EventEntry& entry) {
  if (event.kind == Kind::reading_steady) {
    entry.text = "The reading is steady again.";
    return;
  }
  entry.text = fmt::format("The reading is unsteady: it jumps back and forth. The last jump was {:.1f} mm.",
                           std::abs(event.value));
  entry.severity = Severity::warning;
}

void describe_release(const Event&, const Sequence*, EventEntry& entry) {
  entry.text = "A release was requested.";
}

void describe_check(const Event&, const Sequence*, EventEntry& entry) {
  entry.text = "Dry run of a start: the daemon would accept the start now.";
}

void describe_not_at_rest(const Event& event, const Sequence*, EventEntry& entry) {
  const bool moves = std::get<control::UnsettledReason>(event.detail) == control::UnsettledReason::moves;
  entry.code = moves ? "moves" : "off_model";
  entry.text =
      moves
          ? std::string("Start aborted: the finger did not come to rest.")
          : fmt::format(
                "Start aborted: at rest, the finger deviates from its model by {:.1f} mm. Wait 2 minutes for "
                "creep to decay, or run free_stroke with empty fingers. If the deviation remains, check the "
                "sensor zero.",
                event.value);
  entry.severity = Severity::warning;
}

struct Telling {
  std::string_view kind;
  void (*describe)(const Event& event, const Sequence* sequence, EventEntry& entry);
};
constexpr auto tellings = enum_table<Kind, Telling>({
    {Kind::state_changed, {"state_changed", describe_state}},
    {Kind::fault_latched, {"fault_latched", describe_fault}},
    {Kind::fault_acknowledged, {"fault_acknowledged", describe_acknowledged}},
    {Kind::sequence_started, {"sequence_started", describe_start}},
    {Kind::sequence_finished, {"sequence_finished", describe_end}},
    {Kind::step_started, {"step_started", describe_step}},
    {Kind::grip_result, {"grip_result", describe_result}},
    {Kind::request_refused, {"request_refused", describe_refusal}},
    {Kind::model_health_changed, {"model_health_changed", describe_health}},
    {Kind::reading_invalid, {"reading_invalid", describe_reading}},
    {Kind::reading_valid, {"reading_valid", describe_reading}},
    {Kind::contact, {"contact", describe_contact}},
    {Kind::limit_binds, {"limit_binds", describe_limit}},
    {Kind::limit_free, {"limit_free", describe_limit}},
    {Kind::release_asked, {"release_asked", describe_release}},
    {Kind::reading_unsteady, {"reading_unsteady", describe_unsteady}},
    {Kind::reading_steady, {"reading_steady", describe_unsteady}},
    {Kind::start_checked, {"start_checked", describe_check}},
    {Kind::not_at_rest, {"not_at_rest", describe_not_at_rest}},
});

}  // namespace

EventEntry describe(const Event& event, const std::vector<std::string>& channel_names,
                    const control::PreparedSequence* sequence) {
  const Telling& telling = tellings[event.kind];
  EventEntry entry;
  entry.kind = telling.kind;
  entry.request = event.request;
  entry.value = event.value;
  if (event.channel < channel_names.size()) entry.channel = channel_names[event.channel];
  telling.describe(event, sequence, entry);
  if (!entry.channel.empty()) entry.text = fmt::format("{}: {}", entry.channel, entry.text);
  return entry;
}

EventEntry event_of(std::string kind, Severity severity, double time_s, std::string text) {
  EventEntry entry;
  entry.kind = std::move(kind);
  entry.severity = severity;
  entry.time_s = time_s;
  entry.text = std::move(text);
  return entry;
}

std::string title_of(const control::Fault& fault, const std::vector<std::string>& channel_names) {
  const control::FaultInfo& info = control::info_of(fault.code);
  const bool of_channel = fault.channel < channel_names.size();
  return fmt::format("{} {}{}{}", info.id, info.name, of_channel ? " of " : "",
                     of_channel ? channel_names[fault.channel] : "");
}

std::string sentences_of(control::RefusalCode refusal, const control::Fault& cause,
                         const std::vector<std::string>& channel_names) {
  const control::RefusalText& text = control::text_of(refusal);
  if (refusal == control::RefusalCode::cause_persists && cause.code != control::FaultCode::none) {
    return fmt::format("The cause of a fault is still present: {}. {} Then acknowledge again.",
                       title_of(cause, channel_names), control::info_of(cause.code).remedy);
  }
  return fmt::format("{}{}{}", text.meaning, text.next.empty() ? "" : " ", text.next);
}

EventEntry describe(const BusEvent& event) {
  EventEntry entry = entry_of(bus_words, event.kind);
  const std::string_view detail(event.detail.data());
  if (event.kind == BusEvent::Kind::another_client) {
    entry.text = fmt::format(
        "The board has {} clients. Requests of any client reset the board's watchdog. If softgripd ends "
        "without venting, the board does not vent while another client sends requests.",
        detail);
  }
  const bool failed = event.kind == BusEvent::Kind::failed;
  if (!failed && event.kind != BusEvent::Kind::not_connected) return entry;
  entry.code = drivers::name_of(event.status);
  entry.text =
      fmt::format("{}: {}{}{}.",
                  failed ? "The exchange with the board failed" : "No session with the board can be opened",
                  entry.code, detail.empty() ? "" : ": ", detail);
  return entry;
}

EventEntry describe(const PanelEvent& event) {
  return entry_of(panel_words, event.kind);
}

std::string_view name_of(Severity severity) noexcept {
  static constexpr auto names = enum_names<Severity>(
      {{Severity::information, "information"}, {Severity::warning, "warning"}, {Severity::error, "error"}});
  return names[severity];
}

std::uint64_t EventLog::add(EventEntry entry) {
  const std::scoped_lock lock(mutex_);
  entry.id = ++last_id_;
  // Clients choose the names of sequences and the number of steps. If each name and each index of a step had
  // its own counter, the number of counters could grow without limit.
  const bool named = entry.kind == "sequence_started" || entry.kind == "step_started";
  ++counts_[{entry.kind, named ? std::string() : entry.code, entry.channel}];
  entries_.push_back(std::move(entry));
  if (entries_.size() > capacity_) entries_.pop_front();
  return last_id_;
}

std::vector<EventEntry> EventLog::since(std::uint64_t id, std::size_t limit) const {
  const std::scoped_lock lock(mutex_);
  if (id >= last_id_) return {};
  // The ids of the stored events are consecutive numbers.
  const std::uint64_t known = last_id_ - entries_.size();
  const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(std::max(id, known) - known);
  const auto count = std::min<std::size_t>(limit, static_cast<std::size_t>(entries_.end() - first));
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

std::uint64_t EventLog::newest() const {
  const std::scoped_lock lock(mutex_);
  return last_id_;
}

std::uint64_t EventLog::oldest() const {
  const std::scoped_lock lock(mutex_);
  return entries_.empty() ? 0 : entries_.front().id;
}

std::vector<EventCount> EventLog::counts() const {
  const std::scoped_lock lock(mutex_);
  std::vector<EventCount> counts;
  counts.reserve(counts_.size());
  for (const auto& [sort, count] : counts_) {
    counts.push_back({std::get<0>(sort), std::get<1>(sort), std::get<2>(sort), count});
  }
  return counts;
}

}  // namespace softgrip::daemon
