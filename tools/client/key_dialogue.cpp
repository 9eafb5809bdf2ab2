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
  switch (waiting_) {
    case Waiting::for_a_key:
      return {};
    case Waiting::for_a_name:
      return "start which sequence" + (offered_.empty() ? "" : " [" + offered_ + "]") + "? " + name_ + "_";
    case Waiting::for_a_yes:
      return question_;
  }
  return {};
}

bool KeyDialogue::lapse(double time_s) {
  if (waiting_ != Waiting::for_a_yes || time_s - asked_s_ < patience_s) return false;
  waiting_ = Waiting::for_a_key;
  return true;
}

void KeyDialogue::ask(Json request, std::string question, double time_s) {
  request_ = std::move(request);
  question_ = std::move(question) + " y: yes, any other key: no";
  asked_s_ = time_s;
  waiting_ = Waiting::for_a_yes;
}

KeyDialogue::Outcome KeyDialogue::take(std::string_view typed, double time_s, const std::string& ran) {
  lapse(time_s);
  // An escape character alone is the escape key. If more characters follow the escape character, they encode
  // an arrow key or a function key, which is ignored.
  if (typed.size() > 1 && typed.front() == escape_key) return {};
  for (const char one : typed) {
    const Waiting before = waiting_;
    Outcome outcome = key(one, time_s, ran);
    const bool asks = waiting_ == Waiting::for_a_yes && before != waiting_;
    if (outcome.leave || outcome.request || asks) return outcome;
  }
  return {};
}

KeyDialogue::Outcome KeyDialogue::key(char key, double time_s, const std::string& ran) {
  const auto plain = [](const char* command) { return Outcome{false, Json::object({{"command", command}})}; };
  if (waiting_ == Waiting::for_a_name) return name_key(key, time_s);
  if (waiting_ == Waiting::for_a_yes) {
    waiting_ = Waiting::for_a_key;
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
      ask({{"command", "release"}}, "Release? The fingers open, and held parts drop.", time_s);
      return {};
    case 'g':
      name_.clear();
      offered_ = ran;
      waiting_ = Waiting::for_a_name;
      return {};
    default:
      return {};
  }
}

KeyDialogue::Outcome KeyDialogue::name_key(char key, double time_s) {
  if (key == '\r' || key == '\n') {
    const std::string name = name_.empty() ? offered_ : name_;
    waiting_ = Waiting::for_a_key;
    if (!name.empty()) {
      ask({{"command", "start"}, {"sequence", name}}, "Start " + name + "? The fingers will move.", time_s);
    }
  } else if (key == escape_key || key == end_of_transmission) {
    waiting_ = Waiting::for_a_key;
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
