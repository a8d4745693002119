#include "commands/stop_signals.hpp"

#include <array>
#include <csignal>

namespace vrut::server::commands {

namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t stop_signal_came = 0;

void remember(int) { stop_signal_came = 1; }

}  // namespace

StopSignals::StopSignals() {
    stop_signal_came = 0;
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

StopSignals::~StopSignals() {
    for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

bool StopSignals::came() const { return stop_signal_came != 0; }

}  // namespace vrut::server::commands
