#include "engine/level_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vrut::server::engine {

namespace {

constexpr double kWellWithin = 0.85;               // of the target, before a higher level is tried
constexpr double kNewWeight = 0.2;                 // of a new time in the running mean
constexpr auto kLately = std::chrono::seconds(2);  // the mean of another level is trusted so long
constexpr std::chrono::seconds kTrial{30};         // what is too slow so soon was tried in vain
constexpr std::chrono::seconds kFirstBackoff{2}, kLongestBackoff{64};

// Radians a second; and how much longer a frame may take below it that is warped.
constexpr double kSlow = 0.5, kSharper = 2;

double mean_of(double before, double now) { return before + kNewWeight * (now - before); }

/// Of a level's cost in the table, by pixels of the picture as it is now.
double for_pixels(double cost, const protocol::Level& level, double pixels) {
    return std::max(cost, 1e-3) * pixels / (level.quality.scale * level.quality.scale);
}

}  // namespace

double warped_target(double target_ms, const std::optional<Link>& link, double speed) {
    const double round_trip_ms =
        link ? std::chrono::duration<double, std::milli>(link->round_trip).count() : 0;
    return std::max(target_ms, round_trip_ms) * (speed > 0 && speed < kSlow ? kSharper : 1);
}

double preferred_target(double target_ms, double preference) {
    if (preference >= 1) return std::numeric_limits<double>::infinity();
    return target_ms * preference / (1 - preference);
}

LevelChoice::LevelChoice(const protocol::LevelTable& table)
    : table_pixels_(static_cast<double>(table.width) * table.height) {
    for (const protocol::Level& level : table.levels)
        if (level.quality.level == protocol::Quality::Level::moving) levels_.push_back(level);
    means_.resize(levels_.size());
}

PictureCost LevelChoice::expected(std::size_t level, double pixels, base::Clock::time_point now) const {
    const Mean& own = means_[level];
    if (own.last && own.pixels == pixels && (level == measured_last_ || now - *own.last < kLately))
        return own.cost;
    const protocol::Level& row = levels_[level];
    if (!measured_last_)
        return {for_pixels(row.ms, row, pixels) / table_pixels_,
                for_pixels(row.bytes, row, pixels) / table_pixels_};
    const Mean& other = means_[*measured_last_];
    const protocol::Level& other_row = levels_[*measured_last_];
    return {
        other.cost.ms * for_pixels(row.ms, row, pixels) / for_pixels(other_row.ms, other_row, other.pixels),
        other.cost.bytes * for_pixels(row.bytes, row, pixels) /
            for_pixels(other_row.bytes, other_row, other.pixels)};
}

/// The mean of a level that is new begins at what was expected of it: a first picture, for which buffers of
/// its size are made, says too little.
void LevelChoice::took(std::size_t level, const PictureCost& cost, double pixels,
                       base::Clock::time_point now) {
    const PictureCost before = measured_last_ ? expected(level, pixels, now) : cost;
    means_[level] = {{mean_of(before.ms, cost.ms), mean_of(before.bytes, cost.bytes)}, pixels, now};
    measured_last_ = level;
}

bool LevelChoice::holds(std::size_t level, double target_ms, base::Clock::time_point now) const {
    const protocol::Quality quality = quality_of(levels_[level].quality, demand_.view, demand_.limits, false);
    const PictureSize size = picture_size(demand_.view, quality.scale);
    return target_ms > 0 &&
           expected(level, static_cast<double>(size.width) * size.height, now).ms_over(demand_.link) <=
               target_ms;
}

void LevelChoice::was_too_slow(base::Clock::time_point now) {
    const bool in_vain = went_up_ && now - *went_up_ < std::max(kTrial, backoff_);
    if (now >= ceiling_until_)  // else the level below is too slow as well: it was one attempt
        backoff_ = in_vain ? std::clamp(2 * backoff_, kFirstBackoff, kLongestBackoff) : kFirstBackoff;
    ceiling_ = level_;
    ceiling_until_ = now + backoff_;
}

/// What was learned of the levels is kept; what was too slow then need not be now.
void LevelChoice::begin_anew() {
    went_up_.reset();
    ceiling_until_ = {};
    backoff_ = {};
}

std::size_t LevelChoice::choose(const LevelDemand& demand, base::Clock::time_point now) {
    const LevelDemand before = std::exchange(demand_, demand);
    if (demand.view != before.view || demand.target_ms != before.target_ms) begin_anew();
    if (!holds(level_, demand.target_ms, now)) {
        if (means_[level_].last) was_too_slow(now);
        while (level_ > 0 && !holds(level_, demand.target_ms, now)) --level_;
        return level_;
    }
    const std::size_t end = now < ceiling_until_ ? std::max(ceiling_, level_ + 1) : levels_.size();
    for (std::size_t higher = std::min(end, levels_.size()) - 1; higher > level_; --higher)
        if (holds(higher, kWellWithin * demand.target_ms, now)) {
            went_up_ = now;
            return level_ = higher;
        }
    return level_;
}

}  // namespace vrut::server::engine
