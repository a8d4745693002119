// What another watcher costs, and what one that stands still costs the others. The program draws the car in a
// process of its own; the clients, who take no more than the beginning of each frame, share the machine with
// it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include "audience.hpp"
#include "program.hpp"

using namespace vrut::test;
using Clock = std::chrono::steady_clock;

namespace {

std::vector<std::string> serve() {
    return {"serve", VRUT_CARS "/car.vrut", "--listen", "127.0.0.1:0", "--log-level",
            "error", "--max-clients",       "200"};
}

/// Of the server so far.
struct Work {
    double changes = 0, seen = 0, rendered = 0, encoded = 0, sent = 0, bytes = 0, cpu_ms = 0, net_ms = 0;
};

Work work_of(Program& program, const Audience& audience) {
    const std::string text = http(program.port(), "GET", "/metrics").body;
    const auto counter = [&](const std::string& name) {
        const std::size_t at = text.find("\nvrut_preview_" + name + " ");
        REQUIRE_MESSAGE(at != std::string::npos, name);
        return std::stod(text.substr(text.find(' ', at)));
    };
    Work work;
    work.changes = static_cast<double>(audience.changes());
    work.seen = static_cast<double>(audience.seen());
    work.rendered = counter(R"(frames_rendered_total{level="moving"})") +
                    counter(R"(frames_rendered_total{level="still"})");
    work.encoded = counter("frames_encoded_total");
    work.sent = counter("frames_sent_total");
    work.bytes = counter("sent_bytes_total");
    work.cpu_ms = 1e3 * use_of(program.process()).cpu_s;
    // The first thread is the one that serves the sockets; its time in nanoseconds comes first.
    std::ifstream("/proc/" + std::to_string(program.process()) + "/schedstat") >> work.net_ms;
    work.net_ms /= 1e6;
    return work;
}

void add(Work& sum, const Work& after, const Work& before) {
    for (double Work::*part : {&Work::changes, &Work::seen, &Work::rendered, &Work::encoded, &Work::sent,
                               &Work::bytes, &Work::cpu_ms, &Work::net_ms})
        sum.*part += after.*part - before.*part;
}

}  // namespace

TEST_CASE("another watcher costs a write to his socket, and no drawing") {
    constexpr int kRounds = 3;
    constexpr auto kLasts = 4s;
    Program program(serve());
    struct Row {
        Work work;
        std::vector<double> waited_ms;
    };
    std::map<std::size_t, Row> rows;
    for (int round = 0; round < kRounds; ++round)
        for (const std::size_t watchers : {1U, 8U, 32U, 128U}) {
            Audience audience(program.port(), 1 + watchers);
            audience.work_until(Clock::now() + 1s);
            audience.forget();
            const Work before = work_of(program, audience);
            audience.work_until(Clock::now() + kLasts);
            add(rows[watchers].work, work_of(program, audience), before);
            const std::vector<double>& waited = audience.waited_ms();
            rows[watchers].waited_ms.insert(rows[watchers].waited_ms.end(), waited.begin(), waited.end());
        }
    std::printf("%8s %9s %9s | %7s %7s %7s | %8s %8s | %8s %8s %8s\n", "", "changes", "delivered", "p50",
                "p95", "p99", "rendered", "encoded", "KB", "CPU ms", "net ms");
    std::printf("%8s %9s %9s | %23s | %17s | %8s %17s\n", "watchers", "per s", "per s", "input to frame, ms",
                "per change", "a frame", "per change");
    for (auto& [watchers, row] : rows) {
        const Work& work = row.work;
        const double seconds = kRounds * std::chrono::duration<double>(kLasts).count();
        std::printf("%8zu %9.1f %9.1f | %7.1f %7.1f %7.1f | %8.2f %8.2f | %8.1f %8.2f %8.3f\n", watchers,
                    work.changes / seconds, work.seen / seconds, percentile(row.waited_ms, 0.5),
                    percentile(row.waited_ms, 0.95), percentile(row.waited_ms, 0.99),
                    work.rendered / work.changes, work.encoded / work.changes, work.bytes / work.sent / 1e3,
                    work.cpu_ms / work.changes, work.net_ms / work.changes);
        CHECK(work.rendered < 1.2 * work.changes);
        CHECK(work.encoded < 1.2 * work.changes);
        CHECK(work.seen > 0.9 * static_cast<double>(1 + watchers) * work.changes);
    }
    const Work &few = rows[1].work, &many = rows[128].work;
    std::printf("a frame for another watcher: %.1f us of the thread that serves the sockets\n",
                1e3 * (many.net_ms / many.changes - few.net_ms / few.changes) / 127);
}

TEST_CASE("a client that stands still does not delay twenty others") {
    constexpr int kRuns = 10;
    constexpr auto kLasts = 4s;
    Program program(serve());
    Audience audience(program.port(), 20);
    audience.work_until(Clock::now() + 2s);
    std::vector<double> p99[2];
    for (int run = 0; run < 2 * kRuns; ++run) {
        const bool stands = run % 4 == 1 || run % 4 == 2;  // by turns, first and second
        std::optional<RawSocket> still;
        if (stands) still.emplace(standing_client(program.port(), 900));
        audience.work_until(Clock::now() + 500ms);
        audience.forget();
        audience.work_until(Clock::now() + kLasts);
        p99[stands].push_back(audience.percentile(0.99));
    }
    const auto tell = [&](const char* name, std::vector<double>& ms) {
        std::printf("%-24s median p99 %7.1f ms, quartiles %.1f to %.1f, from %.1f to %.1f\n", name,
                    percentile(ms, 0.5), percentile(ms, 0.25), percentile(ms, 0.75), percentile(ms, 0),
                    percentile(ms, 1));
    };
    tell("20 clients", p99[0]);
    tell("and one who stands still", p99[1]);
    const double ratio = percentile(p99[1], 0.5) / percentile(p99[0], 0.5);
    std::printf("ratio %.3f\n", ratio);
    CHECK(ratio < 1.1);
}
