// A slow link in front of a server on this machine, for tests in any language. Prints the port that clients
// connect to as one line, then reads commands, one a line, until its input ends.
#include <CLI/CLI.hpp>
#include <boost/asio/post.hpp>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "slow_link.hpp"

namespace {

using namespace vrut::test_support;

constexpr double kLongest = 1e9;  // ms

/// A link and the quality that it has now.
struct Steered {
    SlowLink& link;
    LinkQuality quality;
};

std::chrono::milliseconds milliseconds(double ms) { return std::chrono::milliseconds(std::llround(ms)); }

/// False where there is no such command.
bool obey(const std::string& line, Steered& steered) {
    std::istringstream words(line);
    std::string command;
    double number = 0;
    words >> command;
    if (command == "cut" && (words >> std::ws).eof()) {
        steered.link.cut();
        return true;
    }
    if (!(words >> number) || !(words >> std::ws).eof() || !(number >= 0 && number <= kLongest)) return false;
    if (command == "rate" && number > 0) {
        steered.quality.bytes_per_second = number;
    } else if (command == "delay") {
        steered.quality.delay = milliseconds(number);
    } else if (command == "stall") {
        steered.link.stall_until(Clock::now() + milliseconds(number));
    } else {
        return false;
    }
    steered.link.set_quality(steered.quality);
    return true;
}

int run(std::uint16_t server_port, const LinkQuality& quality) {
    boost::asio::io_context context{1};
    SlowLink link(context, server_port, quality);
    Steered steered{link, quality};
    int status = 0;
    std::cout << link.port() << std::endl;
    std::thread input([&] {
        for (std::string line; std::getline(std::cin, line);)
            boost::asio::post(context, [&, line] {
                if (obey(line, steered)) return;
                std::cerr << "slow_link: there is no command '" << line
                          << "'; there are: rate BYTES_PER_SECOND, delay MS, stall MS, cut\n";
                status = 1;
            });
        boost::asio::post(context, [&] { context.stop(); });
    });
    context.run();
    input.join();
    return status;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app("A slow link in front of a server on this machine");
    std::uint16_t port = 0;
    LinkQuality quality;
    double delay_ms = 0;
    app.add_option("--to", port, "the server's port")->required()->check(CLI::Range(1, 65'535));
    app.add_option("--bytes-per-second", quality.bytes_per_second, "each way")
        ->check(CLI::Range(1.0, kLongest));
    app.add_option("--delay-ms", delay_ms, "each way")->check(CLI::Range(0.0, kLongest));
    CLI11_PARSE(app, argc, argv);
    quality.delay = milliseconds(delay_ms);
    return run(port, quality);
} catch (const std::exception& error) {
    std::cerr << "slow_link: " << error.what() << "\n";
    return 1;
}
