// Studies of links that are slow, long, or stand still.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>

#include "journey.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

using namespace std::chrono_literals;
using Milliseconds = std::chrono::duration<double, std::milli>;
using Seconds = std::chrono::duration<double>;

constexpr double kLink = 1e7, kFastLink = 1e8;  // bit/s, of links that are not slow
constexpr double kPatience = 10;                // s

double milliseconds_of(double bytes, double bits_per_second) { return 8000 * bytes / bits_per_second; }

/// Clients that come and go are no news here.
struct Quiet {
    spdlog::level::level_enum before = spdlog::get_level();
    Quiet() { spdlog::set_level(spdlog::level::off); }
    ~Quiet() { spdlog::set_level(before); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

/// All at once, as they mostly wait, or where the processor's time counts (`deferred`) one after the other.
std::vector<Curve::Point> measured(const std::vector<double>& points,
                                   const std::function<double(double)>& measure,
                                   std::launch policy = std::launch::async) {
    const Quiet quiet;
    std::vector<std::future<double>> running;
    running.reserve(points.size());
    for (const double x : points) running.push_back(std::async(policy, measure, x));
    std::vector<Curve::Point> curve;
    for (std::size_t i = 0; i < points.size(); ++i) curve.push_back({points[i], running[i].get()});
    return curve;
}

const char* const kBalls = " The pictures are of shaded balls, in JPEG as large as those of the car.";

}  // namespace

Study slow_links(const Laboratory& laboratory) {
    const bool whole = laboratory.form == Form::whole;
    Study study{"slow-links", "Slow links", "seconds for a megabit, either way",
                "longest ms from a move to its picture, less two small ones"};
    study.bound = 2000;
    study.method.title = "small enough and few enough";
    study.explanation =
        std::string(
            "The first pictures of a drag are of the smallest level, and from there on the level "
            "holds the latency target if one can. Frames that take longer than 100 ms are sent one "
            "at a time; updates of the state wait for them, and the newest replaces the others. A "
            "drag takes 30 s.") +
        kBalls;
    study.cost =
        "Over a slow link the picture is a quarter as wide as the view while it moves, and sharp only when "
        "it has rested for as long as the sharp one takes to arrive.";
    const std::vector<double> points =
        whole ? std::vector{0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 50.0} : std::vector{0.01, 1.0};
    study.method.points = measured(points, [&](double x) {
        const double small = milliseconds_of(kSmallest, 1e6 / x);
        Journey journey({1e6 / x / 8, 0ms});
        journey.go_on_until(3, 10 * small / 1000 + 1);
        return std::max(0.0, journey.longest_lag(whole ? 30 : 0.5, kPatience) - 2 * small);
    });
    return study;
}

Study long_links(const Laboratory& laboratory) {
    const bool whole = laboratory.form == Form::whole;
    Study study{"long-links", "Long links", "ms of delay, either way",
                "longest ms from a move to its picture, less two round trips"};
    study.bound = 500;
    study.method.title = "two pictures on their way";
    study.explanation =
        std::string(
            "At 10 Mbit/s a move waits for a grant that comes back, at most a round trip, and is "
            "on its own way for another; the lag does not grow.") +
        kBalls;
    study.cost = "Two pictures come in a round trip, and no more.";
    study.method.points =
        measured(whole ? std::vector<double>{1, 10, 30, 100, 300, 1000, 2000} : std::vector<double>{1, 100},
                 [&](double ms) {
                     Journey journey({kLink / 8, std::chrono::milliseconds(std::llround(ms))});
                     journey.go_on_until(3, 1 + 10 * ms / 1000);
                     return std::max(0.0, journey.longest_lag(whole ? 20 : 0.4, kPatience) - 4 * ms);
                 });
    return study;
}

Study levels_of_long_links(const Laboratory& laboratory) {
    const bool whole = laboratory.form == Form::whole;
    Study study{"long-link-levels", "Levels over long links", "ms of delay, either way",
                "width of the view / of the picture while it moves, median"};
    study.bound = 2.1;  // half the width, and what rounding does
    study.method.title = "without the time of an empty message";
    study.explanation =
        std::string(
            "When a client comes, a ping tells how long its way is. No level makes that shorter, so "
            "it does not count against the latency target of 50 ms. The link has 100 Mbit/s.") +
        kBalls;
    study.cost = "Pictures are better than the smallest, and take a little longer than they might.";
    const std::vector<double> points =
        whole ? std::vector<double>{1, 5, 30, 100, 300, 1000} : std::vector<double>{1, 5};
    study.method.points = measured(
        points,
        [&](double ms) {
            Journey journey({kFastLink / 8, std::chrono::milliseconds(std::llround(ms))});
            journey.go_on(whole ? 5 + 12 * ms / 1000 : 1.1);
            std::vector<double> widths;  // once the level was found
            const auto& shown = journey.page().shown();
            for (std::size_t i = shown.size() / 2; i < shown.size(); ++i)
                if (shown[i].moving) widths.push_back(1 / shown[i].scale);
            if (widths.empty()) return kNothing;
            std::sort(widths.begin(), widths.end());
            return widths[widths.size() / 2];
        },
        std::launch::deferred);
    return study;
}

Study stalls(const Laboratory& laboratory) {
    const bool whole = laboratory.form == Form::whole;
    const double stuck = whole ? 10 : 1;  // s, after which the server cuts
    Study study{"stalls", "Links that stand still", "seconds for which nothing leaves or arrives",
                "ms from its end to the picture of a later move"};
    study.bound = 2000;
    study.method.title = "two on their way; after 10 s a new connection";
    study.explanation =
        std::string(
            "What waits for a client is replaced, not queued: at 10 Mbit/s two old pictures come, and then "
            "the newest. A connection that has taken nothing for 10 s is cut, and the page comes back.") +
        kBalls;
    study.cost = "What happened meanwhile is not seen; who is cut loses control and whatever was pressed.";
    const std::vector<double> points =
        whole ? std::vector<double>{0.1, 0.3, 1, 3, 6, 10, 15} : std::vector<double>{0.3, 2.3};
    study.method.points = measured(points, [&](double x) {
        server::net::Deadlines deadlines;
        deadlines.stuck = std::chrono::milliseconds(std::llround(1000 * stuck));
        Journey journey({kLink / 8, 0ms}, deadlines);
        journey.go_on_until(5, 5);
        const server::base::Clock::time_point end =
            server::base::Clock::now() +
            std::chrono::duration_cast<server::base::Clock::duration>(Seconds(x));
        journey.link().stall_until(end);
        journey.go_on(x + (whole ? 2.5 : 0.6));
        const bool was_cut = journey.page().connections() > 1;
        if (x < stuck ? was_cut : x >= stuck + 1.2 && !was_cut) return kNothing;
        for (const PageClient::Shown& picture : journey.page().shown())
            for (const PageClient::Move& move : journey.page().moves())
                if (move.sent >= end && picture.at >= end && move.id <= picture.handled)
                    return Milliseconds(picture.at - end).count();
        return kNothing;
    });
    return study;
}

}  // namespace vrut::stability
