#pragma once
// The facts of a rig draft one by one, as words: given as options or typed in answer to a question.

#include <optional>
#include <string>
#include <vector>

#include "tools/commissioning/rig_draft.h"

namespace softgrip::tools {

/// One fact.
struct Fact {
  std::string key;    ///< the option's name: "board"
  std::string about;  ///< the option's help
  int words = 1;      ///< that belong together; a fact of one word may be given several times
  /// The question, by what is known already, with what Enter means; nothing: it need not be asked.
  struct Question {
    std::string text;
    std::string otherwise;  ///< empty: there is no usual answer
  };
  std::optional<Question> (*question)(const RigDraft& draft);
  /// Takes an answer; what is wrong with it, or empty.
  std::string (*take)(const std::string& words, RigDraft& draft);
};

/// All of them, in the order in which they build on each other.
[[nodiscard]] const std::vector<Fact>& draft_facts();

}  // namespace softgrip::tools
