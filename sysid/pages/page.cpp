#include "sysid/pages/page.h"

#include "base/version.h"
#include "sysid/pages/markup.h"

namespace softgrip::sysid {
namespace {

constexpr std::string_view style = R"(
:root{color-scheme:light}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif;color:#20272c;background:#fff;max-width:820px;margin:0 auto;padding:24px 20px 64px}
h1{font-size:19px;font-weight:600;color:#5b666e;margin:0 0 10px}
h2{font-size:20px;margin:40px 0 8px;padding-top:14px;border-top:1px solid #dfe4e8}
h3{font-size:16px;margin:24px 0 6px}
p,ul{margin:8px 0;max-width:72ch}
.verdict{font-size:19px;line-height:1.4;padding:14px 18px;border-left:6px solid;margin:0 0 18px;max-width:none}
.good{border-color:#009e73;background:#eef8f5}.doubtful{border-color:#e69f00;background:#fdf6e8}.bad{border-color:#a3291f;background:#fbeeed}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;font-size:13px;color:#5b666e;margin:0}
dt{font-weight:600}dd{margin:0;overflow-wrap:anywhere}
table{border-collapse:collapse;font-size:13.5px;margin:12px 0;font-variant-numeric:tabular-nums}
caption{text-align:left;color:#5b666e;padding-bottom:4px}
th{text-align:left;font-weight:600;border-bottom:2px solid #b8c4cc}th,td{padding:3px 14px 3px 0;vertical-align:top}
td{border-bottom:1px solid #e8ecef}.n{text-align:right}td.n{white-space:nowrap}
figure{margin:14px 0}figure svg{max-width:100%;height:auto;display:block}
.row{display:flex;flex-wrap:wrap;gap:8px}.row svg{flex:1 1 340px;min-width:300px;max-width:520px}
figcaption{font-size:13px;color:#5b666e;margin-top:4px;max-width:80ch}
pre{font:12.5px/1.45 ui-monospace,monospace;background:#f5f7f8;padding:12px;overflow-x:auto}
summary{cursor:pointer;color:#0072b2}
.scroll{overflow-x:auto}
@media print{body{max-width:none;padding:0;font-size:11pt}h2{break-after:avoid}figure,tr,.verdict{break-inside:avoid}summary{display:none}pre{white-space:pre-wrap}}
)";

std::string element(std::string_view name, std::string_view text) {
  return '<' + std::string(name) + '>' + escaped(text) + "</" + std::string(name) + ">\n";
}

std::string_view class_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "good";
    case Tone::doubtful:
      return "doubtful";
    case Tone::bad:
      return "bad";
  }
  return "";
}

}  // namespace

std::string software_and_version() {
  return "softgrip " + std::string(software_version());
}

Page::Page(std::string title, std::string verdict, Tone tone)
    : title_(std::move(title)), verdict_(std::move(verdict)), tone_(tone) {}

void Page::provenance(std::vector<std::pair<std::string, std::string>> entries) {
  provenance_ = std::move(entries);
}

void Page::section(std::string_view title) {
  body_ += element("h2", title);
}
void Page::subsection(std::string_view title) {
  body_ += element("h3", title);
}
void Page::paragraph(std::string_view text) {
  body_ += element("p", text);
}
void Page::code(std::string_view text) {
  body_ += element("pre", text);
}

void Page::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += element("li", item);
  body_ += "</ul>\n";
}

void Page::table(const Table& table) {
  const auto cell = [&](std::string_view tag, std::size_t column, std::string_view text) {
    const bool numeric = column < table.numeric.size() && table.numeric[column];
    return '<' + std::string(tag) + (numeric ? " class=\"n\">" : ">") + escaped(text) + "</" +
           std::string(tag) + '>';
  };
  body_ += "<div class=\"scroll\"><table>";
  if (!table.caption.empty()) body_ += element("caption", table.caption);
  body_ += "<thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i) body_ += cell("th", i, table.header[i]);
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) body_ += cell("td", i, row[i]);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::figure(const std::vector<Chart>& stacked, std::string_view caption) {
  body_ += "<figure>" + to_svg(stacked) + element("figcaption", caption) + "</figure>\n";
}

void Page::figure(const Chart& chart, std::string_view caption) {
  figure(std::vector<Chart>{chart}, caption);
}

void Page::figure_row(const std::vector<Chart>& charts, std::string_view caption) {
  body_ += "<figure><div class=\"row\">";
  for (const Chart& chart : charts) body_ += to_svg(chart);
  body_ += "</div>" + element("figcaption", caption) + "</figure>\n";
}

std::string Page::to_html() const {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n" +
      element("title", title_) + "<style>" + std::string(style) + "</style></head>\n<body>\n" +
      element("h1", title_) + "<p class=\"verdict " + std::string(class_of(tone_)) + "\">" +
      escaped(verdict_) + "</p>\n";
  if (!provenance_.empty()) {
    html += "<dl>\n";
    for (const auto& [term, value] : provenance_) html += element("dt", term) + element("dd", value);
    html += "</dl>\n";
  }
  return html + body_ + "</body></html>\n";
}

}  // namespace softgrip::sysid
