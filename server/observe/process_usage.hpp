#pragma once

#include <cstdint>

namespace vrut::server::observe {

/// What this process uses, as Linux counts it.
struct ProcessUsage {
    double started = 0;  ///< seconds since 1970
    double cpu_seconds = 0;
    std::uint64_t resident_bytes = 0;
    std::uint64_t descriptors = 0, most_descriptors = 0;
};

/// Now; what /proc does not tell is 0.
ProcessUsage process_usage();

}  // namespace vrut::server::observe
