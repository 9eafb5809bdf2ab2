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
      14, element(6, word(kind) + word(0)) + element(5, word(1) + word(1)) + element(1, "name") + parts);
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

TEST(MatElements, OrdinaryFilesAreWithinTheLimits) {
  const std::string run =
      array(structure, element(5, word(8)) + element(1, "tip") + small_array + small_array);
  for (const std::string& elements :
       {std::string(), small_array, run + run, compressed(run) + compressed(small_array)})
    EXPECT_TRUE(mat_elements_within(file(elements), 100, 10'000));
}

TEST(MatElements, PartsOfAllCellsAndStructuresAreCounted) {
  const std::string empty_cells = array(cell, std::string(std::size_t{8} * 60, '\0'));
  const std::string nested = array(structure, array(cell, std::string(std::size_t{8} * 60, '\0')));
  for (const std::string& one : {empty_cells, compressed(empty_cells), nested, compressed(nested)}) {
    EXPECT_TRUE(mat_elements_within(file(small_array + one), 100, 10'000));
    EXPECT_FALSE(mat_elements_within(file(one + one), 100, 10'000));
  }
}

TEST(MatElements, MillionsOfEmptyCellsInAFewKilobytesAreRefused) {
  const std::string bomb = file(compressed(array(cell, std::string(std::size_t{100} << 20U, '\0'))));
  EXPECT_LT(bomb.size(), std::size_t{200'000});
  EXPECT_FALSE(mat_elements_within(bomb, 100'000, std::size_t{1} << 30U));
}

TEST(MatElements, TotalBytesAreLimited) {
  const std::string texts = compressed(array(cell, array(4, element(4, std::string(5000, 'x')))));
  EXPECT_TRUE(mat_elements_within(file(texts), 100, 10'000));
  EXPECT_FALSE(mat_elements_within(file(texts + texts), 100, 10'000));
}

TEST(MatElements, ArraysOfNumbersAreNotCounted) {
  std::string many;
  for (int i = 0; i < 500; ++i) many += small_array;
  EXPECT_TRUE(mat_elements_within(file(many), 100, std::size_t{1} << 20U));
}

TEST(MatElements, TruncatedOrCorruptFilesDoNotCrash) {
  const std::string good = file(compressed(array(cell, small_array)) + array(structure, small_array));
  for (std::size_t size = 0; size < good.size(); ++size) {
    std::string broken = good.substr(0, size);
    (void)mat_elements_within(broken, 100, 10'000);
    broken = good;
    broken[size] = static_cast<char>(broken[size] ^ '\xff');
    (void)mat_elements_within(broken, 100, 10'000);
  }
  EXPECT_TRUE(mat_elements_within(good, 100, 10'000));
}

}  // namespace
}  // namespace softgrip::sysid::mat_elements_test
