#include "sysid/logs/division.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// Width of the gap on either side of a held-out block, as a share of the block. Readings in the gap are not
/// fitted.
constexpr double gap_share = 0.1;
constexpr std::size_t fewest_blocks = 8;
/// If there are fewer blocks than this, they are divided into four folds, because half of so small a number
/// of blocks does not determine a model. Otherwise the blocks are divided into two folds.
constexpr std::size_t enough_to_halve = 16;
constexpr std::size_t fifths = 5;
constexpr double blocks_of_fifths = 10;
constexpr std::size_t blocks_of_a_half = 5;

double length_of(const std::vector<Record>& records) {
  double length_s = 0;
  for (const Record& record : records) length_s += record.length_s();
  return length_s;
}

void alternate_folds(Division& division, std::size_t folds) {
  division.folds = folds;
  for (std::size_t b = 0; b < division.blocks.size(); ++b) division.blocks[b].fold = b % folds;
}

void hide_beside(const std::vector<Record>& records, Division& division) {
  for (Block& block : division.blocks) {
    const std::vector<double>& t = records[block.record].time_s;
    block.hidden_first = block.first;
    block.hidden_last = block.last;
    if (block.first == block.last) continue;
    while (block.hidden_first > 0 && t[block.hidden_first - 1] >= t[block.first] - division.gap_s)
      --block.hidden_first;
    while (block.hidden_last < t.size() && t[block.hidden_last] <= t[block.last - 1] + division.gap_s)
      ++block.hidden_last;
  }
}

}  // namespace

Division divide(const std::vector<Record>& records, double block_s) {
  const double wanted_s = std::min(block_s, length_of(records) / fewest_blocks);
  Division division;
  division.gap_s = gap_share * wanted_s;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Record& record = records[k];
    const double record_s = record.length_s();
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(record_s / wanted_s)));
    std::size_t first = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      const double end_s =
          record.time_s.front() + record_s * static_cast<double>(part + 1) / static_cast<double>(parts);
      std::size_t last = first;
      while (last < record.size() && (record.time_s[last] < end_s || part + 1 == parts)) ++last;
      if (last > first) division.blocks.push_back({k, first, last});
      first = last;
    }
  }
  remove_unread_blocks(records, division);
  alternate_folds(division, division.blocks.size() < enough_to_halve ? 4 : 2);
  hide_beside(records, division);
  return division;
}

Division thinned_like(Division division, const std::vector<Record>& records,
                      const std::vector<Record>& thinned) {
  for (Block& block : division.blocks) {
    const std::vector<double>& all = records[block.record].time_s;
    const std::vector<double>& left = thinned[block.record].time_s;
    const auto index_of = [&](std::size_t sample) {
      if (sample >= all.size()) return left.size();
      return static_cast<std::size_t>(std::lower_bound(left.begin(), left.end(), all[sample]) - left.begin());
    };
    block.first = index_of(block.first);
    block.last = index_of(block.last);
  }
  remove_unread_blocks(thinned, division);
  hide_beside(thinned, division);
  return division;
}

Division divide_into_fifths(const std::vector<Record>& records) {
  const double total_s = length_of(records);
  Division division;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Record& record = records[k];
    std::size_t end = record.size();
    while (end > 0 && !std::isfinite(record.reading_mm[end - 1])) --end;
    const double fewest = records.size() > 1 ? 2 : static_cast<double>(fifths);
    const auto count = static_cast<std::size_t>(
        std::max(fewest, std::round(blocks_of_fifths * record.length_s() / total_s)));
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t first = b * end / count, last = (b + 1) * end / count;
      const auto gap = static_cast<std::size_t>(gap_share * static_cast<double>(last - first));
      division.blocks.push_back(
          {k, first, last, 0, first > gap ? first - gap : 0, std::min(last + gap, record.size())});
    }
  }
  remove_unread_blocks(records, division);
  alternate_folds(division, fifths);
  return division;
}

Division divide_into_halves(const std::vector<Record>& records) {
  Division division;
  division.folds = 1;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const std::size_t size = records[k].size(), begin = size / 2, length = size - begin;
    for (std::size_t b = 0; b < blocks_of_a_half; ++b) {
      division.blocks.push_back({k, begin + b * length / blocks_of_a_half,
                                 begin + (b + 1) * length / blocks_of_a_half, 0, begin, size});
    }
  }
  remove_unread_blocks(records, division);
  return division;
}

void remove_unread_blocks(const std::vector<Record>& records, Division& division) {
  const auto is_read = [&](const Block& block) {
    const std::vector<double>& reading_mm = records[block.record].reading_mm;
    const auto at = [&](std::size_t i) { return reading_mm.begin() + static_cast<std::ptrdiff_t>(i); };
    return std::any_of(at(block.first), at(block.last), [](double y) { return std::isfinite(y); });
  };
  if (std::any_of(division.blocks.begin(), division.blocks.end(), is_read))
    std::erase_if(division.blocks, [&](const Block& block) { return !is_read(block); });
}

void hide_readings(Record& record, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
  record.readings = finite_count(record.reading_mm);
}

std::vector<Record> with_first_readings(std::vector<Record> records, double share) {
  for (Record& record : records) {
    const auto last = static_cast<std::size_t>(share * static_cast<double>(record.size()));
    hide_readings(record, last, record.size());
  }
  return records;
}

std::vector<Record> without_fold(std::vector<Record> records, const Division& division, std::size_t fold) {
  for (const Block& block : division.blocks) {
    if (block.fold == fold) hide_readings(records[block.record], block.hidden_first, block.hidden_last);
  }
  return records;
}

}  // namespace softgrip::sysid
