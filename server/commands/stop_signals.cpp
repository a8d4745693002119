#include "commands/stop_signals.hpp"

#include <array>
#include <csignal>

namespace vrut::server::commands {

namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t stop_signal_came = 0;

void remember(int) { stop_signal_came = 1; }

}  // namespace

StopSignals::StopSignals() {
    stop_signal_came = 0;
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
    }
}

StopSignals::~StopSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::came() const { return stop_signal_came != 0; }

}  // namespace vrut::server::commands
