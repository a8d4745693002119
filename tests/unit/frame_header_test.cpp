#include "frame_header.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace vrut::protocol;

TEST_CASE("the header says what the contract asks for") {
    FrameHeader header;
    header.frame = 3;
    header.camera.eye = {0.1, 1.0 / 3, 1e-17};
    header.view_matrix[3][0] = 5;  // a translation: the end of the first row
    header.quality = {.moving = true, .scale = 0.5, .samples = 1, .jpeg_quality = 75, .subsampled = true};
    auto json = nlohmann::json::parse(encode(header));
    CHECK(json["frame"] == 3);
    CHECK(json["camera"]["eye"][1].get<double>() == 1.0 / 3);
    CHECK(json["camera"]["eye"][2].get<double>() == 1e-17);
    CHECK(json["camera"]["viewMatrix"].size() == 16);
    CHECK(json["camera"]["viewMatrix"][3] == 5);
    CHECK(json["quality"]["level"] == "moving");
    CHECK(json["quality"]["subsampling"] == "4:2:0");
    CHECK_FALSE(json["timing"].contains("sinceInputMs"));
    for (const char* member : {"revision", "handled", "width", "height", "view", "renderer"})
        CHECK(json.contains(member));

    header.since_input_ms = 2.5;
    CHECK(nlohmann::json::parse(encode(header))["timing"]["sinceInputMs"] == 2.5);
}

TEST_CASE("the comment goes behind the JFIF segment") {
    std::vector<std::uint8_t> jpeg(40, 0);
    jpeg[0] = 0xFF, jpeg[1] = 0xD8, jpeg[2] = 0xFF, jpeg[3] = 0xE0, jpeg[4] = 0, jpeg[5] = 16;
    CHECK(comment_offset(jpeg) == 20);
    jpeg[3] = 0xDB;  // no JFIF segment: right behind the start
    CHECK(comment_offset(jpeg) == 2);
}

TEST_CASE("a comment segment tells its length, and has a longest") {
    const auto segment = comment_segment(std::string(300, 'x'));
    REQUIRE(segment.size() == 304);
    CHECK(segment[0] == 0xFF);
    CHECK(segment[1] == 0xFE);
    CHECK((segment[2] << 8 | segment[3]) == 302);
    CHECK(comment_segment(std::string(65'533, 'x')).size() == 65'537);
    CHECK_THROWS(comment_segment(std::string(65'534, 'x')));
}
