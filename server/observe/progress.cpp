#include "observe/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include "base/clock.hpp"

namespace vrut::server::observe {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (terminal_ && percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::show(double part, const std::string& what) {
    constexpr int kWidth = 30;
    const int percent = static_cast<int>(100 * std::clamp(part, 0.0, 1.0));
    if (what == what_ && (!terminal_ || percent == percent_)) return;
    percent_ = percent;
    what_ = what;
    if (!terminal_) {
        std::fprintf(stderr, "%3d %% %s\n", percent, what.c_str());
        return;
    }
    std::string bar(kWidth, '.');
    std::fill_n(bar.begin(), kWidth * percent / 100, '#');
    std::fprintf(stderr, "\r[%s] %3d %% %.*s\033[K", bar.c_str(), percent, 60, what.c_str());
    std::fflush(stderr);
}

std::function<void(double)> loading_bar(const std::string& what) {
    constexpr std::chrono::milliseconds kPatience{500};
    if (isatty(STDERR_FILENO) != 1) return {};
    return [bar = std::make_shared<Progress>(), what, kPatience, start = base::Clock::now()](double part) {
        if (base::Clock::now() - start > kPatience) bar->show(part, what);
    };
}

}  // namespace vrut::server::observe
