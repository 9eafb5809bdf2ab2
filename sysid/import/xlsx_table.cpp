#include "sysid/import/table_readers.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "base/text.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/workbook_package.h"
#include "sysid/import/workbook_sheet.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_sheets = 1000;
constexpr const char* as_csv = "export the sheet as CSV";

/// A reference from one part (file) of the workbook package to another part.
struct Relation {
  /// Kind of the target, such as "worksheet": the last word of the address in the attribute Type.
  std::string type;
  std::string part;
  bool external = false;
};
using Relations = std::map<std::string, Relation>;

struct Sheet {
  std::string name;
  std::string part;
  bool is_table = true;  ///< true: the sheet contains cells; false: the sheet is a chart or a macro
};

std::string quoted_name(const std::string& name) {
  return "'" + document::shown(name) + "'";
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most_named = 20;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most_named)));
  return with_commas(first, quoted_name) + (names.size() > most_named ? ", ..." : "");
}

class WorkbookReader {
 public:
  WorkbookReader(const std::string& file, WorkbookPackage package, const TableOptions& options,
                 document::Problems& problems)
      : file_(file), package_(std::move(package)), options_(options), problems_(problems) {}

  std::optional<ForeignTable> read() {
    const auto book = book_part();
    if (!book || !read_book(*book)) return std::nullopt;
    const auto sheet = options_.sheet.empty() ? only_sheet() : named_sheet();
    if (!sheet) return std::nullopt;
    return table_of(*sheet);
  }

 private:
  std::nullopt_t refuse(const std::string& message, const std::string& hint = as_csv) {
    problems_.add({file_, {1, 1}, {}, message, hint});
    return std::nullopt;
  }

  [[nodiscard]] std::string file_of(const Sheet& sheet) const {
    return file_ + ", sheet " + quoted_name(sheet.name);
  }

  /// Loads the XML of a part of the workbook into `document_`, and its characters into `text_`. Returns false
  /// if the part was refused.
  bool load(const std::string& part, const std::string& file) {
    auto text = package_.read(part);
    if (!text) {
      problems_.add({file, {1, 1}, {}, text.error(), as_csv});
      return false;
    }
    document_.reset();
    text_ = std::move(*text);
    const auto loaded = load_xml(text_, document_);
    if (!loaded)
      problems_.add({file,
                     {1, 1},
                     {},
                     "part '" + document::shown(part) + "' cannot be read: " + loaded.error(),
                     as_csv});
    return loaded.has_value();
  }

  /// Returns the relations of the part `name` in the folder `folder`. The keys of the result are the ids of
  /// the relations.
  std::optional<Relations> relations(const std::string& folder, const std::string& name) {
    const std::string part = folder + "_rels/" + name + ".rels";
    if (!load(part, file_)) return std::nullopt;
    Relations relations;
    for (const pugi::xml_node& node : document_.document_element().children()) {
      const std::string type(attribute_of(node, "Type"));
      const std::string target(attribute_of(node, "Target"));
      const std::string path = target.starts_with('/') ? target.substr(1) : folder + target;
      relations[std::string(attribute_of(node, "Id"))] = {
          type.substr(type.rfind('/') + 1), std::filesystem::path(path).lexically_normal().string(),
          attribute_of(node, "TargetMode") == "External"};
    }
    return relations;
  }

  /// Returns the path of the part of the workbook that lists the sheets.
  std::optional<std::string> book_part() {
    if (!package_.has("_rels/.rels")) {
      if (package_.has("content.xml"))
        return refuse("this is an OpenDocument spreadsheet (.ods)",
                      "save the file as .xlsx, or export the sheet as CSV");
      return refuse("this is an archive, not a workbook", "unpack it");
    }
    const auto found = relations("", "");
    if (!found) return std::nullopt;
    for (const auto& [id, relation] : *found) {
      if (relation.type != "officeDocument" || relation.external) continue;
      if (relation.part.ends_with(".bin"))
        return refuse("this is a binary workbook (.xlsb)",
                      "save the file as .xlsx, or export the sheet as CSV");
      return relation.part;
    }
    return refuse("this is an archive, not a workbook", "unpack it");
  }

  /// Reads the list of sheets, the shared strings and the styles.
  bool read_book(const std::string& part) {
    const std::size_t slash = part.rfind('/');
    const std::string folder = slash == std::string::npos ? std::string() : part.substr(0, slash + 1);
    const auto found = relations(folder, part.substr(folder.size()));
    if (!found || !load(part, file_)) return false;
    if (!read_sheets(*found)) return false;
    for (const char* type : {"sharedStrings", "styles"}) {
      const auto parts = std::count_if(found->begin(), found->end(),
                                       [&](const auto& entry) { return entry.second.type == type; });
      if (parts > 1) {
        refuse("it has " + std::to_string(parts) + " parts '" + type + "' where at most 1 is expected");
        return false;
      }
    }
    const bool good = std::all_of(found->begin(), found->end(), [this](const auto& entry) {
      const Relation& relation = entry.second;
      if (relation.external) return true;
      if (relation.type == "sharedStrings") return read_strings(relation.part);
      return relation.type != "styles" || read_styles(relation.part);
    });
    return good;
  }

  bool read_sheets(const Relations& relations) {
    const pugi::xml_node root = document_.document_element();
    if (local_name(root.name()) != "workbook") {
      refuse("this is a document of an office program, not a workbook");
      return false;
    }
    texts_.from_1904 = is_true(attribute_of(child_of(root, "workbookPr"), "date1904"));
    for (const pugi::xml_node& node : child_of(root, "sheets").children()) {
      const std::string name(attribute_of(node, "name"));
      const auto found = relations.find(std::string(attribute_of(node, "id")));
      if (found == relations.end() || found->second.external) {
        refuse("sheet " + quoted_name(name) + " is not in the file");
        return false;
      }
      sheets_.push_back({name, found->second.part, found->second.type == "worksheet"});
      if (sheets_.size() > most_sheets) {
        refuse("the workbook has more than " + std::to_string(most_sheets) + " sheets");
        return false;
      }
    }
    return true;
  }

  bool read_strings(const std::string& part) {
    if (!load(part, file_)) return false;
    for (const pugi::xml_node& node : document_.document_element().children()) {
      if (local_name(node.name()) == "si") texts_.strings.push_back(string_in(node));
    }
    return true;
  }

  bool read_styles(const std::string& part) {
    if (!load(part, file_)) return false;
    const pugi::xml_node root = document_.document_element();
    std::map<std::string, bool, std::less<>> own;
    for (const pugi::xml_node& format : child_of(root, "numFmts").children())
      own[std::string(attribute_of(format, "numFmtId"))] = is_date_format(attribute_of(format, "formatCode"));
    for (const pugi::xml_node& style : child_of(root, "cellXfs").children()) {
      const std::string_view id = attribute_of(style, "numFmtId");
      const auto found = own.find(id);
      const std::size_t number = whole_number(id).value_or(0);
      texts_.date_styles.push_back(found == own.end() ? is_date_format(number) : found->second);
    }
    return true;
  }

  /// Returns the text of a sheet, or nullopt if the sheet is refused.
  std::optional<SheetText> text_of(const Sheet& sheet) {
    if (!load(sheet.part, file_of(sheet))) return std::nullopt;
    auto text = sheet_text(document_, texts_);
    if (text) return std::move(*text);
    problems_.add({file_of(sheet), text.error().at, {}, text.error().message, as_csv});
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Sheet& sheet : sheets_) names.push_back(sheet.name);
    return names;
  }

  std::optional<Sheet> named_sheet() {
    const auto found = std::find_if(sheets_.begin(), sheets_.end(),
                                    [this](const Sheet& sheet) { return sheet.name == options_.sheet; });
    if (found == sheets_.end())
      return refuse("no sheet " + quoted_name(options_.sheet), "the sheets are " + listed(names()));
    if (!found->is_table) return refuse("sheet " + quoted_name(found->name) + " is a chart, not a table");
    for (const Sheet& sheet : sheets_) {
      if (sheet.name != found->name) others_.push_back("sheet " + quoted_name(sheet.name) + " is not used");
    }
    return choose(*found);
  }

  std::optional<Sheet> choose(const Sheet& sheet) {
    auto text = text_of(sheet);
    if (!text) return std::nullopt;
    chosen_ = std::move(*text);
    return sheet;
  }

  std::optional<Sheet> only_sheet() {
    std::vector<std::string> with_numbers;
    std::optional<Sheet> found;
    for (const Sheet& sheet : sheets_) {
      if (!sheet.is_table) {
        others_.push_back("sheet " + quoted_name(sheet.name) +
                          " is skipped, because this sheet is a chart and not a table");
        continue;
      }
      auto text = text_of(sheet);
      if (!text) return std::nullopt;
      if (text->rows_of_numbers < 2) {
        others_.push_back("sheet " + quoted_name(sheet.name) +
                          " is skipped, because this sheet does not have two rows of numbers");
        continue;
      }
      with_numbers.push_back(sheet.name);
      if (with_numbers.size() > 1) continue;
      found = sheet;
      chosen_ = std::move(*text);
    }
    if (with_numbers.size() > 1)
      return refuse(
          std::to_string(with_numbers.size()) + " sheets have rows of numbers: " + listed(with_numbers),
          std::string(select_sheet_hint));
    if (!found)
      return refuse("no sheet has two rows of numbers in two or more columns",
                    "the sheets are " + listed(names()));
    return found;
  }

  std::optional<ForeignTable> table_of(const Sheet& sheet) {
    TableOptions options = options_;
    options.separator = ',';
    auto table = parse_text_table(file_of(sheet), chosen_.text, options, problems_);
    if (!table) return std::nullopt;
    table->has_separators = false;
    table->sheet = sheet.name;
    table->format = "workbook (.xlsx), sheet " + quoted_name(sheet.name) + ", rows " +
                    std::to_string(chosen_.first_row) + " to " + std::to_string(chosen_.last_row);
    for (std::vector<std::string>* notes : {&chosen_.notes, &others_})
      table->notes.insert(table->notes.end(), notes->begin(), notes->end());
    name_bad_cells(*table);
    return table;
  }

  /// Adds to each bad cell its name in the sheet, such as "B7".
  void name_bad_cells(ForeignTable& table) const {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      for (BadCell& bad : table.columns[i].bad)
        bad.cell = cell_name(static_cast<std::size_t>(bad.at.line), chosen_.first_column + i);
    }
  }

  const std::string& file_;
  WorkbookPackage package_;
  const TableOptions& options_;
  document::Problems& problems_;
  std::string text_;  ///< text to whose characters `document_` refers
  pugi::xml_document document_;
  WorkbookTexts texts_;
  std::vector<Sheet> sheets_;
  SheetText chosen_;
  std::vector<std::string> others_;  ///< notes about the sheets that are not read
};

}  // namespace

std::optional<ForeignTable> read_xlsx_table(const std::string& file, std::string_view bytes,
                                            const TableOptions& options, document::Problems& problems) {
  auto package = WorkbookPackage::open(bytes);
  if (package) return WorkbookReader(file, std::move(*package), options, problems).read();
  problems.add({file, {1, 1}, {}, package.error(), as_csv});
  return std::nullopt;
}

}  // namespace softgrip::sysid
