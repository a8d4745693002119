#include "frame_header.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace vrut::protocol;

TEST_CASE("a header that is encoded once says the same as one that is encoded for its client") {
    using Depth = EncodedFrameHeader::Depth;
    FrameHeader header;
    header.markers["\"handled\":0,"] = {1, 2, 3};
    header.camera.pose.name = ",\"sinceInputMs\":0.0";
    const auto both = [&](std::int64_t handled, std::optional<double> since_input_ms) {
        const EncodedFrameHeader encoded(header);
        header.handled = handled;
        header.timing.since_input_ms = since_input_ms;
        CHECK(encoded.with(handled, since_input_ms, Depth::sent) == encode(header));
        FrameHeader other = header;
        if (other.depth) other.depth->bytes = 0;
        CHECK(encoded.with(handled, since_input_ms, Depth::known) == encode(other));
        other.depth.reset();
        CHECK(encoded.with(handled, since_input_ms, Depth::none) == encode(other));
        CHECK(EncodedFrameHeader(encoded.text()).text() == encoded.text());
    };
    both(0, {});
    header.depth = FrameHeader::Depth{4, 160, 90, 0.25, true, {}, 5119};
    both(16, {});
    header.depth->camera = Pose{{1, 2, 3}, {0.1, 0, 0}, {0, 1, 0}, {4, 5, 6}, 30};
    header.camera.pose.name = ",\"depth\":{\"bytes\":7}";
    both(17, 2.5);
    both(kMaxInteger, 0);
    header.camera.pose.name =
        std::string(65'000, 'x');  // the longest with a small number, without the markers
    both(9, {});
    header.camera.pose.name = std::string(70'000, 'x');
    both(3, 1e-9);
}

TEST_CASE("the header says what the contract asks for") {
    FrameHeader header;
    header.frame = 3;
    header.camera.pose.eye = {0.1, 1.0 / 3, 1e-17};
    header.camera.view_matrix[3][0] = 5;  // a translation: the end of the first row
    header.quality = {Quality::Level::moving, 0.5, 1, 2, 75, Quality::Subsampling::yuv420};
    auto parsed = nlohmann::json::parse(encode(header));
    CHECK(parsed["frame"] == 3);
    CHECK(parsed["camera"]["eye"][1].get<double>() == 1.0 / 3);
    CHECK(parsed["camera"]["eye"][2].get<double>() == 1e-17);
    CHECK(parsed["camera"]["viewMatrix"].size() == 16);
    CHECK(parsed["camera"]["viewMatrix"][3] == 5);
    CHECK(parsed["quality"]["level"] == "moving");
    CHECK(parsed["quality"]["subsampling"] == "4:2:0");
    CHECK_FALSE(parsed["quality"].contains("error"));
    CHECK_FALSE(parsed["timing"].contains("sinceInputMs"));
    for (const char* member : {"revision", "handled", "width", "height", "view", "renderer"})
        CHECK(parsed.contains(member));

    CHECK_FALSE(parsed.contains("snapshot"));
    CHECK_FALSE(parsed["camera"].contains("node"));

    header.timing.since_input_ms = 2.5;
    header.quality.error = 0.031;
    header.snapshot = 17;
    header.camera.pose.node = 4;
    header.camera.pose.name = "Driver";
    parsed = nlohmann::json::parse(encode(header));
    CHECK(parsed["timing"]["sinceInputMs"] == 2.5);
    CHECK(parsed["quality"]["error"] == 0.031);
    CHECK(parsed["snapshot"] == 17);
    CHECK(parsed["camera"]["node"] == 4);
    CHECK(parsed["camera"]["name"] == "Driver");
}

TEST_CASE("a header's members, as they are written") {
    FrameHeader header;
    header.frame = 3, header.revision = 7, header.handled = 12;
    header.width = 640, header.height = 360;
    header.view = {1280, 720, 0.5};
    header.renderer = {DrawMode::stylized, true, false};
    header.quality = {Quality::Level::still, 1, 16, 0, 90, Quality::Subsampling::yuv444};
    header.timing = {1, 2, 3, {}};
    auto parsed = nlohmann::json::parse(encode(header));
    parsed.erase("camera");
    CHECK(parsed == nlohmann::json::parse(R"({
        "frame": 3, "revision": 7, "handled": 12, "width": 640, "height": 360,
        "view": {"width": 1280, "height": 720, "pixelRatio": 0.5},
        "renderer": {"mode": "stylized", "wireframe": true, "showSelection": false},
        "quality": {"level": "still", "scale": 1, "samples": 16, "detail": 0, "jpegQuality": 90,
                    "subsampling": "4:4:4"},
        "timing": {"renderMs": 1, "readbackMs": 2, "encodeMs": 3}})"));
}

TEST_CASE("a header is never longer than a comment can be") {
    FrameHeader header;
    header.camera.pose.name = std::string(64'000, 'x');
    CHECK(nlohmann::json::parse(encode(header))["camera"]["name"].get<std::string>().size() == 64'000);
    header.camera.pose.name = std::string(70'000, 'x');
    const std::string text = encode(header);
    CHECK(text.size() <= 65'533);
    CHECK_FALSE(nlohmann::json::parse(text)["camera"].contains("name"));
}

TEST_CASE("a header tells where markers stand, by name") {
    FrameHeader header;
    CHECK_FALSE(nlohmann::json::parse(encode(header)).contains("markers"));
    header.markers = {{"Scratch \"1\"", {0.1, -2, 1e300}}, {"Grip", {1, 2, 3}}};
    CHECK(nlohmann::json::parse(encode(header))["markers"] ==
          nlohmann::json({{"Scratch \"1\"", {0.1, -2.0, 1e300}}, {"Grip", {1.0, 2.0, 3.0}}}));
}

TEST_CASE("where a header would be too long, markers go before anything else does") {
    FrameHeader header;
    header.camera.pose.name = "Driver";
    for (int i = 0; i < 256; ++i)
        header.markers[std::string(95, '\1') + std::to_string(i)] = {1.0 / 3, 2.0 / 3, -1e-300};
    const auto parsed = nlohmann::json::parse(encode(header));  // six bytes in JSON for each of a name's
    CHECK_FALSE(parsed.contains("markers"));
    CHECK(parsed["camera"]["name"] == "Driver");

    // What has just fitted stays; a byte more is too much.
    header.markers = {{"Grip", {1, 2, 3}}};
    header.camera.pose.name = "";
    header.camera.pose.name = std::string(65'533 - encode(header).size(), 'x');
    CHECK(encode(header).size() == 65'533);
    CHECK(nlohmann::json::parse(encode(header)).contains("markers"));
    *header.camera.pose.name += 'x';
    const auto longer = nlohmann::json::parse(encode(header));
    CHECK_FALSE(longer.contains("markers"));
    CHECK(longer["camera"]["name"] == *header.camera.pose.name);
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
