#pragma once

#include <filesystem>
#include <vector>

namespace vrut::server::scenes {

/// What of a sandbox the kernel does not have, or does not let this process have.
struct SandboxGaps {
    bool files = false;         ///< Landlock (Linux 5.13): files are as open as to any process of the user
    bool system_calls = false;  ///< seccomp, or a list of calls for this kind of processor
};

/// Confines the calling thread and its children for good. They may open `scene_file`, and files in and below
/// its folder and `folders`, for reading only; links that lead elsewhere fail. System calls for sockets, new
/// processes, signals to other processes and lists of folders fail. Open descriptors stay open. If the kernel
/// lacks one part, the other still holds.
SandboxGaps enter_sandbox(const std::filesystem::path& scene_file,
                          const std::vector<std::filesystem::path>& folders = {});

}  // namespace vrut::server::scenes
