// Studies of the choice of level while things move.
#include <cmath>

#include "engine/level_choice.hpp"
#include "scenes/level_store.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

constexpr double kPixels = 1180 * 820;
constexpr int kPictures = 2000;

/// What a picture takes, of `ms` on average and up to `share` of that more or less.
class Machine {
public:
    explicit Machine(double share) : share_(share) {}
    double takes(double ms) { return ms * (1 + share_ * noise_.next()); }

private:
    double share_;
    Noise noise_;
};

/// The pictures of a choice, whether it is any good: on average within the target, and at most one level less
/// accurate than the best level that holds it.
class Tally {
public:
    void add(std::size_t level, double ms) {
        ++pictures_;
        levels_ += static_cast<double>(level);
        ms_ += ms;
    }
    bool is_good(std::size_t best, double target_ms) const {
        return pictures_ > 0 && levels_ / pictures_ >= static_cast<double>(best) - 1 &&
               ms_ / pictures_ <= target_ms;
    }

private:
    int pictures_ = 0;
    double levels_ = 0, ms_ = 0;
};

/// The level that the last picture's factor to the table allows.
std::size_t by_last_picture(const std::vector<protocol::Level>& levels, double factor, double target) {
    std::size_t best = 0;
    for (std::size_t k = 0; k < levels.size(); ++k)
        if (levels[k].ms * factor <= target) best = k;
    return best;
}

}  // namespace

Study loads_at_a_border(const Laboratory& laboratory) {
    Study study{"border", "A steady load at the border of two levels",
                "time of the better level's pictures, in percent of the target",
                "changes of level in a minute, after a minute"};
    study.bound = 6;
    study.baseline.title = "the level that the last picture allows";
    study.method.title = "running means, hysteresis, back-off";
    study.explanation =
        "A better level is tried below 85 % of the target and left above it, and where it was left soon, it "
        "is not tried again for 2 s, then 4, up to a minute. Times vary by 10 %.";
    study.cost = "At 85 to 100 % of the target the better level would do, and may not be taken.";
    for (const double percent : laboratory.chosen({75, 80, 85, 90, 95, 98, 100})) {
        server::engine::LevelChoice choice(server::scenes::built_in_levels());
        const auto& levels = choice.levels();
        const std::size_t best = levels.size() / 2;
        const double target = levels[best + 1].ms * 100 / percent;
        Tally tally;
        Machine machine(0.1), same(0.1);
        const server::base::Clock::time_point start{std::chrono::hours(1)};
        server::base::Clock::time_point now = start;
        std::size_t level = 0, naive = 0;
        int changes = 0, naive_changes = 0;
        while (now < start + std::chrono::minutes(2)) {
            const bool counts = now >= start + std::chrono::minutes(1);
            const std::size_t next = choice.choose({{1180, 820, 1}, {}, target}, now);
            changes += counts && next != level;
            level = next;
            const double ms = machine.takes(levels[level].ms);
            now += std::chrono::microseconds(std::llround(1000 * ms));
            const double scale = levels[level].quality.scale;
            choice.took(level, {ms, 0.0}, kPixels * scale * scale, now);
            tally.add(level, ms);

            const double factor = same.takes(levels[naive].ms) / levels[naive].ms;
            const std::size_t allowed = by_last_picture(levels, factor, target);
            naive_changes += counts && allowed != naive;
            naive = allowed;
        }
        study.baseline.points.push_back({percent, 1.0 * naive_changes});
        study.method.points.push_back({percent, tally.is_good(best, target) ? 1.0 * changes : kNothing});
    }
    return study;
}

Study noisy_times(const Laboratory& laboratory) {
    Study study{"pacing", "Times of pictures that vary", "noise, in percent of a picture's time",
                "changes of level in 100 pictures"};
    study.bound = 3;
    study.baseline.title = "the level that the last picture allows";
    study.method.title = "running means, hysteresis, back-off";
    study.explanation =
        "A more accurate level is tried when it is expected to be well within the target, and not again for "
        "a while where it was too slow, each time for longer.";
    study.cost = "After a load has gone, the better level comes up to a minute later.";
    for (const double percent : laboratory.chosen({1, 2, 5, 10, 20, 40, 60})) {
        server::engine::LevelChoice choice(server::scenes::built_in_levels());
        const auto& levels = choice.levels();
        Machine machine(percent / 100), same(percent / 100);
        server::base::Clock::time_point now{std::chrono::hours(1)};
        std::size_t level = 0, naive = 0;
        int changes = 0, naive_changes = 0;
        // A target between the times of two levels, where it is hardest to stay.
        const std::size_t best = levels.size() / 2;
        const double target = std::sqrt(levels[best].ms * levels[best + 1].ms);
        Tally tally;
        server::engine::LevelDemand demand{{1180, 820, 1}, {}, target};
        for (int i = 0; i < kPictures; ++i) {
            const std::size_t next = choice.choose(demand, now);
            changes += next != level && i > 0;
            level = next;
            const double ms = machine.takes(levels[level].ms);
            now += std::chrono::microseconds(std::llround(1000 * ms));
            const double scale = levels[level].quality.scale;
            choice.took(level, {ms, 0.0}, kPixels * scale * scale, now);
            tally.add(level, ms);

            // Its factor to the table decides for all levels.
            const double factor = same.takes(levels[naive].ms) / levels[naive].ms;
            const std::size_t allowed = by_last_picture(levels, factor, target);
            naive_changes += allowed != naive && i > 0;
            naive = allowed;
        }
        study.baseline.points.push_back({percent, 100.0 * naive_changes / kPictures});
        const double share = 100.0 * changes / kPictures;
        study.method.points.push_back({percent, tally.is_good(best, target) ? share : kNothing});
    }
    return study;
}

}  // namespace vrut::stability
