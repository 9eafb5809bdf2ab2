#pragma once
// Converts the keys of `softgrip watch` to requests to the daemon. It uses no terminal and no socket.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace softgrip::tools {

/// Stop and vent are sent at once. Start and release, which move the fingers, need a confirmation: a key that
/// is typed after the question and within `patience_s`.
class KeyDialogue {
 public:
  static constexpr double patience_s = 10;

  struct Outcome {
    bool leave = false;
    std::optional<nlohmann::ordered_json> request;  ///< request to the daemon
  };
  /// Processes the keys that were typed since the last call. `ran` is the sequence that the start key offers
  /// to run; empty: none. If a key causes a question, the keys typed after it are dropped, so that pasted
  /// text cannot confirm the question. Arrow keys and function keys are ignored.
  Outcome take(std::string_view typed, double time_s, const std::string& ran);
  /// Withdraws a question that has waited for `patience_s`. Returns true if this call withdrew it.
  bool lapse(double time_s);

  /// Returns the question that waits for an answer, or "".
  [[nodiscard]] std::string question() const;
  /// Returns the help of the keys in one line of 58 columns.
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
