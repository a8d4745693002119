#include "scenes/sandbox.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/descriptor.hpp"

#ifdef VRUT_SANITIZED
#include <sanitizer/common_interface_defs.h>
#endif

namespace vrut::server::scenes {

namespace {

// --- files

/// All that Landlock's first version knows; moving files between folders it denies by itself.
constexpr std::uint64_t kAccesses = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;

/// What cannot be opened is not allowed either.
void allow_to_read(const base::Descriptor& ruleset, const std::filesystem::path& path) {
    const base::Descriptor opened(open(path.c_str(), O_PATH | O_CLOEXEC));
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    rule.parent_fd = opened.number();
    syscall(SYS_landlock_add_rule, ruleset.number(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
}

bool confine_files(const std::filesystem::path& scene_file,
                   const std::vector<std::filesystem::path>& folders) {
    const landlock_ruleset_attr attributes{kAccesses};
    const base::Descriptor ruleset(
        static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0)));
    if (ruleset.number() < 0) return false;
    const std::filesystem::path folder = scene_file.parent_path();
    allow_to_read(ruleset, folder.empty() ? "." : folder);
    allow_to_read(ruleset, scene_file);  // which may be a link out of the folder: somebody has named it
    for (const std::filesystem::path& other : folders) allow_to_read(ruleset, other);
    return syscall(SYS_landlock_restrict_self, ruleset.number(), 0) == 0;
}

// --- system calls

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;  // which no call comes from
#endif

constexpr int kAllowed[] = {
    // files: opened as Landlock lets them be
    SYS_openat, SYS_read, SYS_readv, SYS_pread64, SYS_lseek, SYS_close, SYS_fcntl, SYS_fstat, SYS_newfstatat,
    SYS_statx, SYS_readlinkat, SYS_faccessat, SYS_faccessat2, SYS_getcwd,
#ifdef __x86_64__  // where these are calls of their own
    SYS_open, SYS_stat, SYS_lstat, SYS_readlink, SYS_access,
#endif
    // the channel
    SYS_write, SYS_writev,
    // memory
    SYS_brk, SYS_mmap, SYS_munmap, SYS_mremap, SYS_mprotect, SYS_madvise, SYS_mincore,
    // time, luck, and what the libraries ask of the machine
    SYS_clock_gettime, SYS_clock_getres, SYS_gettimeofday, SYS_clock_nanosleep, SYS_nanosleep,
    SYS_restart_syscall, SYS_getrandom, SYS_getpid, SYS_gettid, SYS_uname, SYS_sysinfo, SYS_sched_getaffinity,
    SYS_sched_yield, SYS_futex,
#ifdef VRUT_SANITIZED  // they try whether memory can be read by writing it to a pipe
    SYS_pipe2,
#endif
    // signals, and the end
    SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_sigaltstack, SYS_exit, SYS_exit_group};

class SystemCallFilter {
public:
    SystemCallFilter() {
        load(offsetof(seccomp_data, arch));
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0));
        finish(kDenied);
        load(offsetof(seccomp_data, nr));
    }
    void allow(int call) {
        pass_unless(static_cast<std::uint32_t>(call), 1);
        finish(SECCOMP_RET_ALLOW);
    }
    /// With this first argument only, an int.
    void allow(int call, std::uint32_t first_argument) {
        pass_unless(static_cast<std::uint32_t>(call), 4);
        load(offsetof(seccomp_data, args));  // its lower half, on processors that begin with it
        pass_unless(first_argument, 1);
        finish(SECCOMP_RET_ALLOW);
        finish(kDenied);
    }
    bool install() {
        finish(kDenied);
        const sock_fprog all{static_cast<unsigned short>(program_.size()), program_.data()};
        return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all) == 0;
    }

private:
    static constexpr std::uint32_t kDenied = SECCOMP_RET_ERRNO | EPERM;

    void load(std::size_t offset) {
        program_.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
    }
    /// Passes over so many instructions where what is loaded is not `value`.
    void pass_unless(std::uint32_t value, std::uint8_t instructions) {
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, instructions));
    }
    void finish(std::uint32_t verdict) { program_.push_back(BPF_STMT(BPF_RET | BPF_K, verdict)); }

    std::vector<sock_filter> program_;
};

bool confine_system_calls() {
    SystemCallFilter filter;
    for (const int call : kAllowed) filter.allow(call);
    filter.allow(SYS_tgkill, static_cast<std::uint32_t>(getpid()));  // abort()
    filter.allow(SYS_prlimit64, 0);                                  // of this process
    return kArchitecture != 0 && filter.install();
}

}  // namespace

SandboxGaps enter_sandbox(const std::filesystem::path& scene_file,
                          const std::vector<std::filesystem::path>& folders) {
#ifdef VRUT_SANITIZED
    __sanitizer_sandbox_arguments nothing_left_open{};
    __sanitizer_sandbox_on_notify(&nothing_left_open);  // they look at /proc/self while they can
#endif
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    SandboxGaps gaps;
    gaps.files = !confine_files(scene_file, folders);
    gaps.system_calls = !confine_system_calls();
    return gaps;
}

}  // namespace vrut::server::scenes
