#pragma once
// What the keys of `softgrip watch` ask of the daemon. Knows no terminal and no socket.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace softgrip::tools {

/// A stop and a vent go out at once: they are the ways out. What moves the fingers otherwise (a start, a
/// release) is asked back, and the answer is a key that is typed after the question, within `patience_s`.
class KeyDialogue {
 public:
  static constexpr double patience_s = 10;

  struct Outcome {
    bool leave = false;
    std::optional<nlohmann::ordered_json> request;  ///< for the daemon
  };
  /// What was typed since the last look. `ran` is the sequence that a start offers, or empty. Behind a
  /// question the rest is dropped: a paste must not answer it. Sequences of arrow and function keys are
  /// ignored.
  Outcome take(std::string_view typed, double time_s, const std::string& ran);
  /// A question that nobody answers lapses. True if it just did.
  bool lapse(double time_s);

  /// The question that waits for an answer; empty: none does.
  [[nodiscard]] std::string question() const;
  /// Which key does what, in one line of 58 columns.
  [[nodiscard]] static std::string_view help();

 private:
  enum class Waiting : unsigned char { for_a_key, for_a_name, for_a_yes };
  Outcome key(char key, double time_s, const std::string& ran);
  Outcome name_key(char key, double time_s);
  void ask(nlohmann::ordered_json request, std::string question, double time_s);

  Waiting waiting_ = Waiting::for_a_key;
  double asked_s_ = 0;
  std::string name_;
  std::string offered_;
  std::string question_;
  nlohmann::ordered_json request_;
};

}  // namespace softgrip::tools
