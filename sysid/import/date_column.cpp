#include "sysid/import/date_column.h"

#include <utility>

#include "sysid/import/moments.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {

bool DateColumn::has_name(std::string_view column) {
  const std::string name = lower_case(split_unit(column).name);
  return name == "date" || name == "datum";
}

void DateColumn::read(std::string_view text) {
  if (text.empty() || text == text_) return;
  const auto day = day_of(text);
  if (day && day_) {
    since_first_ += *day - *day_;
  } else if (!text_.empty()) {
    has_unread_change_ = true;
  }
  text_ = text;
  day_ = day;
}

bool DateColumn::take_unread_change() {
  return std::exchange(has_unread_change_, false);
}

}  // namespace softgrip::sysid
