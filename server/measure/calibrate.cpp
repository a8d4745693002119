#include "measure/calibrate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "engine/frame_quality.hpp"

namespace vrut::server::measure {

namespace {

constexpr double kLevelRatio = 1.25, kLevelGain = 0.92;
constexpr std::size_t kMostLevels = 8;

// What calibrate() may take, in seconds, and how it shares that out.
constexpr double kJudgeSeconds = 5, kCostSeconds = 6, kErrorSeconds = 4;
constexpr int kMostJudgeSamples = 64, kFewestJudgeSamples = 4;
constexpr int kMostFrames = 12, kFewestFrames = 3;
constexpr int kViews = 2;
constexpr double kMostStillSeconds = 1;  // a picture at rest
constexpr int kStillFrames = 2;

class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string with_digits(double value, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

/// The most samples, a power of two, that `seconds` allow at `each` seconds.
int affordable_samples(double seconds, double each) {
    int samples = kMostJudgeSamples;
    while (samples > kFewestJudgeSamples && samples * each > seconds) samples /= 2;
    return samples;
}

struct Candidate {
    std::size_t index;  // of its setting
    Tradeoff tradeoff;
};

/// The points of the front, by rising cost, of single samples.
std::vector<Candidate> candidates_of(std::span<const Setting> settings, std::span<const Cost> costs,
                                     std::span<const Error> errors) {
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (settings[i].samples == 1 && settings[i].jpeg_quality > 0 &&
            settings[i].methods == plan::Methods{})
            all.push_back(
                {i, {latency_cost(costs[i].ms.median, costs[i].bytes.median), errors[i].flip.mean}});
    std::vector<Tradeoff> tradeoffs;
    tradeoffs.reserve(all.size());
    for (const Candidate& candidate : all) tradeoffs.push_back(candidate.tradeoff);
    std::vector<Candidate> best;
    for (const std::size_t i : front(tradeoffs)) best.push_back(all[i]);
    return best;
}

std::string reason_of(const std::vector<Candidate>& levels, std::size_t k) {
    const Tradeoff& own = levels[k].tradeoff;
    const std::string cost = "there after " + with_digits(own.cost, own.cost < 10 ? 1 : 0) + " ms";
    const std::string last = k + 1 == levels.size() ? "; none comes nearer" : "";
    if (k == 0) return "The cheapest: " + cost + last + ".";
    const Tradeoff& below = levels[k - 1].tradeoff;
    return with_digits(own.error / below.error, 2) + " x the error, " +
           with_digits(own.cost / below.cost, 2) + " x the cost of the one below: " + cost + last + ".";
}

/// Every setting is drawn once, from the cheapest on; those that time does not allow are given up, but never
/// the last, the most accurate.
std::vector<Setting> affordable(Studio& studio, const plan::View& home, std::vector<Setting> settings,
                                double& seconds_a_round) {
    const Stopwatch watch;
    const auto try_one = [&](const Setting& setting) {
        const double before = watch.seconds();
        studio.costs(home, {&setting, 1}, 1);
        return watch.seconds() - before;
    };
    const Setting most_accurate = settings.back();
    settings.pop_back();
    std::size_t count = 0;
    double last = 0;
    while (count < settings.size() && (count < 2 || watch.seconds() + last < kCostSeconds))
        last = try_one(settings[count++]);
    settings.resize(count);
    try_one(most_accurate);
    settings.push_back(most_accurate);
    seconds_a_round = watch.seconds();
    return settings;
}

/// The picture at rest, judged by one of kMostJudgeSamples samples; none where it takes too long, by the
/// seconds of a sample.
std::optional<protocol::Level> still_level(Studio& studio, const plan::View& home, double sample_seconds) {
    const Setting still = setting_of(engine::kRefined);
    if (sample_seconds * still.samples > kMostStillSeconds) return std::nullopt;
    const std::vector<scene::Image> judge{studio.exact_picture(home, kMostJudgeSamples)};
    protocol::Level level;
    level.quality = engine::kRefined;
    level.quality.error = studio.errors({&home, 1}, {&still, 1}, judge).front().flip.mean;
    const Cost cost = studio.costs(home, {&still, 1}, kStillFrames).front();
    level.ms = cost.ms.median;
    level.bytes = cost.bytes.median;
    level.reason = "At rest, where time matters less.";
    return level;
}

}  // namespace

double latency_cost(double ms, double bytes) { return ms + bytes * 8 / (kLinkMegabits * 1e3); }

std::vector<protocol::Level> choose_levels(std::span<const Setting> settings, std::span<const Cost> costs,
                                           std::span<const Error> errors) {
    const std::vector<Candidate> best = candidates_of(settings, costs, errors);
    std::vector<Tradeoff> tradeoffs;
    tradeoffs.reserve(best.size());
    for (const Candidate& candidate : best) tradeoffs.push_back(candidate.tradeoff);
    std::vector<Candidate> chosen;
    for (const std::size_t i : thinned(tradeoffs, kLevelRatio, kLevelGain, kMostLevels))
        chosen.push_back(best[i]);
    std::vector<protocol::Level> levels;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const std::size_t i = chosen[k].index;
        protocol::Quality quality = quality_of(settings[i]);
        quality.error = errors[i].flip.mean;
        levels.push_back({quality, costs[i].ms.median, costs[i].bytes.median, reason_of(chosen, k)});
    }
    return levels;
}

protocol::LevelTable calibrate(const plan::View& home, renderer::Renderer& renderer, const PartDone& done) {
    const auto part = [&](double from, double to) {
        return [&done, from, to](double fraction) {
            if (done) done(std::lerp(from, to, fraction));
        };
    };
    Studio studio(renderer);
    studio.exact_picture(home, 1);  // everything comes to the GPU
    const Stopwatch one;
    studio.exact_picture(on_orbit(home, 1, kMostFrames), 1);
    const double sample_seconds = one.seconds();
    const int samples = affordable_samples(kJudgeSeconds, kViews * sample_seconds);

    double round = 0;
    const std::vector<Setting> settings = affordable(studio, home, candidates(has_levels(home)), round);
    part(0, 0.2)(1);
    const int frames =
        std::clamp(static_cast<int>(kCostSeconds / std::max(round, 1e-3)), kFewestFrames, kMostFrames);
    const std::vector<Cost> costs = studio.costs(home, settings, frames, part(0.2, 0.5));

    std::vector<plan::View> views = judged_views(home, kViews);
    const Stopwatch trial;
    const std::vector<scene::Image> first{studio.exact_picture(views.front(), 1)};
    studio.errors({views.data(), 1}, {settings.data(), 1}, first);
    if (trial.seconds() * kViews * static_cast<double>(settings.size()) > 2 * kErrorSeconds) views.resize(1);
    std::vector<scene::Image> judges;
    for (const plan::View& view : views) {
        judges.push_back(studio.exact_picture(view, samples));
        part(0.5, 0.65)(static_cast<double>(judges.size()) / static_cast<double>(views.size()));
    }
    const std::vector<Error> errors = studio.errors(views, settings, judges, part(0.65, 0.9));
    protocol::LevelTable table;
    table.renderer = renderer.description();
    table.width = home.width;
    table.height = home.height;
    table.levels = choose_levels(settings, costs, errors);
    if (const auto still = still_level(studio, home, sample_seconds)) table.levels.push_back(*still);
    part(0.9, 1)(1);
    return table;
}

}  // namespace vrut::server::measure
