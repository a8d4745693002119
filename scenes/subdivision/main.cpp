#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <iostream>

#include "base/file_bytes.hpp"
#include "car_scene.hpp"
#include "io/vrut/text_writer.hpp"

namespace {

int fail(const std::string& sentence) {
    std::cerr << sentence << std::endl;
    return 1;
}

int run(const std::string& cage_file, double triangles, const std::string& output) {
    const auto start = std::chrono::steady_clock::now();
    if (const auto fault = vrut::base::file_error(cage_file)) return fail(cage_file + ": " + *fault);
    const auto text = vrut::base::read_bytes(cage_file);
    if (!text) return fail(cage_file + ": " + text.error());
    const auto cages = vrut::read_cage_scene(*text);
    if (!cages) return fail(cage_file + ": " + cages.error());
    const auto result = vrut::subdivide(*cages, triangles);
    if (!result) return fail(cage_file + ": " + result.error());

    for (const std::string& name : result->lost)
        std::cerr << cage_file << ": nothing is left of " << name << std::endl;
    std::ofstream out(output, std::ios::binary);
    vrut::io::write_vrut_text(result->scene, out,
                              "Made by subdivide from " +
                                  std::filesystem::path(cage_file).filename().string() +
                                  ": change that, not this.");
    out.close();
    if (!out) return fail(output + ": cannot be written");
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    std::cout << std::fixed << std::setprecision(0) << result->shown << " triangles shown, "
              << result->vertices << " vertices, tolerance " << std::setprecision(3)
              << result->tolerance * 1000 << " mm, " << std::setprecision(1) << taken.count() << " s"
              << std::endl;
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app(
        "Makes scene text of control cages: their limit surfaces in triangles, small where they bend.");
    std::string cage_file, output;
    double triangles = 200000;
    app.add_option("CAGES", cage_file, "File of control cages (.json)")->required();
    app.add_option("--triangles", triangles, "How many triangles shall show, about")
        ->check(CLI::Range(1.0, 100e6))
        ->capture_default_str();
    app.add_option("-o,--output", output, "Scene text to write (.vrut)")->required();
    CLI11_PARSE(app, argc, argv);
    return run(cage_file, triangles, output);
} catch (const std::exception& error) {
    return fail(error.what());
}
