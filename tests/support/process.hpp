#pragma once

#include <sys/types.h>

#include <vector>

namespace vrut::test {

#ifdef VRUT_SANITIZED
inline constexpr bool kMemoryTells = false;  // the sanitizers keep what is freed
#else
inline constexpr bool kMemoryTells = true;
#endif

/// What a process holds and has used, as the system tells it.
struct ProcessUse {
    double resident_mb = 0;  ///< 10⁶ bytes
    double cpu_s = 0;        ///< user's and system's
    long descriptors = 0, threads = 0;
};
ProcessUse use_of(pid_t process);

/// Processes of which this one is the parent, those that have ended and are not waited for left out.
std::vector<pid_t> children_of(pid_t process);

}  // namespace vrut::test
