#pragma once
// The findings of `softgrip doctor`: one line per finding, with advice.

#include <string>
#include <string_view>
#include <vector>

#include "base/result/result.h"

namespace softgrip::tools::doctor {

/// Result of a check. `not_judged` means that the check was omitted, because it depends on another check that
/// has failed.
enum class Verdict { ok, not_judged, warn, fail };
/// Returns the name of a verdict: "ok", "not_judged", "warn" or "fail".
[[nodiscard]] std::string_view name_of(Verdict verdict) noexcept;

struct Finding {
  std::string name;  ///< name of the check, for example "board" or "sensor left"; part of the public format
  Verdict verdict = Verdict::ok;
  std::string text;    ///< result of the check as text
  std::string advice;  ///< next step that the user should take; empty if no step is needed
};

class Findings {
 public:
  void ok(std::string name, std::string text) { add({std::move(name), Verdict::ok, std::move(text), ""}); }
  void warn(std::string name, std::string text, std::string advice) {
    add({std::move(name), Verdict::warn, std::move(text), std::move(advice)});
  }
  void fail(std::string name, std::string text, std::string advice) {
    add({std::move(name), Verdict::fail, std::move(text), std::move(advice)});
  }
  /// Adds a check that was omitted. `because` names the problem that the user must correct before the check
  /// is possible.
  void not_judged(std::string name, const std::string& because) {
    add({std::move(name), Verdict::not_judged, "not judged: " + because, ""});
  }
  void add(Finding finding) { list_.push_back(std::move(finding)); }

  [[nodiscard]] const std::vector<Finding>& list() const noexcept { return list_; }
  [[nodiscard]] std::size_t count(Verdict verdict) const;
  [[nodiscard]] Verdict worst() const;

 private:
  std::vector<Finding> list_;
};

/// The data for the title line above the findings and for the overall verdict below them.
struct Examination {
  std::string rig;       ///< name of the examined rig
  std::string rig_file;  ///< path of the file of the examined rig
  bool daemon_runs = false;
  bool moved = false;      ///< true: the fingers were moved during the examination
  bool simulated = false;  ///< true: the board is simulated, so no hardware was examined
};

/// Formats the findings in columns for a terminal of `columns` characters, with optional colours. The last
/// line states the overall verdict.
[[nodiscard]] std::string text_of(const Examination& examination, const Findings& findings,
                                  std::size_t columns, bool colour);
/// Returns the content of the output of `softgrip doctor --json`.
[[nodiscard]] result::Fields fields_of(const Examination& examination, const Findings& findings);

/// Returns a number with its noun in singular or plural: "1 warning", "2 warnings".
[[nodiscard]] std::string counted(std::size_t count, std::string_view noun);

}  // namespace softgrip::tools::doctor
