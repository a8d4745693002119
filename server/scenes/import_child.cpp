#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include "io/scene_serialization.hpp"
#include "scenes/import_channel.hpp"
#include "scenes/import_process.hpp"
#include "scenes/sandbox.hpp"

namespace vrut::server::scenes {

namespace {

void limit(__rlimit_resource what, std::uint64_t soft, std::uint64_t hard) {
    const rlimit limits{soft, hard};
    if (setrlimit(what, &limits) != 0) throw std::system_error(errno, std::generic_category(), "setrlimit");
}

/// Bytes of data that the process holds already.
std::uint64_t data_size() {
    std::ifstream stream("/proc/self/statm");
    std::uint64_t pages = 0;
    for (int field = 0; field < 6; ++field) stream >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit_itself(std::uint64_t bytes, std::uint64_t seconds) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::ofstream("/proc/self/oom_score_adj") << 1000;  // where memory runs out all the same, this one ends
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_CPU, seconds, seconds + 1);
    limit(RLIMIT_FSIZE, 0, 0);  // nothing on disk
    const std::uint64_t data = data_size() + bytes;
    limit(RLIMIT_DATA, data, data);
    std::set_new_handler([] { _exit(kOutOfMemory); });
}

/// Where nobody reads any more the process ends (SIGPIPE).
void write_all(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(kChannel, bytes.data(), bytes.size());
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
        if (written < 0 && errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "the parts cannot be written");
    }
}

/// Of arguments from `y|z` on, which end with a null pointer.
io::ReadOptions options_of(char** arguments) {
    io::ReadOptions options;
    options.z_up = std::strcmp(*arguments, "z") == 0;
    options.studio = static_cast<io::Studio>(std::atoi(*++arguments));
    while (*++arguments != nullptr) options.texture_folders.emplace_back(*arguments);
    return options;
}

void report(double fraction) { write_all({reinterpret_cast<const char*>(&fraction), sizeof fraction}); }

}  // namespace

bool is_import_process(int argc, char** argv) { return argc >= 7 && std::strcmp(argv[1], "import") == 0; }

/// Ends without freeing what it has read: the system does that at once.
void run_import_process(char** argv) try {
    limit_itself(std::strtoull(argv[3], nullptr, 10), std::strtoull(argv[4], nullptr, 10));
    report(0);  // the first: whether the parent lives, whose end before limit_itself() was not noticed
    const io::ReadOptions options = options_of(argv + 5);
    const SandboxGaps gaps = enter_sandbox(argv[2], options.texture_folders);
    if (gaps.files) report(kFilesOpen);
    if (gaps.system_calls) report(kCallsOpen);
    io::PartsResult parts = io::read_scene_parts(argv[2], report, options);
    report(kReady);
    io::serialize_parts(std::move(parts), write_all);
    _exit(0);
} catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
} catch (const std::exception&) {
    _exit(1);
}

}  // namespace vrut::server::scenes
