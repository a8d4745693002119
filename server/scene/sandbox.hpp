#pragma once

#include <filesystem>

namespace vrut::server::scene {

/// What of a sandbox the kernel does not have, or does not let this process have.
struct SandboxGaps {
    bool files = false;         ///< Landlock (Linux 5.13): files are as open as to any process of the user
    bool system_calls = false;  ///< seccomp, or a list of calls for this kind of processor
};

/// Confines the calling thread, and what it starts, for good: it opens no file but `scene_file` and those in
/// its folder and below, and these for reading only, wherever links lead; it has no system calls but those
/// that reading, memory and ending take: none for sockets, processes, other processes' signals or folders'
/// lists. What is open stays open. What else there is of it holds where a part is missing.
SandboxGaps enter_sandbox(const std::filesystem::path& scene_file);

}  // namespace vrut::server::scene
