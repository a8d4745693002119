#include "observe/progress.hpp"

#include <doctest/doctest.h>
#include <pty.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "contains.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace std::chrono_literals;

namespace {

/// Standard error is a terminal, or else a pipe, as long as the object lives.
class OtherStandardError {
public:
    explicit OtherStandardError(bool terminal) : before_(dup(STDERR_FILENO)) {
        int ends[2];
        if (terminal)
            REQUIRE(openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) == 0);
        else
            REQUIRE(pipe(ends) == 0);
        dup2(ends[1], STDERR_FILENO);
        close(ends[1]);
        out_ = ends[0];
    }
    ~OtherStandardError() {
        dup2(before_, STDERR_FILENO);
        close(before_);
        close(out_);
    }
    OtherStandardError(const OtherStandardError&) = delete;
    OtherStandardError& operator=(const OtherStandardError&) = delete;

    /// What was written, after one mark that is not.
    std::string written() const {
        REQUIRE(write(STDERR_FILENO, "$", 1) == 1);
        std::string text;
        for (char c = 0; read(out_, &c, 1) == 1 && c != '$';) text += c;
        return text;
    }

private:
    int before_, out_ = -1;
};

}  // namespace

TEST_CASE("on a terminal a bar shows how far loading is, from half a second on, and goes with the end") {
    const OtherStandardError error(true);
    auto bar = loading_bar("car.glb");
    REQUIRE(bar);
    bar(0.25);
    CHECK(error.written().empty());
    std::this_thread::sleep_for(510ms);
    bar(0.5);
    const std::string text = error.written();
    CHECK_MESSAGE(contains(text, "[###############...............]  50 % car.glb"), text);
    bar(0.501);
    CHECK(error.written().empty());
    bar = {};
    CHECK(error.written() == "\r\033[K");
}

TEST_CASE("elsewhere loading shows nothing") {
    const OtherStandardError error(false);
    CHECK_FALSE(loading_bar("car.glb"));
}

TEST_CASE("elsewhere each thing begun has a line") {
    const OtherStandardError error(false);
    {
        Progress progress;
        progress.show(0, "one");
        progress.show(0.5, "one");
        progress.show(0.75, "two");
    }
    CHECK(error.written() == "  0 % one\n 75 % two\n");
}
