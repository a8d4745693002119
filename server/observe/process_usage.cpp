#include "observe/process_usage.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace vrut::server::observe {

namespace {

double seconds_of(clockid_t clock) {
    std::timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

std::uint64_t resident_bytes() {
    std::ifstream stream("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    stream >> all >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// At the limit the folder that lists them cannot be opened: then it is the limit.
std::uint64_t open_descriptors(std::uint64_t limit) {
    std::error_code error;
    const std::filesystem::directory_iterator list("/proc/self/fd", error);
    if (error) return limit;
    return static_cast<std::uint64_t>(std::distance(begin(list), end(list))) - 1;  // but for the list's own
}

const double kStarted = seconds_of(CLOCK_REALTIME);

}  // namespace

ProcessUsage process_usage() {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    return {kStarted, seconds_of(CLOCK_PROCESS_CPUTIME_ID), resident_bytes(),
            open_descriptors(limit.rlim_cur), limit.rlim_cur};
}

}  // namespace vrut::server::observe
