// Writes the tables of keys in the pages of docs/ from the declarations of the keys. A table is between the
// lines `<!-- keys: NAME -->` and `<!-- end of keys -->`. The other text of a page is not changed.
//   key_tables            prints the pages
//   key_tables --check    exits with 1 if a page in the source tree differs from the declarations
//   key_tables --write    writes the pages

#include <fstream>
#include <iostream>
#include <string>

#include "control/sequences/sequence_keys.h"
#include "rig/plc_file/settings.h"
#include "rig/rig_keys.h"
#include "rig/web_file/settings.h"
#include "simulation/emulator/fault.h"
#include "tests/support/files.h"

namespace softgrip::rig {
namespace {

struct Page {
  std::string name;
  document::KeyTables tables;
};

std::vector<Page> pages() {
  const std::string docs = std::string(SOFTGRIP_SOURCE_DIR) + "/docs/";
  return {{docs + "reference/rig-file.md", rig_tables()},
          {docs + "reference/sequence-file.md", control::sequence_tables()},
          {docs + "reference/emulator.md", {{"fault", simulation::faults_file_keys()}}},
          {docs + "reference/plc-map.md", {{"file", plc::file_keys()}}},
          {docs + "how-to/operator-page.md", {{"file", web::file_keys()}}}};
}

const std::string end_mark = "<!-- end of keys -->\n";

std::string table_of(const std::vector<document::KeyFacts>& keys) {
  std::string table = "| key | values | default | meaning |\n|---|---|---|---|\n";
  for (const document::KeyFacts& key : keys) {
    table += "| `" + key.name + "` | " + key.values + " | " + (key.required() ? "required" : key.fallback) +
             " | " + key.meaning + " |\n";
  }
  return table;
}

/// Returns the page with the tables of the declarations. The exit code is 1 if the page lacks a table, or has
/// a table that is not declared.
std::string text_of(const Page& page, int& exit_code) {
  std::string text = softgrip::test::text_of(page.name);
  std::ptrdiff_t marks = 0;
  for (const auto& [name, keys] : page.tables) {
    const std::string mark = "<!-- keys: " + name + " -->\n";
    const std::size_t found = text.find(mark);
    const std::size_t begin = found + mark.size();
    const std::size_t end = found == std::string::npos ? found : text.find(end_mark, begin);
    if (end == std::string::npos) {
      std::cerr << page.name << " has no table with the mark " << mark;
      exit_code = 1;
      continue;
    }
    text.replace(begin, end - begin, table_of(keys));
    ++marks;
  }
  for (std::size_t at = text.find("<!-- keys: "); at != std::string::npos;
       at = text.find("<!-- keys: ", at + 1))
    --marks;
  if (marks != 0) {
    std::cerr << page.name << " has a table that is not declared\n";
    exit_code = 1;
  }
  return text;
}

}  // namespace
}  // namespace softgrip::rig

int main(int argc, char** argv) {
  using namespace softgrip::rig;
  const std::string mode = argc > 1 ? argv[1] : "";
  int exit_code = 0;
  for (const Page& page : pages()) {
    const std::string text = text_of(page, exit_code);
    if (mode == "--write") {
      std::ofstream file(page.name, std::ios::binary);
      file << text;
      if (!file.flush()) return 4;
    } else if (mode == "--check" && softgrip::test::text_of(page.name) != text) {
      std::cerr << page.name << " differs from the declarations; run key_tables --write\n";
      exit_code = 1;
    } else if (mode != "--check") {
      std::cout << text;
    }
  }
  return exit_code;
}
