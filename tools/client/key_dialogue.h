#pragma once
// Converts the keys of `softgrip watch` to requests to the daemon. Does not access a terminal or a socket.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace softgrip::tools {

/// Converts the keys for stop and vent to requests at once. Start and release move the fingers, so they need
/// a confirmation: a key that the user types within `patience_s` after the question.
class KeyDialogue {
 public:
  static constexpr double patience_s = 10;

  struct Outcome {
    bool leave = false;
    std::optional<nlohmann::ordered_json> request;  ///< request to the daemon; nullopt: no request
  };
  /// Processes the keys that were typed since the last call. `ran` is the name of the sequence that the start
  /// key offers; empty: the start key offers none. If a key causes a question, the keys that follow this key
  /// are dropped, so that pasted text cannot confirm the question. Arrow keys and function keys are ignored.
  Outcome take(std::string_view typed, double time_s, const std::string& ran);
  /// Withdraws the question if it has waited for an answer for `patience_s`. Returns true if this call has
  /// withdrawn a question.
  bool lapse(double time_s);

  /// Returns the question that waits for an answer; "" if there is none.
  [[nodiscard]] std::string question() const;
  /// Returns the help on the keys as one line of 58 columns.
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
