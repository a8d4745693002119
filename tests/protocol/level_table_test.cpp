#include "level_table.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace vrut::protocol;
using nlohmann::json;

namespace {

LevelTable example() {
    LevelTable table{"ab12", "llvmpipe \"1\"", 1280, 720, {}};
    Quality half{Quality::Level::moving, 0.5, 1, 1, 75, Quality::Subsampling::yuv420, 0.031};
    table.levels.push_back({half, 21.5, 40'000, "The cheapest."});
    half.scale = 1;
    half.error = 0.02;
    table.levels.push_back({half, 61, 120'000.5, ""});
    table.levels.push_back(
        {{Quality::Level::still, 1, 16, 0, 90, Quality::Subsampling::yuv444}, 900, 3e5, ""});
    return table;
}

/// What is said of the example with one value set.
std::string rejection(const char* pointer, const json& value) {
    json changed = json::parse(encode(example()));
    changed[json::json_pointer(pointer)] = value;
    const auto table = parse_level_table(changed.dump());
    return table ? "" : table.error();
}

}  // namespace

TEST_CASE("a table reads back as it was written") {
    const LevelTable table = example();
    const auto read = parse_level_table(encode(table));
    REQUIRE(read.has_value());
    CHECK(read->scene == table.scene);
    CHECK(read->renderer == table.renderer);
    CHECK(read->width == 1280);
    CHECK(read->height == 720);
    REQUIRE(read->levels.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(read->levels[i].quality == table.levels[i].quality);
        CHECK(read->levels[i].ms == table.levels[i].ms);
        CHECK(read->levels[i].bytes == table.levels[i].bytes);
        CHECK(read->levels[i].reason == table.levels[i].reason);
    }
}

TEST_CASE("what is wrong with a table is told in a sentence that names it") {
    CHECK(rejection("/levels/0/quality/scale", 1) == "");
    CHECK(rejection("/levels/0/quality/scale", 0).starts_with("'levels[0].quality.scale'"));
    CHECK(rejection("/levels/0/quality/scale", 1.5).starts_with("'levels[0].quality.scale'"));
    CHECK(rejection("/levels/1/quality/samples", 65).starts_with("'levels[1].quality.samples'"));
    CHECK(rejection("/levels/1/quality/samples", 0).starts_with("'levels[1].quality.samples'"));
    CHECK(rejection("/levels/1/quality/detail", -1).starts_with("'levels[1].quality.detail'"));
    CHECK(rejection("/levels/1/quality/jpegQuality", 101).starts_with("'levels[1].quality.jpegQuality'"));
    CHECK(rejection("/levels/1/quality/subsampling", "4:2:2").starts_with("'levels[1].quality.subsampling'"));
    CHECK(rejection("/levels/1/quality/error", 1.1).starts_with("'levels[1].quality.error'"));
    CHECK(rejection("/levels/1/quality/error", 0.04).starts_with("'levels[1].quality.error'"));
    CHECK(rejection("/levels/0/ms", -1).starts_with("'levels[0].ms'"));
    CHECK(rejection("/levels/0/bytes", "many").starts_with("'levels[0].bytes'"));
    for (const char* cost : {"/levels/0/ms", "/levels/0/bytes"}) {
        CHECK(rejection(cost, 1e9) == "");
        CHECK(rejection(cost, 1e308).starts_with("'levels[0]."));
    }
    CHECK(rejection("/width", 0).starts_with("'width'"));
    CHECK(rejection("/levels", json::array()).starts_with("'levels'"));
    const json level = json::parse(encode(example()))["levels"][0];
    CHECK(rejection("/levels", json::array_t(32, level)) == "");
    CHECK(rejection("/levels", json::array_t(33, level)).starts_with("'levels'"));
    CHECK(rejection("/levels", json::array({json::parse(encode(example()))["levels"][2]})) ==
          "'levels' must have one for frames of a moving view");
}

TEST_CASE("what is no table is told so") {
    const std::string text = encode(example());
    for (std::size_t length = 0; length < text.size() - 2; length += 7)
        CHECK_FALSE(parse_level_table(text.substr(0, length)).has_value());
    CHECK_FALSE(parse_level_table("[]").has_value());
    CHECK_FALSE(parse_level_table("null").has_value());
    CHECK(parse_level_table("{}").error() == "member 'scene' is missing");
}
