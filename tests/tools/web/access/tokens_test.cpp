#include "tools/web/access/tokens.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"

namespace softgrip::web::tokens_test {
namespace {

const std::string look(24, 'a');
const std::string operate(24, 'b');

TEST(Tokens, OnlyAListedTokenHasARole) {
  const auto tokens = Tokens::parse("# the wall\nlook " + look + "\n\n  operate\t" + operate + "\r\n");
  ASSERT_TRUE(tokens) << tokens.error();
  EXPECT_EQ(tokens->role_of(look), Role::look);
  EXPECT_EQ(tokens->role_of(operate), Role::operate);
  EXPECT_EQ(tokens->role_of(""), Role::none);
  EXPECT_EQ(tokens->role_of(look.substr(1)), Role::none);
  EXPECT_EQ(tokens->role_of(look + "a"), Role::none);
  EXPECT_EQ(tokens->role_of(std::string(23, 'a') + "c"), Role::none);
}

TEST(Tokens, RefusesAMalformedListWithoutPrintingTheTokens) {
  const auto said = [](const std::string& text) {
    const auto tokens = Tokens::parse(text);
    EXPECT_FALSE(tokens);
    const std::string message = tokens ? std::string() : tokens.error();
    EXPECT_EQ(message.find(look), std::string::npos) << "a log must not contain a token";
    return message;
  };
  EXPECT_NE(said("").find("no token"), std::string::npos);
  EXPECT_NE(said("\nall " + look).find("line 2"), std::string::npos);
  EXPECT_NE(said("look short").find("20 to 128"), std::string::npos);
  EXPECT_NE(said("look " + std::string(129, 'a')).find("20 to 128"), std::string::npos);
  EXPECT_NE(said("look " + look + "!").find("letters"), std::string::npos);
  EXPECT_NE(said("look " + look + " " + look).find("unexpected text"), std::string::npos);
  EXPECT_NE(said("look " + look + "\noperate " + look).find("earlier line"), std::string::npos);
}

TEST(Tokens, RefusesAWorldReadableFile) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/tokens";
  std::ofstream(path) << "look " << look << "\n";
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  EXPECT_TRUE(Tokens::load(path));
  ASSERT_EQ(::chmod(path.c_str(), 0644), 0);
  const auto open = Tokens::load(path);
  ASSERT_FALSE(open);
  EXPECT_NE(open.error().find("chmod o="), std::string::npos);
  std::filesystem::remove(path);
  EXPECT_FALSE(Tokens::load(path));
}

TEST(Tokens, ConstantTimeComparisonFindsOnlyEqualTexts) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
}

}  // namespace
}  // namespace softgrip::web::tokens_test
