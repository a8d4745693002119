#include "level_table.hpp"

#include "file_descriptions.hpp"

namespace vrut::protocol {

namespace {

constexpr double kSmallestScale = 0.01;  // less is no picture any more
constexpr int kMostSamples = 64;

[[noreturn]] void refuse(std::size_t i, const std::string& what) {
    throw BadJson{error_code::out_of_range, "'levels[" + std::to_string(i) + "]." + what};
}

/// What is narrower for a level than for the picture of a frame header.
LevelTable checked(LevelTable table) {
    const Quality* below = nullptr;
    for (std::size_t i = 0; i < table.levels.size(); ++i) {
        const Quality& quality = table.levels[i].quality;
        if (quality.scale < kSmallestScale) refuse(i, "quality.scale' must be 0.01 to 1");
        if (quality.samples > kMostSamples) refuse(i, "quality.samples' must be 1 to 64");
        if (quality.level == Quality::Level::still) continue;
        if (below && below->error && quality.error && *quality.error > *below->error)
            refuse(i, "quality.error' must not be larger than that of the level before");
        below = &quality;
    }
    if (!below) throw BadJson{error_code::out_of_range, "'levels' must have one for frames of a moving view"};
    return table;
}

}  // namespace

std::string encode(const LevelTable& table) {
    return write_struct(table).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

tl::expected<LevelTable, std::string> parse_level_table(std::string_view text) {
    return or_error([&] { return checked(read_struct<LevelTable>(parse_strictly(text), "")); })
        .map_error([](const Error& error) { return error.message; });
}

}  // namespace vrut::protocol
