#include "program.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "environment_variable.hpp"
#include "test_client.hpp"

namespace vrut::test {

Program::Program(const std::vector<std::string>& arguments) {
    int ends[2];
    REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
    writes_ = ends[0];
    std::vector<std::string> words{VRUT_PREVIEW};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    for (const int standard : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_adddup2(&actions, ends[1], standard);
    const EnvironmentVariable state("XDG_STATE_HOME", state_.path().c_str());
    REQUIRE(posix_spawn(&process_, VRUT_PREVIEW, &actions, nullptr, argv.data(), environ) == 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
}

Program::~Program() {
    if (!status_) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    close(writes_);
}

bool Program::read_more() {
    char bytes[4096];
    const ssize_t got = read(writes_, bytes, sizeof bytes);
    if (got > 0) output_.append(bytes, static_cast<std::size_t>(got));
    return got > 0;
}

std::uint16_t Program::port() {
    std::size_t at = std::string::npos;
    while ((at = output_.find("listening on http://")) == std::string::npos ||
           output_.find('\n', at) == std::string::npos)
        REQUIRE_MESSAGE(read_more(), "the program ended: " << output_);
    const std::size_t colon = output_.find(':', at + std::strlen("listening on http://"));
    return static_cast<std::uint16_t>(std::stoi(output_.substr(colon + 1)));
}

void Program::signal(int number) const { kill(process_, number); }

std::optional<int> Program::wait(std::chrono::milliseconds timeout) {
    int status = 0;
    eventually(
        [&] {
            if (!status_ && waitpid(process_, &status, WNOHANG) == process_) status_ = status;
            return status_.has_value();
        },
        timeout);
    return status_;
}

std::string Program::output() {
    while (read_more()) {
    }
    return output_;
}

}  // namespace vrut::test
