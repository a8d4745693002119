#include "journey.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "plan/render_job.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace vrut::stability {

using namespace std::chrono_literals;
using server::base::Clock;
using Milliseconds = std::chrono::duration<double, std::milli>;
using Seconds = std::chrono::duration<double>;

namespace {

/// A picture with about as much to encode as one of the car: shaded balls with edges and highlights before a
/// gradient, the same for all sizes.
scene::Image balls(int width, int height) {
    constexpr int kBalls = 36;
    scene::Image image;
    image.resize(width, height);
    const auto put = [&](int x, int y, const glm::dvec3& color) {
        std::uint8_t* pixel = &image.rgba[static_cast<std::size_t>(y * width + x) * 4];
        for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(std::clamp(color[i], 0.0, 255.0));
        pixel[3] = 255;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) put(x, y, glm::dvec3(60, 70, 90) + 120.0 * y / height);
    for (int ball = 0; ball < kBalls; ++ball) {
        const double radius = height * (0.02 + 0.1 * std::fmod(ball * 0.618, 1));
        const glm::dvec2 center(width * std::fmod(0.1 + ball * 0.7549, 1),
                                height * std::fmod(0.2 + ball * 0.5698, 1));
        const glm::dvec3 paint(40 + ball * 83 % 200, 40 + ball * 47 % 200, 40 + ball * 29 % 200);
        const auto last = [](double end, int most) { return std::min(static_cast<int>(end), most - 1); };
        for (int y = std::max(0, static_cast<int>(center.y - radius)); y <= last(center.y + radius, height);
             ++y)
            for (int x = std::max(0, static_cast<int>(center.x - radius));
                 x <= last(center.x + radius, width); ++x) {
                const glm::dvec2 across = (glm::dvec2(x, y) - center) / radius;
                const double inside = 1 - glm::dot(across, across);
                if (inside < 0) continue;
                const double lit =
                    0.3 + 0.7 * std::max(0.0, 0.6 * std::sqrt(inside) + 0.5 * across.y - 0.4 * across.x);
                put(x, y, paint * lit + 150 * std::pow(std::max(0.0, lit - 0.2), 12.0));
            }
    }
    return image;
}

server::net::ServerOptions options(const server::net::Deadlines& deadlines) {
    server::net::ServerOptions options;
    options.listen = {"127.0.0.1", 0};
    options.deadlines = deadlines;
    return options;
}

}  // namespace

server::engine::FrameRenderer renderer_of_balls() {
    server::engine::FrameRenderer renderer;
    renderer.description = "balls";
    auto drawn = std::make_shared<std::map<std::pair<int, int>, scene::Image>>();
    renderer.step = [drawn](plan::RenderJob& rendering) {
        rendering.samples = rendering.view.samples;
        const plan::View& view = rendering.view;
        scene::Image& image = rendering.image;
        scene::Image& whole = (*drawn)[{view.width, view.height}];
        if (whole.rgba.empty()) whole = balls(view.width, view.height);
        image.resize(view.width, view.height);
        const glm::dvec3 direction = view.camera.focus - view.camera.eye;
        const double turn = std::atan2(direction.x, direction.z) / 6.2832 + 1;
        const std::size_t row = static_cast<std::size_t>(view.width) * 4;
        const std::size_t cut =
            static_cast<std::size_t>(turn * view.width) % static_cast<std::size_t>(view.width) * 4;
        for (std::size_t at = 0; at < whole.rgba.size(); at += row) {
            std::copy_n(&whole.rgba[at] + cut, row - cut, &image.rgba[at]);
            std::copy_n(&whole.rgba[at], cut, &image.rgba[at] + (row - cut));
        }
        rendering.stats.render_ms = 1;
        return true;
    };
    return renderer;
}

Journey::Journey(const test_support::LinkQuality& quality, const server::net::Deadlines& deadlines,
                 const Between& between)
    : server_(options(deadlines), {"room", "", scene_of({{1, sphere(1, 8), {}}}), {}}, renderer_of_balls),
      thread_([this] { server_.run(); }),
      link_(std::make_unique<test_support::SlowLink>(
          context_, between ? between(server_.port()) : server_.port(), quality)),
      page_(std::make_unique<PageClient>(context_, link_->port(), protocol::Role::control)),
      watcher_(std::make_unique<PageClient>(context_, server_.port(), protocol::Role::view)) {}

Journey::~Journey() {
    page_.reset();
    watcher_.reset();
    link_.reset();  // or the server would wait for a goodbye
    server_.stop();
    thread_.join();
}

void Journey::go_on(double seconds) {
    context_.run_for(std::chrono::duration_cast<Clock::duration>(Seconds(seconds)));
}

void Journey::go_on_until(std::size_t pictures, double seconds) {
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
    while (page_->shown().size() < pictures && Clock::now() < end) context_.run_for(10ms);
}

double Journey::longest_lag(double seconds, double patience) {
    const int connections = page_->connections();
    const Clock::time_point begin = Clock::now();
    go_on(seconds);
    const Clock::time_point end = Clock::now();
    const std::vector<PageClient::Move> all = page_->moves();
    std::vector<PageClient::Move> moves;
    for (const PageClient::Move& move : all)
        if (move.sent >= begin && move.sent <= end) moves.push_back(move);
    if (moves.empty()) return kNothing;
    while (handled() < moves.back().id && Clock::now() < end + Seconds(patience)) context_.run_for(10ms);
    const bool arrived = handled() >= moves.back().id && page_->connections() == connections;
    return arrived ? longest_lag(moves) : kNothing;
}

std::int64_t Journey::handled() const { return page_->shown().empty() ? 0 : page_->shown().back().handled; }

/// Of moves that pictures show.
double Journey::longest_lag(const std::vector<PageClient::Move>& moves) const {
    double longest = 0;
    auto picture = page_->shown().begin();
    for (const PageClient::Move& move : moves) {
        while (picture->handled < move.id) ++picture;
        longest = std::max(longest, Milliseconds(picture->at - move.sent).count());
    }
    return longest;
}

}  // namespace vrut::stability
