// Tests the JSON reader: what it accepts, what it rejects, and at which position.
#include "io/scene_json.h"

#include <vector>

#include "scene_support.h"
#include "support/paths.h"

namespace pliant::scene_file {
namespace {

namespace fs = std::filesystem;

/// The error text; empty if the text is accepted.
std::string json_message(const std::string& text) {
  try {
    parse_json(text, "x.json");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::vector<fs::path> suite() {
  std::vector<fs::path> files;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(test::in_shared_data("json/JSONTestSuite"), absent))
    files.push_back(entry.path());
  return files;
}

TEST(SceneJson, TreatsEveryFileOfTheSuiteAsItsNameSays) {
  const std::vector<fs::path> files = suite();
  if (files.empty()) GTEST_SKIP() << "the shared data is not here";
  for (const fs::path& file : files) {
    const std::string message = json_message(test::text_of(file));
    const char kind = file.filename().string()[0];
    if (kind == 'y') {
      EXPECT_EQ(message, "") << file;
    }
    if (kind == 'n') {
      EXPECT_NE(message, "") << file;
    }
    EXPECT_TRUE(message.empty() || message.compare(0, 7, "x.json:") == 0) << file << ": " << message;
  }
}

TEST(SceneJson, NamesLineAndColumnOfEveryValue) {
  const JsonDocument document =
      parse_json("{ \"a\" : [1,\n  -2.5e1 ,\"x\\\"]\" ],\r\n\t\"b/~\":{\"c\":null}}", "x.json");
  const JsonValue& list = document.root.items.at(0);
  const auto place = [&](const JsonValue& value) {
    const Location at = document.locate(value);
    return std::to_string(at.line) + ":" + std::to_string(at.column) + " " + at.element;
  };
  EXPECT_EQ(place(document.root), "1:1 /");
  EXPECT_EQ(place(list), "1:9 /a");
  EXPECT_EQ(place(list.items.at(0)), "1:10 /a/0");
  EXPECT_EQ(place(list.items.at(1)), "2:3 /a/1");
  EXPECT_EQ(place(list.items.at(2)), "2:11 /a/2");
  EXPECT_EQ(place(document.root.items.at(1)), "3:8 /b~1~0");
  EXPECT_EQ(place(document.root.items.at(1).items.at(0)), "3:13 /b~1~0/c");
  EXPECT_EQ(document.locate_byte(document.root.items.at(1).key_offset).column, 2);
  EXPECT_EQ(list.items.at(1).number, -25);
  EXPECT_EQ(list.items.at(2).text, "x\"]");
}

TEST(SceneJson, NamesLineAndColumnOfAnError) {
  EXPECT_EQ(json_message("{\n \"a\": 1,\n}").compare(0, 23, "x.json:3:1: not valid J"), 0);
  EXPECT_EQ(json_message("[1 2]").compare(0, 13, "x.json:1:4: n"), 0);
  EXPECT_EQ(json_message("\n[\"a\x01\"]").compare(0, 13, "x.json:2:4: n"), 0);
  EXPECT_EQ(json_message("").compare(0, 13, "x.json:1:1: n"), 0);
}

TEST(SceneJson, SaysWhatToDoAboutTheUsualSlips) {
  const auto advice = [](const std::string& text) {
    const std::string message = json_message(text);
    return message.substr(message.rfind("; ") + 2);
  };
  EXPECT_EQ(advice("{\"a\": 1,\n}"), "remove the comma before it");
  EXPECT_EQ(advice("[1, ]"), "remove the comma before it");
  EXPECT_EQ(advice("[1 2]"), "a comma is missing before it");
  EXPECT_EQ(advice("{\"a\": 1 \"b\": 2}"), "a comma is missing before it");
  EXPECT_EQ(advice("{} {}"), "nothing may follow the last bracket");
  EXPECT_EQ(advice("[1] // one"), "JSON has no comments: remove this one");
  EXPECT_EQ(advice("{# one\n}"), "JSON has no comments: remove this one");
  EXPECT_EQ(advice("{'a': 1}"), "write names and text in double quotes");
  EXPECT_EQ(advice("{a: 1}"), "write names and text in double quotes");
  EXPECT_EQ(advice("[.5]"), "a number starts with a digit or a minus, such as 0.5");
  for (const char* number : {"NaN", "nan", "-Infinity", "inf"})
    EXPECT_EQ(advice(std::string("[") + number + "]"), "scenes contain only finite numbers") << number;
  EXPECT_EQ(advice("[True]"), "write true");
  EXPECT_EQ(advice("[007]"), "a number has no leading zeros");
  EXPECT_EQ(advice("{\"a\": 1, # one\n \"b\": 2}"), "JSON has no comments: remove this one");
  EXPECT_EQ(advice("[{\"a\": 1"), "the file is truncated, or a bracket is not closed");
  EXPECT_EQ(advice(""), "the file is empty");
}

TEST(SceneJson, CapsTheDepth) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(json_message(nested(64)), "");
  EXPECT_EQ(json_message(nested(65)), "x.json:1:65: nested more than 64 deep; scenes never need so many levels");
  EXPECT_NE(json_message(std::string(1000000, '[')), "");
}

TEST(SceneJson, RefusesNumbersThatNoDoubleHoldsByPath) {
  EXPECT_EQ(json_message("{\"a\": [0,\n1e400]}").compare(0, 17, "x.json:2:1: /a/1:"), 0);
  EXPECT_EQ(json_message("{\"a\": NaN}").compare(0, 13, "x.json:1:7: n"), 0);
  EXPECT_NE(json_message("[Infinity]"), "");
}

TEST(SceneJson, RefusesZeroBytesAndBadUtf8ButSkipsAByteOrderMark) {
  EXPECT_NE(json_message(std::string("{}\0}", 4)), "");
  EXPECT_NE(json_message("[\"\xC0\xAF\"]"), "");
  EXPECT_EQ(json_message("\xEF\xBB\xBF{}"), "");
  EXPECT_NE(json_message("\xEF\xBB\xBF\xEF\xBB\xBF{}"), "");
  EXPECT_NE(json_message(std::string("\xFF\xFE{\0}\0", 6)), "");
}

TEST(SceneJson, RefusesHugeTexts) {
  EXPECT_EQ(json_message("[]" + std::string(largest_text - 2, ' ')), "");
  EXPECT_NE(json_message("[]" + std::string(largest_text - 1, ' ')).find("16 MiB"), std::string::npos);
}

TEST(SceneJson, ShowsHostileTextHarmlessly) {
  EXPECT_EQ(printable("h\xC3\xA9 \x1B[31m\n"), "h\xC3\xA9 \\x1B[31m\\x0A");
  EXPECT_EQ(printable("\xC3(\xED\xA0"), "\\xC3(\\xED\\xA0");
  EXPECT_LT(printable(std::string(10000, 'a')).size(), 130U);
}

}  // namespace
}  // namespace pliant::scene_file
