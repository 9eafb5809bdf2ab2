#include "tools/client/key_dialogue.h"

#include <cctype>
#include <utility>

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr char escape_key = '\x1b';
constexpr char end_of_transmission = '\x04';
constexpr char erase_line = '\x15';
constexpr char backspace = '\b';
constexpr char delete_key = '\x7f';
constexpr std::size_t longest_name = 100;

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
  for (const char one : typed) {
    const State before = state_;
    Outcome outcome = key(one, time_s, last_sequence);
    const bool is_asked = state_ == State::confirming && before != state_;
    if (outcome.quit || outcome.request || is_asked) return outcome;
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

}  // namespace softgrip::tools
