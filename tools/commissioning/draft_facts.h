#pragma once
// Lists the facts that a rig-file template needs. The user states each fact by an option or by the answer to
// a question.

#include <optional>
#include <string>
#include <vector>

#include "tools/commissioning/rig_draft.h"

namespace softgrip::tools {

/// One fact of the rig.
struct Fact {
  std::string key;    ///< the option's name: "board"
  std::string about;  ///< the option's help
  int words = 1;      ///< number of values; an option with one value may be given several times
  /// Returns the question, whose text depends on the facts known so far, and the default answer. Returns
  /// nullopt if no question is needed.
  struct Question {
    std::string text;
    std::string otherwise;  ///< default value; empty: there is none
  };
  std::optional<Question> (*question)(const RigDraft& draft);
  /// Stores the value in `draft`. Returns an error message, or "" if the value is valid.
  std::string (*take)(const std::string& words, RigDraft& draft);
};

/// Returns all facts, ordered so that each depends only on earlier ones.
[[nodiscard]] const std::vector<Fact>& draft_facts();

}  // namespace softgrip::tools
