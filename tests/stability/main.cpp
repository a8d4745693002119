// Makes all studies in full, and a page of them.
#include <filesystem>
#include <iostream>

#include "chart/machine.hpp"
#include "chart/plot.hpp"
#include "log.hpp"
#include "progress.hpp"
#include "stability_page.hpp"

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::cerr << "stability: usage: stability FOLDER, where the page and its charts are written to\n";
        return 2;
    }
    vrut::start_log();
    vrut::chart::require_gnuplot();
    vrut::Renderer renderer;
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    {
        vrut::Progress progress;
        vrut::stability::write_all(renderer, vrut::chart::machine() + ", VRUT Preview " VRUT_VERSION, folder,
                                   [&](double part, const std::string& what) { progress.show(part, what); });
    }
    std::cout << (folder / "stability.html").string() << std::endl;
    return 0;
} catch (const std::exception& error) {
    std::cerr << "stability: " << error.what() << "\n";
    return 1;
}
