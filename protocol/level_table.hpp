#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"

namespace vrut::protocol {

/// A way to draw frames while things move, with what it was measured to cost and to be worth.
struct Level {
    Quality quality;   ///< as frame headers tell it: scale, samples, detail, JPEG quality, subsampling, error
    double ms = 0;     ///< median of drawing, reading back and encoding a frame
    double bytes = 0;  ///< median of its file
    std::string reason;  ///< why it is in the table, a sentence
};

/// The levels of a scene on a machine, by rising accuracy and cost: points of the front of what was measured.
struct LevelTable {
    std::string scene;          ///< SHA-256 of its file
    std::string renderer;       ///< what draws, as the server's log tells it
    int width = 0, height = 0;  ///< of the frames measured, at scale 1
    std::vector<Level> levels;  ///< at least one
};

inline constexpr std::size_t kMaxLevels = 32;

/// JSON, a few lines a level.
std::string encode(const LevelTable& table);
/// Or a sentence that tells what is wrong with the text: it is no table, has too many levels, one that is out
/// of range, none for frames of a moving view, or two of those whose errors rise.
tl::expected<LevelTable, std::string> parse_level_table(std::string_view text);

}  // namespace vrut::protocol
