#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "commands/commands.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

namespace {

/// The command line of this process.
std::vector<std::string> own_words() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size(); at += words.back().size() + 1)
        words.emplace_back(text.c_str() + at);
    return words;
}

}  // namespace

void chart_command(const ChartArguments&) {
    const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
    std::vector<std::string> words = own_words();
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    // As built, and as installed.
    for (const fs::path& path :
         {folder / "vrut-preview-chart", folder / "../libexec/vrut-preview/vrut-preview-chart"}) {
        if (!fs::exists(path)) continue;
        execv(path.c_str(), pointers.data());
        throw std::runtime_error(path.string() + " cannot be started: " + std::strerror(errno));
    }
    throw std::runtime_error(
        "what charts and measures is a program of its own, which is not built: run 'cmake --build " +
        folder.parent_path().string() + " --target vrut-preview-chart', and start again");
}

}  // namespace vrut::server::commands
