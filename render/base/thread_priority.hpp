#pragma once

#include <sys/resource.h>

namespace vrut::base {

/// Lets other threads run first. On Linux a thread has a niceness of its own.
inline void lower_thread_priority() { static_cast<void>(setpriority(PRIO_PROCESS, 0, 10)); }

}  // namespace vrut::base
