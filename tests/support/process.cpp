#include "process.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace vrut::test {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(pid_t process) { return "/proc/" + std::to_string(process); }

/// The fields of proc_pid_stat(5) from the third on, which is the state: what stands before it is a name.
std::vector<std::string> stat_of(const fs::path& folder) {
    std::ifstream stream(folder / "stat");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    std::istringstream fields(text.erase(0, text.rfind(')') + 1));
    return {std::istream_iterator<std::string>(fields), {}};
}
constexpr std::size_t kState = 0, kParent = 1, kUserTime = 11, kSystemTime = 12, kThreads = 17,
                      kResident = 21;

}  // namespace

ProcessUse use_of(pid_t process) {
    const std::vector<std::string> stat = stat_of(folder_of(process));
    REQUIRE(stat.size() > kResident);
    const auto number = [&](std::size_t field) { return std::stod(stat[field]); };
    ProcessUse use;
    use.resident_mb = number(kResident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
    use.cpu_s = (number(kUserTime) + number(kSystemTime)) / static_cast<double>(sysconf(_SC_CLK_TCK));
    use.threads = std::stol(stat[kThreads]);
    use.descriptors =
        std::distance(fs::directory_iterator(folder_of(process) / "fd"), fs::directory_iterator());
    return use;
}

std::vector<pid_t> children_of(pid_t process) {
    std::vector<pid_t> children;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::vector<std::string> stat = stat_of(entry.path());
        if (stat.size() > kParent && stat[kParent] == std::to_string(process) && stat[kState] != "Z")
            children.push_back(std::stoi(name));
    }
    return children;
}

}  // namespace vrut::test
