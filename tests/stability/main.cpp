// Makes all studies in full, and a page of them.
#include <filesystem>
#include <iostream>

#include "measure/machine.hpp"
#include "measure/plot.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "stability_page.hpp"

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::cerr << "stability: usage: stability FOLDER, where the page and its charts are written to\n";
        return 2;
    }
    vrut::server::observe::start_log();
    vrut::server::measure::require_gnuplot();
    vrut::Renderer renderer;
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    {
        vrut::server::observe::Progress progress;
        vrut::stability::write_all(renderer,
                                   vrut::server::measure::machine() + ", VRUT Preview " VRUT_VERSION, folder,
                                   [&](double part, const std::string& what) { progress.show(part, what); });
    }
    std::cout << (folder / "stability.html").string() << std::endl;
    return 0;
} catch (const std::exception& error) {
    std::cerr << "stability: " << error.what() << "\n";
    return 1;
}
