#include "voxdag/formats/readers/gltf/json_document.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "voxdag/formats/readers/gltf/gltf_value.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

MeshSource source_of(std::string_view text) { return {text, "mesh", {}, nullptr, {}}; }

/// Returns a value of the document as a value of nlohmann's library.
Json to_json(const JsonDocument& document, std::uint32_t index) {
  const JsonNode& node = document.node(index);
  switch (node.kind) {
    case JsonKind::kNull:
      return nullptr;
    case JsonKind::kFalse:
      return false;
    case JsonKind::kTrue:
      return true;
    case JsonKind::kNumber:
      return Json::parse(document.text(node));
    case JsonKind::kString:
      return unescape_json(document.text(node));
    case JsonKind::kArray: {
      Json array = Json::array();
      for (std::uint32_t i = 0; i < node.count; ++i)
        array.push_back(to_json(document, node.first + i));
      return array;
    }
    case JsonKind::kObject:
      break;
  }
  Json object = Json::object();
  for (std::uint32_t i = 0; i < node.count; ++i)
    object[std::string(document.key(document.node(node.first + i)))] =
        to_json(document, node.first + i);
  return object;
}

/// Reads the text here and with nlohmann's library; both must accept it, as equal values, or
/// refuse.
void expect_same(const std::string& text) {
  Json expected;
  bool is_accepted = true;
  try {
    expected = Json::parse(text);
  } catch (const Json::exception&) {
    is_accepted = false;
  }
  const MeshSource source = source_of(text);
  try {
    const JsonDocument document(source, text);
    EXPECT_TRUE(is_accepted) << text;
    if (is_accepted) {
      EXPECT_EQ(to_json(document, document.root()), expected) << text;
    }
  } catch (const Error& error) {
    EXPECT_FALSE(is_accepted) << text << ": " << error.what();
  }
}

TEST(JsonDocument, AgreesWithAnotherParser) {
  for (const char* text : {"",
                           " ",
                           "null",
                           "true",
                           "fals",
                           "[]",
                           "{}",
                           "[1,2,[3,{\"a\":[]}],\"x\"]",
                           "[1,]",
                           "{,}",
                           "{\"a\":1,}",
                           "[1 2]",
                           "{\"a\" 1}",
                           "{1:2}",
                           "1",
                           "-",
                           "-0",
                           "01",
                           "1.",
                           ".5",
                           "1.5e+3",
                           "1e",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "\"a\\u00e9\\ud83d\\ude00\\n\\\"\\/\"",
                           "\"\\ud83d\"",
                           "\"\\ude00\"",
                           "\"\\u12g4\"",
                           "\"\\x\"",
                           "\"\t\"",
                           "\"\xC3\xA9\"",
                           "\"\xC3\"",
                           "\"\xED\xA0\x80\"",
                           "\"\xF4\x90\x80\x80\"",
                           "{\"a\":1,\"b\":2,\"a\":{\"c\":3}}",
                           "{\"\\u0061\":1,\"a\":2}",
                           "\xEF\xBB\xBF[1]",
                           "[1] x",
                           "[[[[1]]]]",
                           "{\"z\":1,\"a\":2}",
                           "[\"\"",
                           "{\"a\":",
                           "\"abc"})
    expect_same(text);
}

TEST(JsonDocument, AgreesOnRandomTexts) {
  std::mt19937 rng(1);
  const std::string parts[] = {"{",    "}",     "[",     "]",           ",",
                               ":",    "\"a\"", "\"b\"", "1",           "-2.5e1",
                               "true", "null",  " ",     "\"\\u0062\"", "\"\\\\\""};
  for (int i = 0; i < 30'000; ++i) {
    std::string text = rng() % 2 ? "{\"a\":" : "[";
    for (auto n = rng() % 12; n > 0; --n) text += parts[rng() % std::size(parts)];
    expect_same(text);
    expect_same(text + (text[0] == '{' ? "}" : "]"));
  }
}

TEST(JsonDocument, ErrorsNameTheByteAndValuesKnowTheirPath) {
  const std::string text = R"({"a":[1,{"b":2}],"c":"x"})";
  const MeshSource source = source_of(text);
  const JsonDocument document(source, text);
  const GltfValue root(source, document, document.root());
  EXPECT_EQ(root["a"].items()[1]["b"].path(), "a[1].b");
  EXPECT_EQ(root["a"].items()[1]["x"]["y"].path(), "a[1].x.y");
  EXPECT_EQ(root["x"].path(), "x");
  EXPECT_FALSE(root["x"]["y"].exists());
  EXPECT_THROW(root["c"]["y"], Error);
  EXPECT_THROW(root["a"].items()[0].items(), Error);
  const std::string bad = "[1, 2, ?]";
  try {
    const MeshSource bad_source = source_of(bad);
    JsonDocument(bad_source, bad);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "mesh: byte 7: not glTF: the JSON is malformed here");
  }
}

TEST(JsonDocument, MemoryIsCounted) {
  std::string text = "[";
  for (int i = 0; i < 100'000; ++i) text += "1,";
  text += "1]";
  MemoryBudget enough(std::uint64_t{64} << 20);
  MeshSource source = source_of(text);
  source.options.work = &enough;
  {
    const JsonDocument document(source, text);
    EXPECT_GE(enough.used(), 100'001 * sizeof(JsonNode));
  }
  EXPECT_EQ(enough.used(), 0u);
  MemoryBudget small(std::uint64_t{1} << 20);
  source.options.work = &small;
  EXPECT_THROW(JsonDocument(source, text), OverMemory);
  EXPECT_EQ(small.used(), 0u);
}

}  // namespace
}  // namespace voxdag
