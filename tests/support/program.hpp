#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "process.hpp"
#include "temporary_folder.hpp"

namespace vrut::test {

/// `vrut-preview` as its users start it: a process of its own, with nothing kept from before, killed with the
/// object. What it writes to
/// standard output and standard error is kept, and does not go on until it is read.
class Program {
public:
    explicit Program(const std::vector<std::string>& arguments);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    pid_t process() const { return process_; }
    /// Of the server, once it tells that it listens; fails the test where it ends instead.
    std::uint16_t port();
    void signal(int number) const;
    /// As waitpid() has it, once it has ended; none where that takes longer.
    std::optional<int> wait(std::chrono::milliseconds timeout);
    /// All that it wrote, once it has ended.
    std::string output();

private:
    bool read_more();

    TemporaryFolder state_;
    pid_t process_ = 0;
    int writes_ = -1;
    std::string output_;
    std::optional<int> status_;
};

}  // namespace vrut::test
