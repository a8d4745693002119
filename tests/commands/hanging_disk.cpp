// A disk that answers until the file named by VRUT_TEST_DISK_HANGS is there, and then never: for logs of
// recordings, in a program that this is preloaded into.
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

bool is_log(int descriptor) {
    char path[PATH_MAX];
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const ssize_t length = readlink(link.c_str(), path, sizeof path);
    return length > 0 && std::string_view(path, static_cast<std::size_t>(length)).ends_with(".jsonl");
}

bool hangs() {
    const char* marker = std::getenv("VRUT_TEST_DISK_HANGS");
    return marker && access(marker, F_OK) == 0;
}

}  // namespace

extern "C" ssize_t write(int descriptor, const void* bytes, std::size_t size) {
    using Write = ssize_t (*)(int, const void*, std::size_t);
    static const auto next = reinterpret_cast<Write>(dlsym(RTLD_NEXT, "write"));
    while (hangs() && is_log(descriptor)) pause();
    return next(descriptor, bytes, size);
}
