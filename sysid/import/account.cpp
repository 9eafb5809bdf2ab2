#include "sysid/import/account.h"

#include <numeric>

#include "base/enum_table.h"

namespace softgrip::sysid {
namespace {

struct Reason {
  std::string_view word;
  std::string_view text;
  /// True: the rows that are left out for this reason count as lost. False: the rows do not count as lost,
  /// because they are empty or because the user requested to leave them out.
  bool lost;
};
constexpr auto reasons = enum_table<LeftOut, Reason>({
    {LeftOut::other_channel, {"other_channel", "of another channel", false}},
    {LeftOut::outside_stretch, {"outside_stretch", "outside the times --from-s and --to-s", false}},
    {LeftOut::empty, {"empty", "without content", false}},
    {LeftOut::comment, {"comment", "in comments", false}},
    {LeftOut::bad_line, {"bad_line", "in lines that cannot be read", true}},
    {LeftOut::cut_off_line, {"cut_off_line", "in the incomplete last part of the file", true}},
    {LeftOut::no_time, {"no_time", "without a time", true}},
    {LeftOut::repeated_time, {"repeated_time", "with the time of the previous row", true}},
    {LeftOut::before_command, {"before_command", "before the first command", true}},
    {LeftOut::hole, {"hole", "in shorter segments before or after a gap", true}},
});
static_assert(reasons.size() == left_out_count);

std::size_t sum_of(const RowAccount& account, bool lost_only) {
  std::size_t sum = 0;
  for (const auto& [reason, info] : reasons)
    sum += lost_only && !info.lost ? 0 : account.left_out[static_cast<std::size_t>(reason)];
  return sum;
}

}  // namespace

std::string_view word_of(LeftOut reason) {
  return reasons[reason].word;
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
  for (const auto& [reason, info] : reasons) {
    const std::size_t count = left_out[static_cast<std::size_t>(reason)];
    if (count > 0)
      details += (details.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(info.text);
  }
  return text + ", " + std::to_string(out) + " left out (" + details + ")";
}

}  // namespace softgrip::sysid
