#pragma once
// What `softgrip doctor` finds: one line each, and what to do about it.

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools::doctor {

/// `not_judged`: it follows from something else that is wrong, and says nothing of its own.
enum class Verdict { ok, not_judged, warn, fail };
/// "ok", "not_judged", "warn", "fail"
[[nodiscard]] std::string_view name_of(Verdict verdict) noexcept;

struct Finding {
  std::string name;  ///< "board", "sensor left"; a contract
  Verdict verdict = Verdict::ok;
  std::string text;    ///< what was found
  std::string advice;  ///< what to do; empty where nothing is to be done
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
  /// `because`: what has to be mended first.
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

/// What is printed above and below the findings.
struct Examination {
  std::string rig;       ///< its name
  std::string rig_file;  ///< its path
  bool daemon_runs = false;
  bool moved = false;      ///< the fingers were moved for it
  bool simulated = false;  ///< there is no board: nothing real was examined
};

/// Findings in columns of a terminal that is `columns` wide, with colours if `colour`; ends with the verdict.
[[nodiscard]] std::string text_of(const Examination& examination, const Findings& findings,
                                  std::size_t columns, bool colour);
[[nodiscard]] nlohmann::ordered_json json_of(const Examination& examination, const Findings& findings);

/// "1 warning", "2 warnings"
[[nodiscard]] std::string counted(std::size_t count, std::string_view noun);

}  // namespace softgrip::tools::doctor
