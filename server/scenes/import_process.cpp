#include "scenes/import_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "base/abandonable_task.hpp"
#include "base/clock.hpp"
#include "base/descriptor.hpp"
#include "io/scene_serialization.hpp"
#include "observe/log.hpp"
#include "scenes/import_channel.hpp"

namespace vrut::server::scenes {

namespace {

int checked(int result, const char* what) {
    if (result < 0) throw std::system_error(errno, std::generic_category(), what);
    return result;
}

void check_error(int error, const char* what) {
    if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

/// How a process is started: with its end of the channel, and nothing else that is open here.
class SpawnSetup {
public:
    explicit SpawnSetup(int channel) {
        check_error(posix_spawn_file_actions_init(&actions_), "a process cannot be prepared");
        check_error(posix_spawnattr_init(&attributes_), "a process cannot be prepared");
        for (int standard = 0; standard < kChannel; ++standard)
            posix_spawn_file_actions_addopen(&actions_, standard, "/dev/null", O_RDWR, 0);
        posix_spawn_file_actions_adddup2(&actions_, channel, kChannel);
        posix_spawn_file_actions_addclosefrom_np(&actions_, kChannel + 1);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnSetup() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnSetup(const SpawnSetup&) = delete;
    SpawnSetup& operator=(const SpawnSetup&) = delete;

    pid_t start(std::vector<std::string> arguments) const {
        std::vector<char*> argv = pointers_to(arguments);
        std::vector<std::string> variables = passed_variables();
        std::vector<char*> environment = pointers_to(variables);
        pid_t process = 0;
        check_error(
            posix_spawn(&process, "/proc/self/exe", &actions_, &attributes_, argv.data(), environment.data()),
            "no process can be started to read a file");
        return process;
    }

private:
    /// What the program cannot start without, and the options of the sanitizers: the rest, tokens too, is not
    /// for a foreign file.
    static std::vector<std::string> passed_variables() {
        std::vector<std::string> passed;
        for (const char* name :
             {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"})
            if (const char* value = std::getenv(name)) passed.push_back(std::string(name) + "=" + value);
        return passed;
    }
    /// With a null at the end.
    static std::vector<char*> pointers_to(std::vector<std::string>& texts) {
        std::vector<char*> pointers(texts.size() + 1);
        std::transform(texts.begin(), texts.end(), pointers.begin(),
                       [](std::string& text) { return text.data(); });
        return pointers;
    }

    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

/// A started process, which is ended and reaped with the object.
class Child {
public:
    explicit Child(pid_t process) : process_(process) {}
    ~Child() {
        if (status_) return;
        kill(process_, SIGKILL);
        reap();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// As waitpid() has it; none while it runs.
    std::optional<int> status() {
        int status = 0;
        if (!status_ && waitpid(process_, &status, WNOHANG) == process_) status_ = status;
        return status_;
    }

private:
    /// One that hangs in the kernel, as on a disk that does not answer, ends when the kernel lets it.
    void reap() const try {
        const base::AbandonableTask<void> reaper([process = process_](const std::stop_token&) {
            while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
            }
        });
    } catch (const std::system_error&) {  // no thread can be had
        waitpid(process_, nullptr, WNOHANG);
    }

    pid_t process_;
    std::optional<int> status_;
};

struct Pipe {
    base::Descriptor out{-1}, in{-1};

    Pipe() {
        int ends[2];
        checked(pipe2(ends, O_CLOEXEC), "no pipe is left");
        out = base::Descriptor(ends[0]);
        in = base::Descriptor(ends[1]);
        // Away from the number that it has in the child.
        in = base::Descriptor(
            checked(fcntl(in.number(), F_DUPFD_CLOEXEC, kChannel + 1), "no descriptor is left"));
        checked(fcntl(out.number(), F_SETFL, O_NONBLOCK), "a pipe cannot be read");
        fcntl(out.number(), F_SETPIPE_SZ, 1 << 20);  // for speed; where it may be no larger, it stays small
    }
};

/// Once: it is the same for every file.
void warn_of_open_reader(bool files) {
    static std::atomic<bool> warned[2];
    if (!warned[files].exchange(true))
        observe::log_warning(
            "reader_not_confined",
            {{"open", files ? "files, since the kernel has no Landlock or does not let it be used"
                            : "system calls, since there is no seccomp for them"}});
}

constexpr const char* kMemoryRemedy =
    "; free some memory on the server's machine, or open a scene with fewer triangles or smaller textures";

std::string memory_text(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

/// The reading of one file in a child process, as long as the object lives.
class Import {
public:
    Import(const std::filesystem::path& path, const io::ReadProgress& progress, const ImportLimits& limits,
           const io::ReadOptions& options)
        : path_(path),
          progress_(progress),
          limits_(limits),
          end_(base::Clock::now() + limits.time),
          child_(SpawnSetup(pipe_.in.number()).start(arguments(path, limits, options))) {
        pipe_.in.close();
    }

    io::PartsResult read() try {
        const io::ByteSource source = [this](void* to, std::size_t size) {
            fill(static_cast<char*>(to), size);
        };
        for (double report = 0; report != kReady; source(&report, sizeof report)) handle(report);
        return io::deserialize_parts(source, limits_.bytes, path_.string());
    } catch (const Fault& fault) {
        return tl::unexpected(path_.string() + ": " + fault.what());
    }

private:
    /// Why nothing more comes.
    struct Fault : std::runtime_error {
        using std::runtime_error::runtime_error;
    };

    /// See run_import_process().
    static std::vector<std::string> arguments(const std::filesystem::path& path, const ImportLimits& limits,
                                              const io::ReadOptions& options) {
        std::vector<std::string> all = {"vrut-preview",
                                        "import",
                                        path.string(),
                                        std::to_string(limits.bytes),
                                        std::to_string(limits.time.count()),
                                        options.z_up ? "z" : "y",
                                        std::to_string(static_cast<int>(options.studio))};
        for (const std::filesystem::path& folder : options.texture_folders) all.push_back(folder.string());
        return all;
    }
    void handle(double report) {
        if (report == kFilesOpen || report == kCallsOpen)
            warn_of_open_reader(report == kFilesOpen);
        else if (report > fraction_)
            fraction_ = std::min(report, 1.0);
    }
    void fill(char* to, std::size_t size) {
        check_deadline();
        while (size > 0) {
            const ssize_t got = ::read(pipe_.out.number(), to, size);
            if (got == 0) fail();
            if (got > 0) {
                to += got;
                size -= static_cast<std::size_t>(got);
            } else if (errno == EAGAIN) {
                wait_for_more();
            } else if (errno != EINTR) {
                checked(-1, "a pipe cannot be read");
            }
        }
    }
    void check_deadline() const {
        if (base::Clock::now() > end_)
            throw Fault("it is not read within " + std::to_string(limits_.time.count()) + " s");
        if (progress_) progress_(fraction_);
    }
    void wait_for_more() const {
        constexpr int kMilliseconds = 20;
        pollfd waited{pipe_.out.number(), POLLIN, 0};  // a closed one just passes the time
        poll(&waited, 1, kMilliseconds);
        check_deadline();
    }
    /// The child has closed its end of the channel: it has ended, or does soon.
    [[noreturn]] void fail() {
        pipe_.out.close();
        for (;; wait_for_more())
            if (const auto status = child_.status()) throw Fault(fault_of(*status));
    }
    std::string fault_of(int status) const {
        if (WIFSIGNALED(status)) {
            const char* name = sigdescr_np(WTERMSIG(status));
            return "its reader ended with signal " + std::to_string(WTERMSIG(status)) + " (" +
                   (name != nullptr ? name : "unknown") + ")";
        }
        if (WEXITSTATUS(status) == kOutOfMemory)
            return "to read it takes more than the " + memory_text(limits_.bytes) +
                   " of memory that it may take" + kMemoryRemedy;
        return "its reader ended with status " + std::to_string(WEXITSTATUS(status)) + " too early";
    }

    const std::filesystem::path& path_;
    const io::ReadProgress& progress_;
    const ImportLimits limits_;
    const base::Clock::time_point end_;
    double fraction_ = 0;
    Pipe pipe_;
    Child child_;
};

/// Bytes; as much as can be counted where the system does not say.
std::uint64_t free_memory() {
    std::ifstream stream("/proc/meminfo");
    std::string word;
    while (stream >> word)
        if (std::uint64_t kib = 0; word == "MemAvailable:" && stream >> kib) return kib << 10;
    return UINT64_MAX;
}

}  // namespace

ImportLimits import_limits(const std::filesystem::path& path) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    const std::uint64_t file = error ? 0 : std::min<std::uintmax_t>(size, std::uint64_t{1} << 50);
    return {std::min((std::uint64_t{4} << 30) + 40 * file, free_memory() / 2),
            std::chrono::seconds(300 + (file >> 20))};
}

std::string out_of_memory(const std::filesystem::path& path) {
    return path.string() + ": there is not enough memory for it" + kMemoryRemedy;
}

io::ReadResult import_scene(const std::filesystem::path& path, const io::ReadProgress& progress,
                            const ImportOptions& options) try {
    if (!io::has_foreign_reader(path)) return io::read_scene(path, progress, options.read);
    Import reading(path, progress, options.limits ? *options.limits : import_limits(path), options.read);
    auto parts = reading.read();
    if (!parts) return tl::unexpected(parts.error());
    return io::build_scene(*std::move(parts), path.string());  // while the child ends
} catch (const std::bad_alloc&) {
    return tl::unexpected(out_of_memory(path));
}

}  // namespace vrut::server::scenes
