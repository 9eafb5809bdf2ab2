#pragma once
// Asks a person at the terminal, or a script that writes to the standard input.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "base/net/line_buffer.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate {

/// Writes questions to the standard error. Answers come first from the prepared answers. After the last
/// prepared answer, they are read line by line from the standard input.
class TerminalOperator final : public Operator {
 public:
  TerminalOperator();

  void prepare(const std::vector<std::string>& answers) { prepared_.assign(answers.begin(), answers.end()); }
  void tell(const std::string& text) override;
  void ask(const std::string& question) override;
  std::optional<std::string> answer() override;
  [[nodiscard]] bool gone() const override { return closed_ && !pending_.has_line(); }
  [[nodiscard]] bool patient() const override { return interactive_; }

 private:
  std::optional<std::string> take_line();

  bool interactive_;
  bool closed_ = false;
  net::LineBuffer pending_;
  std::deque<std::string> prepared_;
};

}  // namespace softgrip::tools::calibrate
