#include "sysid/import/account.h"

#include <numeric>

namespace softgrip::sysid {
namespace {

struct Reason {
  std::string_view word;
  std::string_view text;
  /// True: the rows that are left out for this reason count as lost. False: the rows do not count as lost,
  /// because they are empty or because the user requested to leave them out.
  bool lost;
};
constexpr std::array<Reason, left_out_count> reasons{{
    {"other_channel", "of another channel", false},
    {"outside_stretch", "outside the times --from-s and --to-s", false},
    {"empty", "without content", false},
    {"bad_line", "in lines that cannot be read", true},
    {"cut_off_line", "in the incomplete last part of the file", true},
    {"no_time", "without a time", true},
    {"repeated_time", "with the time of the previous row", true},
    {"before_command", "before the first command", true},
    {"hole", "in shorter segments before or after a gap", true},
}};

std::size_t sum_of(const RowAccount& account, bool lost_only) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < left_out_count; ++i)
    sum += lost_only && !reasons[i].lost ? 0 : account.left_out[i];
  return sum;
}

}  // namespace

std::string_view word_of(LeftOut reason) {
  return reasons[static_cast<std::size_t>(reason)].word;
}

bool RowAccount::balanced() const {
  return rows == used + joined + sum_of(*this, false);
}

std::size_t RowAccount::lost() const {
  return sum_of(*this, true);
}

double RowAccount::lost_share() const {
  const std::size_t wanted = rows - (sum_of(*this, false) - lost());
  return wanted == 0 ? 0 : static_cast<double>(lost()) / static_cast<double>(wanted);
}

std::string RowAccount::sentence() const {
  std::string text = std::to_string(rows) + " rows: " + std::to_string(used) + " used";
  if (joined > 0) text += ", " + std::to_string(joined) + " merged with another row that has the same time";
  const std::size_t out = sum_of(*this, false);
  if (out == 0) return text;
  std::string details;
  for (std::size_t i = 0; i < left_out_count; ++i) {
    if (left_out[i] > 0)
      details +=
          (details.empty() ? "" : ", ") + std::to_string(left_out[i]) + " " + std::string(reasons[i].text);
  }
  return text + ", " + std::to_string(out) + " left out (" + details + ")";
}

}  // namespace softgrip::sysid
