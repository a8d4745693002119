// Makes all studies in full, or those that are named, and a page of them; fails where one of them does.
#include <filesystem>
#include <iostream>

#include "measure/machine.hpp"
#include "measure/plot.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "stability_page.hpp"

namespace {

using namespace vrut;
using namespace vrut::stability;

constexpr int kFailed = 1, kUsage = 2;

/// All topics where no name is given. Throws std::invalid_argument.
std::vector<Topic> topics_named(const std::vector<std::string>& names) {
    if (names.empty()) return topics();
    std::vector<Topic> chosen;
    for (const std::string& name : names) {
        const auto is_it = [&](const Topic& topic) { return topic.name == name; };
        const auto found = std::find_if(topics().begin(), topics().end(), is_it);
        if (found == topics().end()) throw std::invalid_argument("there is no study of '" + name + "'");
        chosen.push_back(*found);
    }
    return chosen;
}

std::vector<Study> made(const std::vector<Topic>& chosen, renderer::Renderer& renderer) {
    server::observe::Progress progress;
    std::vector<Study> studies;
    for (const Topic& topic : chosen) {
        progress.show(static_cast<double>(studies.size()) / static_cast<double>(chosen.size()), topic.name);
        studies.push_back(topic.study({renderer}));
    }
    return studies;
}

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty()) {
        std::cerr << "stability: usage: stability FOLDER [STUDY...]: writes the page, its charts and "
                     "results.json\n";
        return kUsage;
    }
    const std::vector<Topic> chosen = topics_named({words.begin() + 1, words.end()});
    server::observe::start_log();
    server::measure::require_gnuplot();
    renderer::Renderer renderer;
    const std::filesystem::path folder = words.front();
    std::filesystem::create_directories(folder);
    const std::vector<Study> studies = made(chosen, renderer);
    write_results(studies, folder / "results.json");
    const auto failures = write_page(studies, renderer.description(),
                                     server::measure::machine() + ", VRUT Preview " VRUT_VERSION, folder);
    for (const std::string& failed : failures) std::cerr << "stability: " << failed << "\n";
    std::cout << (folder / "stability.html").string() << std::endl;
    return failures.empty() ? 0 : kFailed;
} catch (const std::invalid_argument& error) {
    std::cerr << "stability: " << error.what() << "\n";
    return kUsage;
} catch (const std::exception& error) {
    std::cerr << "stability: " << error.what() << "\n";
    return kFailed;
}
