#pragma once

#include <array>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "level_table.hpp"
#include "measure/measure.hpp"
#include "plan/view.hpp"
#include "renderer/renderer.hpp"

namespace vrut::server::measure {

/// A link between a server and a client, whose packets of kPacket bytes are lost by chance, the same in each
/// run, and sent again a round trip later.
struct SimulatedLink {
    std::string name;
    double round_trip_ms = 0, bytes_per_second = 1e9;
    double loss = 0;  ///< part of the packets, 0 to 1
};
inline constexpr double kPacket = 1400;

/// Reads "RTT,RATE" or "RTT,RATE,LOSS": milliseconds, Mbit/s, percent. Or a sentence that says what is wrong.
tl::expected<SimulatedLink, std::string> parse_link(const std::string& text);

/// Links of the charts: a wire, Wi-Fi, bad Wi-Fi, a phone network.
std::vector<SimulatedLink> usual_links();

inline constexpr double kRefreshesPerSecond = 60;

/// What a page makes of its last frame until the next: nothing; shifts and scales it where the camera only
/// moves or zooms; warps it by its depth, which its frames hold then. The last is what a perfect warp would
/// make of it: the same level without delay.
inline constexpr std::array kPredictions{"none", "shift and scale", "warp", "no delay"};

/// How the server draws what is shown at a refresh.
struct ShownFrame {
    std::size_t drawn = 0;  ///< the refresh whose state it shows
    Setting setting = {};
    std::size_t bytes = 0, depth_bytes = 0;  ///< of its file, and of its depth
    bool is_moving = false;                  ///< one that is quick rather than accurate
    double ms = 0;                           ///< that it takes the server
};

/// The error at the glass: mean FLIP between what a client's glass shows at a refresh and what a server
/// without delay would show then, with every triangle and kGlassSamples samples a pixel.
struct GlassErrors {
    struct Delivered {
        int frames = 0;                     ///< that were shown
        double bytes = 0, depth_bytes = 0;  ///< of all of them
        double longest_ms = 0;              ///< that the same frame was shown while another was due
        int moving = 0;                     ///< of the frames: while things move
        double moving_ms = 0;               ///< that all of those took the server
    };
    /// By prediction; errors of each judged refresh.
    std::array<std::vector<double>, kPredictions.size()> errors;
    std::array<Delivered, kPredictions.size()> delivered;
    /// With the warp, if all that moves is drawn at one level; in the table's order.
    struct OfLevel {
        Setting setting;
        double ms = 0, bytes = 0;    ///< of a frame, as the table has it
        std::vector<double> errors;  ///< of each judged refresh
    };
    std::vector<OfLevel> levels;
};
inline constexpr int kGlassSamples = 16;

/// How the server draws, and what is judged.
struct GlassDemand {
    protocol::LevelTable levels;  ///< frames are taken to cost what it says
    double target_ms = 50;        ///< from an input to its frame, less the round trip; see warped_target()
    std::size_t every = 1;        ///< refresh is judged
    bool each_level = false;      ///< GlassErrors::levels are wanted
};

/// Of each link. `states`: what is to be seen at each refresh of a session, in the glass' size. The same
/// states, links and demand give the same errors.
std::vector<GlassErrors> errors_at_glass(const std::vector<plan::View>& states,
                                         const std::vector<SimulatedLink>& links, const GlassDemand& demand,
                                         renderer::Renderer& renderer, const PartDone& done = {});

}  // namespace vrut::server::measure
