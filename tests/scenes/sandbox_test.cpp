// What the process that reads foreign files can still do. Each attempt is made by a process of its own, since
// nothing leads out of a sandbox.
#define DOCTEST_CONFIG_IMPLEMENT
#include "scenes/sandbox.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "environment_variable.hpp"
#include "needs.hpp"
#include "observe/log.hpp"
#include "scenes/import_process.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
namespace fs = std::filesystem;

/// What reads a file is this program, started anew.
int main(int argc, char** argv) {
    if (is_import_process(argc, argv)) run_import_process(argv);
    return doctest::Context(argc, argv).run();
}

namespace {

/// 0, or the error of a call that failed.
int error_of(long result) { return result < 0 ? errno : 0; }

/// What `attempt` returns in a process of its own; 1000 and the signal where one ends it.
int in_a_process(const std::function<int()>& attempt) {
    const pid_t process = fork();
    if (process == 0) _exit(attempt());
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

int confined(const fs::path& scene_file, const std::function<int()>& attempt) {
    return in_a_process([&] {
        enter_sandbox(scene_file);
        return attempt();
    });
}

int open_to_read(const fs::path& path) { return error_of(open(path.c_str(), O_RDONLY | O_CLOEXEC)); }

/// Makes a system call fail as if the kernel did not have it.
void remove_call(int call) {
    sock_filter program[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    const sock_fprog all{std::size(program), program};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all);
}

bool kernel_has_landlock() {
    return in_a_process([] { return static_cast<int>(enter_sandbox("/").files); }) == 0;
}

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// A scene in a folder, with a picture in a folder below, and files beside that folder.
struct SceneFolder {
    const TemporaryFolder folder;
    const fs::path file = folder.write(
        "scene/car.obj", std::string("mtllib ../outside.mtl\n") + kTriangle + "usemtl red\nf 1 2 3\n");
    const fs::path picture = folder.write("scene/pictures/red.png", "no picture");
    const fs::path beside = folder.write("outside.mtl", "newmtl red\nKd 1 0 0\n");
};

}  // namespace

TEST_CASE("of files, those of the scene's folder are open, and for reading only" *
          Needs(kernel_has_landlock(), "Landlock")) {
    const SceneFolder scene;
    fs::create_symlink(scene.beside, scene.file.parent_path() / "link.mtl");
    fs::create_directory_symlink(scene.folder.path(), scene.file.parent_path() / "up");
    const fs::path neighbour = scene.folder.write("scene-2/car.obj", kTriangle);
    CHECK(confined(scene.file, [&] { return open_to_read(scene.file); }) == 0);
    CHECK(confined(scene.file, [&] { return open_to_read(scene.picture); }) == 0);
    for (const fs::path& path :
         {scene.beside, neighbour, scene.file.parent_path() / "link.mtl",
          scene.file.parent_path() / "up/outside.mtl", fs::path("/etc/passwd"),
          fs::path("/proc/self/environ"), fs::path("/proc/" + std::to_string(getpid()) + "/environ")}) {
        CAPTURE(path);
        CHECK(confined(scene.file, [&] { return open_to_read(path); }) == EACCES);
    }
    CHECK(confined(scene.file, [&] { return error_of(open(scene.file.c_str(), O_WRONLY)); }) == EACCES);
    CHECK(confined(scene.file, [&] {
              return error_of(open((scene.file.parent_path() / "new").c_str(), O_WRONLY | O_CREAT, 0600));
          }) == EACCES);
}

TEST_CASE("folders of textures are open, and for reading only" * Needs(kernel_has_landlock(), "Landlock")) {
    const SceneFolder scene;
    const fs::path maps = fs::path(scene.folder.write("maps/a.png", "no picture")).parent_path();
    const auto with_maps = [&](const fs::path& path, int how) {
        return in_a_process([&] {
            enter_sandbox(scene.file, {maps});
            return error_of(open(path.c_str(), how));
        });
    };
    CHECK(with_maps(maps / "a.png", O_RDONLY) == 0);
    CHECK(with_maps(scene.file, O_RDONLY) == 0);
    CHECK(with_maps(maps / "a.png", O_WRONLY) == EACCES);
    CHECK(with_maps(scene.beside, O_RDONLY) == EACCES);
}

TEST_CASE("a scene that somebody names by a link is open, and what lies beside the link" *
          Needs(kernel_has_landlock(), "Landlock")) {
    const SceneFolder scene;
    const fs::path named = scene.folder.path() / "named/car.obj";
    fs::create_directories(named.parent_path());
    fs::create_symlink(scene.file, named);
    CHECK(confined(named, [&] { return open_to_read(named); }) == 0);
    CHECK(confined(named, [&] { return open_to_read(scene.picture); }) == EACCES);
    const int before = open(".", O_PATH | O_DIRECTORY | O_CLOEXEC);
    REQUIRE(chdir(scene.file.parent_path().c_str()) == 0);
    CHECK(confined("car.obj", [&] { return open_to_read("car.obj"); }) == 0);
    CHECK(confined("car.obj", [&] { return open_to_read("../outside.mtl"); }) == EACCES);
    REQUIRE(fchdir(before) == 0);
    close(before);
}

TEST_CASE("there is no network, no other process, and no limit of another's") {
    const SceneFolder scene;
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(listener, reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    const int ready = socket(AF_INET, SOCK_STREAM, 0);
    const rlimit limits{64, 64};
    const std::pair<std::string, std::function<int()>> kAttempts[] = {
        {"socket", [] { return error_of(socket(AF_INET, SOCK_STREAM, 0)); }},
        {"socket of this machine", [] { return error_of(socket(AF_UNIX, SOCK_STREAM, 0)); }},
        {"connect",
         [&] { return error_of(connect(ready, reinterpret_cast<const sockaddr*>(&address), size)); }},
        {"fork", [] { return error_of(syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0)); }},
        {"exec", [] { return error_of(execl("/bin/true", "true", nullptr)); }},
        {"kill", [] { return error_of(kill(getppid(), 0)); }},
        {"tgkill", [] { return error_of(syscall(SYS_tgkill, getppid(), getppid(), 0)); }},
        {"prlimit",
         [&] { return error_of(syscall(SYS_prlimit64, getppid(), RLIMIT_NOFILE, &limits, nullptr)); }},
        {"process_vm_readv",
         [] { return error_of(syscall(SYS_process_vm_readv, getppid(), 0, 0, 0, 0, 0)); }},
        {"unlink", [&] { return error_of(unlink(scene.file.c_str())); }},
        {"io_uring", [] { return error_of(syscall(SYS_io_uring_setup, 0, nullptr)); }},
    };
    for (const auto& attempt : kAttempts) {
        CAPTURE(attempt.first);
        CHECK(confined(scene.file, attempt.second) == EPERM);
    }
    close(ready);
    close(listener);
    CHECK(fs::exists(scene.file));
}

TEST_CASE("memory, time and the end are there") {
    const SceneFolder scene;
    CHECK(confined(scene.file, [] {
              const std::vector<char> large(100 << 20);
              return large[large.size() / 2];
          }) == 0);
    CHECK(confined(scene.file, [] {
              std::signal(SIGABRT, SIG_DFL);
              std::abort();
              return 0;
          }) == 1000 + SIGABRT);
}

TEST_CASE("without Landlock all else holds") {
    const SceneFolder scene;
    CHECK(in_a_process([&] {
              remove_call(SYS_landlock_create_ruleset);
              const SandboxGaps gaps = enter_sandbox(scene.file);
              return gaps.files && !gaps.system_calls ? error_of(socket(AF_INET, SOCK_STREAM, 0)) : -1;
          }) == EPERM);
}

TEST_CASE("the log says once that there is no Landlock, and files are read") {
    const SceneFolder scene;
    int ends[2];
    REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
    CHECK(in_a_process([&] {
              dup2(ends[1], STDERR_FILENO);
              server::observe::start_log();
              remove_call(SYS_landlock_create_ruleset);
              return static_cast<int>(!import_scene(scene.file)) +
                     static_cast<int>(!import_scene(scene.file));
          }) == 0);
    close(ends[1]);
    char said[4096] = {};
    CHECK(read(ends[0], said, sizeof said - 1) > 0);
    const std::string_view all = said, event = "event=reader_not_confined";
    CHECK_MESSAGE(all.find(event) != std::string_view::npos, all);
    CHECK_MESSAGE(all.find(event) == all.rfind(event), all);
    close(ends[0]);
}

TEST_CASE("what reads a foreign file is confined, and gets no variable of the environment") {
    const EnvironmentVariable token("VRUT_PREVIEW_CONTROL_TOKEN", "secret"), other("SOME_VARIABLE", "x");
    const SceneFolder scene;
    std::string text;  // more than a pipe takes: its reader waits while it is looked at
    for (int i = 0; i < 20'000; ++i) text += std::string(kTriangle) + "f -3 -2 -1\n";
    std::string status, environment;
    const auto scene_read = import_scene(scene.folder.write("scene/large.obj", text), [&](double fraction) {
        if (fraction == 0 || !status.empty()) return;
        const fs::path children = "/proc/self/task/" + std::to_string(getpid()) + "/children";
        std::string child;
        std::ifstream(children) >> child;
        const auto told = [&](const char* file) {
            std::ifstream stream("/proc/" + child + "/" + file);
            return std::string(std::istreambuf_iterator<char>(stream), {});
        };
        status = told("status");
        environment = told("environ");
    });
    REQUIRE_MESSAGE(scene_read.has_value(), scene_read.error());
    CHECK_MESSAGE(status.find("Seccomp:\t2") != std::string::npos, status);
    CHECK_MESSAGE(status.find("NoNewPrivs:\t1") != std::string::npos, status);
    CHECK_MESSAGE(environment.find("secret") == std::string::npos, environment);
    CHECK_MESSAGE(environment.find("SOME_VARIABLE") == std::string::npos, environment);
}

TEST_CASE("materials beside the scene are read, and no others") {
    const SceneFolder scene;
    const auto material_of = [&](const fs::path& file) {
        const auto read = import_scene(file);
        REQUIRE_MESSAGE(read.has_value(), read.error());
        return read->materials().front().diffuse;
    };
    CHECK(material_of(scene.file) != glm::dvec4(1, 0, 0, 1));
    const fs::path absolute = scene.folder.write(
        "scene/absolute.obj", "mtllib " + scene.beside.string() + "\n" + kTriangle + "usemtl red\nf 1 2 3\n");
    CHECK(material_of(absolute) != glm::dvec4(1, 0, 0, 1));
    scene.folder.write("scene/inside.mtl", "newmtl red\nKd 1 0 0\n");
    const fs::path inside = scene.folder.write(
        "scene/inside.obj", std::string("mtllib inside.mtl\n") + kTriangle + "usemtl red\nf 1 2 3\n");
    CHECK(material_of(inside) == glm::dvec4(1, 0, 0, 1));
}
