#pragma once

#include <optional>
#include <vector>

#include "engine/frame_quality.hpp"
#include "engine/link.hpp"
#include "level_table.hpp"

namespace vrut::server::engine {

/// What a picture cost, or is expected to cost.
struct PictureCost {
    double ms = 0;     ///< to draw, read back and encode
    double bytes = 0;  ///< of its file
    /// Milliseconds until it is shown over `link`, less the round trip; of the server alone where there is
    /// none.
    double ms_over(const std::optional<Link>& link) const {
        return ms + (link ? 1000 * bytes / link->bytes_per_second : 0);
    }
    /// From hands that ask for a camera until its picture is shown to them.
    double delay_ms(const Link& link) const {
        return ms_over(link) + std::chrono::duration<double, std::milli>(link.round_trip).count();
    }
};

/// What an interactive frame must hold.
struct LevelDemand {
    protocol::Resize view;
    PictureLimits limits;
    double target_ms = 50;
    std::optional<Link> link = {};  ///< to who steers; none: only the server's time counts
};

/// The target that `preference` makes of one: from 0 for the quickest level to infinity for the most
/// accurate, by the odds p / (1 - p).
double preferred_target(double target_ms, double preference);
/// The latency target for a client that warps its frames: where they are late anyway, fewer and sharper ones
/// are better, and so they are where the camera moves slowly, by CameraMotion::speed()
/// (server/measure/README.md).
double warped_target(double target_ms, const std::optional<Link>& link, double speed);

/// Chooses the level of each interactive frame: the most accurate of a table that holds the target,
/// by running means of what pictures took. A more accurate one is tried when it is expected to be well within
/// the target; one that then was too slow is not tried again for a while, each time for longer.
class LevelChoice {
public:
    /// The table's levels for interactive frames.
    explicit LevelChoice(const protocol::LevelTable& table);

    const std::vector<protocol::Level>& levels() const { return levels_; }
    std::size_t choose(const LevelDemand& demand, base::Clock::time_point now);
    /// A picture of so many pixels at `level` has cost so much.
    void took(std::size_t level, const PictureCost& cost, double pixels, base::Clock::time_point now);
    /// The level's running mean, if it is of pictures of that size and of late; else in proportion to its
    /// costs in the table from the mean of the level measured last; else as in the table.
    PictureCost expected(std::size_t level, double pixels, base::Clock::time_point now) const;

private:
    struct Mean {
        PictureCost cost;
        double pixels = 0;
        std::optional<base::Clock::time_point> last = {};
    };
    bool holds(std::size_t level, double target_ms, base::Clock::time_point now) const;
    void was_too_slow(base::Clock::time_point now);
    void begin_anew();

    std::vector<protocol::Level> levels_;
    double table_pixels_;
    std::vector<Mean> means_;  // of each level
    std::optional<std::size_t> measured_last_;
    std::size_t level_ = 0;
    LevelDemand demand_{};
    std::optional<base::Clock::time_point> went_up_;
    std::size_t ceiling_ = 0;  // from this level on none is tried before...
    base::Clock::time_point ceiling_until_{};
    std::chrono::seconds backoff_{0};
};

}  // namespace vrut::server::engine
