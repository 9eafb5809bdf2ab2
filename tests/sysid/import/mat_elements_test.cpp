#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <string>

namespace softgrip::sysid::mat_elements_test {
namespace {

std::string word(std::uint32_t value) {
  std::string bytes;
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(value >> shift));
  return bytes;
}

std::string element(std::uint32_t type, const std::string& data) {
  std::string bytes = word(type) + word(static_cast<std::uint32_t>(data.size())) + data;
  bytes.resize((bytes.size() + 7) / 8 * 8);
  return bytes;
}

std::string array(std::uint32_t kind, const std::string& parts) {
  return element(
      14, element(6, word(kind) + word(0)) + element(5, word(1) + word(10)) + element(1, "name") + parts);
}

/// Returns a variable with the numbers of a text element; the dimensions state `rows` rows.
std::string column(const std::string& name, std::uint32_t rows, const std::string& data) {
  return element(14, element(6, word(6) + word(0)) + element(5, word(rows) + word(1)) + element(1, name) +
                         element(9, data));
}

std::string compressed(const std::string& bytes) {
  std::string packed(::compressBound(bytes.size()), '\0');
  auto size = static_cast<uLongf>(packed.size());
  EXPECT_EQ(::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                        reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 9),
            Z_OK);
  packed.resize(size);
  return word(15) + word(static_cast<std::uint32_t>(packed.size())) + packed;
}

std::string file(const std::string& elements) {
  std::string header = "MATLAB 5.0 MAT-file";
  header.resize(124, ' ');
  return header + std::string("\x00\x01IM", 4) + elements;
}

constexpr std::uint32_t cell = 1, structure = 2, numbers = 6;
const std::string small_array = array(numbers, element(9, std::string(80, 'x')));

/// Returns the number of variables, or the messages of the refusal.
std::string outcome(const std::string& bytes, std::size_t most_parts = 100, std::size_t most_bytes = 10'000) {
  document::Problems problems;
  const auto variables = mat_variables("m.mat", bytes, most_parts, most_bytes, problems);
  EXPECT_EQ(variables.has_value(), problems.empty());
  return variables ? std::to_string(*variables) : problems.format();
}

bool is_within(const std::string& bytes, std::size_t most_parts, std::size_t most_bytes) {
  return outcome(bytes, most_parts, most_bytes).find("parts, or more than 1 GiB") == std::string::npos;
}

bool is_damaged(const std::string& bytes, const std::string& where) {
  return outcome(bytes).find("cannot be read: it is cut off or damaged in " + where) != std::string::npos;
}

TEST(MatElements, OrdinaryFilesAreWithinTheLimits) {
  const std::string run =
      array(structure, element(5, word(8)) + element(1, "tip") + small_array + small_array);
  for (const std::string& elements :
       {std::string(), small_array, run + run, compressed(run) + compressed(small_array)})
    EXPECT_EQ(outcome(file(elements)).find("m.mat"), std::string::npos);
}

TEST(MatElements, PartsOfAllCellsAndStructuresAreCounted) {
  const std::string empty_cells = array(cell, std::string(std::size_t{8} * 60, '\0'));
  const std::string nested = array(structure, array(cell, std::string(std::size_t{8} * 60, '\0')));
  for (const std::string& one : {empty_cells, compressed(empty_cells), nested, compressed(nested)}) {
    EXPECT_TRUE(is_within(file(small_array + one), 100, 10'000));
    EXPECT_FALSE(is_within(file(one + one), 100, 10'000));
  }
}

TEST(MatElements, MillionsOfEmptyCellsInAFewKilobytesAreRefused) {
  const std::string bomb = file(compressed(array(cell, std::string(std::size_t{100} << 20U, '\0'))));
  EXPECT_LT(bomb.size(), std::size_t{200'000});
  EXPECT_FALSE(is_within(bomb, 100'000, std::size_t{1} << 30U));
}

TEST(MatElements, TotalBytesAreLimited) {
  const std::string texts = compressed(array(cell, array(4, element(4, std::string(5000, 'x')))));
  EXPECT_TRUE(is_within(file(texts), 100, 10'000));
  EXPECT_FALSE(is_within(file(texts + texts), 100, 10'000));
}

TEST(MatElements, ArraysOfNumbersAreNotCounted) {
  std::string many;
  for (int i = 0; i < 500; ++i) many += small_array;
  EXPECT_TRUE(is_within(file(many), 100, std::size_t{1} << 20U));
}

/// libmatio returns arbitrary values for the missing part of a variable, so the file must be refused.
TEST(MatElements, CutOffFileIsRefused) {
  const std::string run = array(structure, element(5, word(8)) + element(1, "tip") + small_array);
  for (const std::string& last : {column("tip", 10, std::string(80, 'x')), run, compressed(run)}) {
    const std::string first = file(small_array);
    EXPECT_EQ(outcome(first + last), "2");
    for (std::size_t size = 1; size < last.size(); ++size)
      EXPECT_TRUE(is_damaged(first + last.substr(0, size), "")) << size;
    EXPECT_TRUE(
        is_damaged(first + last.substr(0, 4), "the data element at byte " + std::to_string(first.size())));
  }
  const std::string tip = column("tip", 10, std::string(80, 'x'));
  EXPECT_TRUE(is_damaged(file(tip.substr(0, tip.size() - 40)), "the variable 'tip'"));
}

TEST(MatElements, ChangedBitOfACompressedVariableIsRefused) {
  const std::string good = file(compressed(small_array));
  for (std::size_t at = 136; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    EXPECT_NE(outcome(bad), "1") << at;
  }
}

TEST(MatElements, SizesThatDoNotAgreeAreRefused) {
  const std::string data(80, 'x');
  EXPECT_EQ(outcome(file(column("tip", 10, data))), "1");
  EXPECT_TRUE(is_damaged(file(column("tip", 11, data)), "the variable 'tip'"));
  EXPECT_TRUE(is_damaged(file(compressed(column("tip", 11, data))), "the variable 'tip'"));
  EXPECT_TRUE(is_damaged(file(array(cell, column("", 11, data))), "the variable 'name'"));
  EXPECT_TRUE(is_damaged(file(std::string(100, '\0')), "the data element at byte 128"));
}

/// The import skips an array that is too large. Its values are not decompressed, so that a file of a few
/// bytes does not take minutes.
TEST(MatElements, TooLargeArrayIsNotDecompressed) {
  const std::string large = column("large", 2000, std::string(16'000, 'x'));
  std::string packed = compressed(large);
  packed.back() = static_cast<char>(packed.back() ^ 1);
  EXPECT_EQ(outcome(file(packed), 100, 10'000), "1");
  EXPECT_NE(outcome(file(packed), 100, 20'000), "1");
}

/// A variable of version 4 has five numbers, a name and the values.
TEST(MatElements, CutOffFileOfVersion4IsRefused) {
  const auto variable = [](const std::string& name, std::uint32_t imaginary) {
    return word(0) + word(10) + word(1) + word(imaginary) +
           word(static_cast<std::uint32_t>(name.size() + 1)) + name + '\0' +
           std::string(std::size_t{80} << imaginary, 'x');
  };
  const std::string good = variable("set", 1) + variable("tip", 0);
  EXPECT_EQ(outcome(good), "2");
  for (std::size_t size = variable("set", 1).size() + 1; size < good.size(); ++size)
    EXPECT_TRUE(is_damaged(good.substr(0, size), "")) << size;
  EXPECT_TRUE(is_damaged(good.substr(0, good.size() - 40), "the variable 'tip'"));
}

TEST(MatElements, CorruptFilesDoNotCrash) {
  const std::string good = file(compressed(array(cell, small_array)) + array(structure, small_array));
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string broken = good;
    broken[at] = static_cast<char>(broken[at] ^ '\xff');
    (void)outcome(broken);
  }
  EXPECT_EQ(outcome(good), "2");
}

}  // namespace
}  // namespace softgrip::sysid::mat_elements_test
