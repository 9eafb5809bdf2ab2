#pragma once
// The self-contained HTML page that every report is: verdict first, then provenance, then sections.
//
// Readable without JavaScript (there is none), no reference to anything outside, prints well. Every text is
// escaped here; only pictures made by sysid/pages/chart.h enter as markup.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// The colour beside a verdict.
enum class Tone { good, doubtful, bad };

/// A table. `numeric` columns are set flush right; missing entries count as text.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<bool> numeric;
  std::vector<std::vector<std::string>> rows;
};

/// A report, built from top to bottom.
class Page {
 public:
  /// @param title  of the document. @param verdict  one sentence that a technician understands.
  Page(std::string title, std::string verdict, Tone tone);

  /// Terms and their values under "Provenance", right below the verdict (versions, files, hashes).
  void provenance(std::vector<std::pair<std::string, std::string>> entries);
  void section(std::string_view title);
  void subsection(std::string_view title);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void table(const Table& table);
  void figure(const std::vector<Chart>& stacked, std::string_view caption);
  void figure(const Chart& chart, std::string_view caption);
  /// Two or more charts side by side where the page is wide enough.
  void figure_row(const std::vector<Chart>& charts, std::string_view caption);
  /// A text in its own lines, in a fixed-width font (a model file).
  void code(std::string_view text);

  /// Bytes of the page's body so far.
  [[nodiscard]] std::size_t size() const noexcept { return body_.size(); }
  [[nodiscard]] std::string to_html() const;

 private:
  std::string title_;
  std::string verdict_;
  Tone tone_;
  std::vector<std::pair<std::string, std::string>> provenance_;
  std::string body_;
};

/// Software name and version, first entry of every provenance.
[[nodiscard]] std::string software_and_version();

}  // namespace softgrip::sysid
