// Writes the tables of keys in docs/reference/rig-file.md from the declarations in rig/rig_keys.cpp. A table
// is between the lines `<!-- keys: NAME -->` and `<!-- end of keys -->`. The other text of the page is not
// changed.
//   rig_file_page            prints the page
//   rig_file_page --check    exits with 1 if the page in the source tree differs from the declarations
//   rig_file_page --write    writes the page

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "rig/rig_keys.h"

namespace softgrip::rig {
namespace {

const std::string file_name = std::string(SOFTGRIP_SOURCE_DIR) + "/docs/reference/rig-file.md";
const std::string end_mark = "<!-- end of keys -->\n";

std::string text_of_file() {
  std::ostringstream text;
  text << std::ifstream(file_name, std::ios::binary).rdbuf();
  return text.str();
}

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
std::string page(int& exit_code) {
  std::string text = text_of_file();
  std::ptrdiff_t marks = 0;
  for (const auto& [name, keys] : rig_tables()) {
    const std::string mark = "<!-- keys: " + name + " -->\n";
    const std::size_t found = text.find(mark);
    const std::size_t begin = found + mark.size();
    const std::size_t end = found == std::string::npos ? found : text.find(end_mark, begin);
    if (end == std::string::npos) {
      std::cerr << file_name << " has no table with the mark " << mark;
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
    std::cerr << file_name << " has a table that is not declared\n";
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
  const std::string text = page(exit_code);
  if (mode == "--write") {
    std::ofstream file(file_name, std::ios::binary);
    file << text;
    return file.flush() ? exit_code : 4;
  }
  if (mode != "--check") {
    std::cout << text;
    return exit_code;
  }
  if (text_of_file() == text) return exit_code;
  std::cerr << file_name << " differs from the declarations; run rig_file_page --write\n";
  return 1;
}
