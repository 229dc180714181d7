// TOML documents that would take the parser's stack or its time.

#include "sim_host/world/scenario/toml_shape.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "sim_host/world/scenario/toml_table.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::string error_of(const std::string& text) {
  const test::Folder folder;
  try {
    static_cast<void>(parse_toml(folder.write("a.toml", text)));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// FILE-001 100,000 brackets within each other ended the program; so did braces, and both in turn.
TEST(TomlShape, DeepNestingIsRefused) {
  for (const std::string open : {"[", "{a=", "[{a="}) {
    const std::string error = error_of("\nx = " + repeated(open, 100'000));
    EXPECT_NE(error.find("line 2: nested more than 32 deep"), std::string::npos) << open << ": " << error;
  }
}

// FILE-001 A key of 200,000 parts took the parser longer than anybody waits; also in a table's name, and with
// its parts in quotes.
TEST(TomlShape, LongKeysAreRefused) {
  const auto begin = std::chrono::steady_clock::now();
  for (const std::string& text :
       {"a" + repeated(".a", 200'000) + " = 1", "[a" + repeated(".a", 200'000) + "]",
        "x = {\"a\"" + repeated(". 'a'", 100'000) + " = 1}"}) {
    EXPECT_NE(error_of(text).find("a key of more than 32 parts"), std::string::npos)
        << error_of(text).substr(0, 200);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

// FILE-001 What is only text or a list counts for nothing: dots and brackets in strings of every kind and in
// comments, a long list of numbers, 32 deep and 32 parts exactly.
TEST(TomlShape, WhatDoesNotNestPasses) {
  const std::string brackets = repeated("[.", 100);
  EXPECT_EQ(error_of("a = \"" + brackets + "\\\"" + brackets + "\"\nb = '" + brackets + "'\nc = \"\"\"\n" +
                     brackets + "\n\"" + brackets + "\"\"\"\nd = '''" + brackets + "'''\n# " + brackets +
                     "\ne = [" + repeated("1.5, ", 1000) + "1.5]\nf = " + repeated("[", 32) +
                     repeated("]", 32) + "\ng" + repeated(".g", 31) + " = 1\n"),
            "no error");
  EXPECT_NE(error_of("g" + repeated(".g", 32) + " = 1").find("32 parts"), std::string::npos);
  EXPECT_NE(error_of("f = " + repeated("[", 33) + repeated("]", 33)).find("32 deep"), std::string::npos);
}

// FILE-001 Letters beyond ASCII within single quotes, where the library reads past the text's end, are refused by their line;
// within double quotes and in comments they are text.
TEST(TomlShape, SingleQuotesHoldAscii) {
  for (const std::string text : {"\n'\xA4'", "\na = 'caf\xC3\xA9'", "\nb = '''\xB0\n'''"})
    EXPECT_NE(error_of(text).find("line 2: letters beyond ASCII"), std::string::npos) << error_of(text);
  EXPECT_EQ(error_of("a = \"caf\xC3\xA9\"  # \xC3\xA9's\n"), "no error");
}

// FILE-001 A file is of a size somebody may have written, and a file.
TEST(TomlShape, OnlyFilesOfSomeSize) {
  EXPECT_NE(error_of(std::string(kTomlBytes + 1, '\n')).find("longer than"), std::string::npos);
  EXPECT_THROW(static_cast<void>(parse_toml("/dev/zero")), std::runtime_error);
  EXPECT_THROW(static_cast<void>(parse_toml("/tmp")), std::runtime_error);
}

}  // namespace
}  // namespace s4tp::scenario
