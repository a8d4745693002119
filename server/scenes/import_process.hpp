#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "io/read_scene.hpp"

namespace vrut::server::scenes {

/// What reading one file may take in a process of its own.
struct ImportLimits {
    std::uint64_t bytes = 0;  ///< of memory
    std::chrono::seconds time{0};
};

/// How a scene's file is read.
struct ImportOptions {
    std::optional<ImportLimits> limits;  ///< none: import_limits()
    io::ReadOptions read;
};

/// 4 GiB and 40 times the file's size, but at most half of the memory that is free; 5 minutes and a second
/// for each MiB.
ImportLimits import_limits(const std::filesystem::path& path);

/// As read_scene(), but what a foreign library reads is read by a child process, so that nothing which the
/// file does to it ends this one. Throws what `progress` throws, the child being ended first, and
/// std::system_error where no process can be started.
io::ReadResult import_scene(const std::filesystem::path& path, const io::ReadProgress& progress = {},
                            const ImportOptions& options = {});

/// Says that there is not enough memory for the scene in `path`, and what to do.
std::string out_of_memory(const std::filesystem::path& path);

/// The child's side: argv of `PROGRAM import FILE BYTES SECONDS y|z STUDIO [TEXTURE-FOLDER]...`, which
/// import_scene() starts with this very program; main() comes here first. STUDIO is an io::Studio as a
/// number.
bool is_import_process(int argc, char** argv);
[[noreturn]] void run_import_process(char** argv);

}  // namespace vrut::server::scenes
