#include "tools/client/live_view.h"

#include <cctype>
#include <utility>

#include "tools/client/daemon_client.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr char escape_key = '\x1b';
constexpr char end_of_transmission = '\x04';
constexpr char erase_line = '\x15';
constexpr char backspace = '\b';
constexpr char delete_key = '\x7f';
constexpr std::size_t longest_name = 100;

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

constexpr std::string_view trend_legend = "  trends: 1 column 1 s";
constexpr std::size_t event_indent = 12;
/// Smallest number of rows for events. If fewer rows remain, parts of the screen other than the events are
/// omitted first.
constexpr std::size_t min_event_rows = 3;

void append(Lines& lines, const Lines& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

Lines footer_of(const LiveState& state, const ViewStyle& style) {
  Lines lines;
  if (!state.question.empty()) {
    append(lines, wrap_text(style, state.question, Tone::strong, 2));
  } else if (!state.message.text.empty()) {
    append(lines, wrap_text(style, state.message.text, state.message.tone, 2));
  }
  const std::string_view help = KeyDialogue::help();
  Line keys(style);
  keys.add(help, Tone::faint);
  if (help.size() + trend_legend.size() <= style.columns) keys.add(trend_legend, Tone::faint);
  lines.push_back(keys.text());
  return lines;
}

Lines lines_of_event(const Json& event, const ViewStyle& style) {
  const std::string severity = event.value("severity", "");
  const Tone tone = severity == "error" ? Tone::bad : severity == "warning" ? Tone::warning : Tone::plain;
  return wrap_text(style, brief_line_of_event(event), tone, event_indent);
}

/// Returns the newest events that fit completely into `rows` lines, the newest event last.
Lines lines_of_events(const LiveState& state, const ViewStyle& style, std::size_t rows) {
  Lines lines;
  for (auto event = state.events.rbegin(); event != state.events.rend(); ++event) {
    const Lines more = lines_of_event(*event, style);
    if (lines.size() + more.size() > rows) break;
    lines.insert(lines.begin(), more.begin(), more.end());
  }
  return lines;
}

/// Parts of the screen that may be omitted if the screen has few rows.
struct Layout {
  bool blanks = true;     ///< true: blank lines separate the parts
  bool internals = true;  ///< true: the state of the control loop and of the recording is shown
};

/// Returns all lines of the screen except the events and the key help.
Lines body_of(const StatusParts& parts, const ViewStyle& style, const Layout& layout) {
  Lines lines = parts.head;
  const auto add = [&](const Lines& more) {
    if (layout.blanks) lines.emplace_back();
    append(lines, more);
  };
  for (const Lines& channel : parts.channels) add(channel);
  add(parts.board);
  if (layout.internals) {
    append(lines, parts.internals);
  } else {
    lines.push_back(Line(style).add("... enlarge the window for loop and recording", Tone::faint).text());
  }
  return lines;
}

}  // namespace

std::string_view KeyDialogue::help() {
  return "s stop  v vent  r release  a acknowledge  g start  q quit";
}

std::string KeyDialogue::question() const {
  switch (state_) {
    case State::idle:
      return {};
    case State::reading_name:
      return "start which sequence" + (proposed_name_.empty() ? "" : " [" + proposed_name_ + "]") + "? " +
             name_ + "_";
    case State::confirming:
      return question_;
  }
  return {};
}

bool KeyDialogue::expire(double time_s) {
  if (state_ != State::confirming || time_s - asked_at_s_ < confirmation_timeout_s) return false;
  state_ = State::idle;
  return true;
}

void KeyDialogue::ask_confirmation(Json request, std::string question, double time_s) {
  request_ = std::move(request);
  question_ = std::move(question) + " y: yes, any other key: no";
  asked_at_s_ = time_s;
  state_ = State::confirming;
}

KeyDialogue::Outcome KeyDialogue::process(std::string_view typed, double time_s,
                                          const std::string& last_sequence) {
  expire(time_s);
  // An escape character alone is the escape key. If more characters follow the escape character, they encode
  // an arrow key or a function key, which is ignored.
  if (typed.size() > 1 && typed.front() == escape_key) return {};
  for (std::size_t i = 0; i < typed.size(); ++i) {
    const State before = state_;
    Outcome outcome = key(typed[i], time_s, last_sequence);
    const bool is_asked = state_ == State::confirming && before != state_;
    if (!outcome.quit && !outcome.request && !is_asked) continue;
    // The later keys are ignored, except the key for vent.
    const bool vents = !outcome.quit && typed.find('v', i + 1) != std::string_view::npos;
    return vents ? key('v', time_s, last_sequence) : outcome;
  }
  return {};
}

KeyDialogue::Outcome KeyDialogue::key(char key, double time_s, const std::string& last_sequence) {
  const auto plain = [](const char* command) { return Outcome{false, Json::object({{"command", command}})}; };
  if (state_ == State::reading_name) return name_key(key, time_s);
  if (state_ == State::confirming) {
    state_ = State::idle;
    if (key == 'y' || key == 'Y') return {false, std::move(request_)};
    // The keys for stop and vent are accepted at all times, even if a question waits for its answer.
    if (key != 's' && key != 'v') return {};
  }
  switch (key) {
    case 'q':
    case 'Q':
    case end_of_transmission:
      return {true, std::nullopt};
    case 's':
      return plain("stop");
    case 'v':
      return plain("vent");
    case 'a':
      return plain("acknowledge");
    case 'r':
      ask_confirmation({{"command", "release"}}, "Release? The fingers open, and held parts drop.", time_s);
      return {};
    case 'g':
      name_.clear();
      proposed_name_ = last_sequence;
      state_ = State::reading_name;
      return {};
    default:
      return {};
  }
}

KeyDialogue::Outcome KeyDialogue::name_key(char key, double time_s) {
  if (key == '\r' || key == '\n') {
    const std::string name = name_.empty() ? proposed_name_ : name_;
    state_ = State::idle;
    if (!name.empty()) {
      ask_confirmation({{"command", "start"}, {"sequence", name}},
                       "Start " + name + "? The fingers will move.", time_s);
    }
  } else if (key == escape_key || key == end_of_transmission) {
    state_ = State::idle;
  } else if (key == backspace || key == delete_key) {
    if (!name_.empty()) name_.pop_back();
  } else if (key == erase_line) {
    name_.clear();
  } else if (std::isprint(static_cast<unsigned char>(key)) != 0 && name_.size() < longest_name) {
    name_ += key;
  }
  return {};
}

void update_status(LiveState& state, Json status) {
  const double time_s = number_at(status, "time_s").value_or(0);
  const auto list = status.find("channels");
  const Json channels = list != status.end() && list->is_array() ? *list : Json::array();
  state.trends.resize(channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Json& channel = channels[i];
    // If the reading is not valid, its last value is out of date, so the trend gets a gap.
    const bool valid = channel.is_object() && channel.value("validity", "") == "valid";
    const auto pressure = number_at(channel, "pressure_kpa");
    const auto command = number_at(channel, "command_kpa");
    state.trends[i].pressure_kpa.add(time_s, pressure ? pressure : command);
    state.trends[i].displacement_mm.add(time_s, valid ? number_at(channel, "displacement_mm") : std::nullopt);
  }
  state.status = std::move(status);
}

void add_event(LiveState& state, Json event) {
  state.events.push_back(std::move(event));
  if (state.events.size() > events_shown) state.events.pop_front();
}

Lines screen_of(const LiveState& state, const ViewStyle& style, std::size_t rows) {
  Lines footer = footer_of(state, style);
  if (footer.size() > rows) footer.erase(footer.begin(), footer.end() - static_cast<std::ptrdiff_t>(rows));
  const std::size_t room = rows - footer.size();
  const StatusParts parts = parts_of(state.status, style, &state.trends);
  Lines lines;
  for (const Layout& layout : {Layout{true, true}, Layout{false, true}, Layout{false, false}}) {
    lines = body_of(parts, style, layout);
    if (lines.size() + 1 + min_event_rows <= room) break;
  }
  if (lines.size() > room && room > 0) {
    const std::size_t hidden = lines.size() - room + 1;
    lines.resize(room - 1);
    lines.push_back(
        Line(style)
            .add("... " + std::to_string(hidden) + " more lines: enlarge the window", Tone::warning)
            .text());
  } else if (lines.size() + 1 < room) {
    const Lines events = lines_of_events(state, style, room - lines.size() - 1);
    lines.emplace_back();
    append(lines, events);
  }
  lines.resize(room);  // adds blank lines, so that the key help is always the bottom line
  append(lines, footer);
  return lines;
}

}  // namespace softgrip::tools
