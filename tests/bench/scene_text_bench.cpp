// Scene text beside the peer's reader of OBJ: one step of tests/bench/scene_text.mjs, in a process of its
// own.
//   convert FILE.obj FILE.vrut   the same geometry, with the same digits
//   ours FILE.vrut               reads it as the server does
//   parts FILE.vrut              the same without linking the scene
//   peer FILE.obj                assimp reads it, without any of its further steps
//   sum FILE                     the file's SHA-256, as the server takes it
// The last four print milliseconds, those of the processor, and by how many megabytes the peak of memory
// rose; `ours` also what its scene's arrays come to when they are drawn.
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/read_scene.hpp"
#include "io/vrut/text_reader.hpp"
#include "scenes/library.hpp"

using namespace vrut;
using namespace vrut::server::scenes;

namespace {

/// VmHWM of /proc/self/status.
double peak_megabytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
    throw std::runtime_error("/proc/self/status does not tell VmHWM");
}

/// What one object of an OBJ file holds, as text: the generator's faces are triangles "V//N V//N V//N" whose
/// normals have their vertices' numbers.
struct Object {
    std::size_t first_vertex = 1, vertex_count = 0, triangle_count = 0;
    std::string vertices, normals, triangles;

    void add_face(const std::string& face) {
        std::istringstream corners(face);
        for (std::string corner; corners >> corner;)
            triangles += " " + std::to_string(std::stoull(corner) - first_vertex);
        triangles += '\n';
        ++triangle_count;
    }

    void write(std::ostream& out, int id) const {
        if (vertex_count == 0) return;
        out << "geometry " << id << "\n  vertices " << vertex_count << "\n" << vertices;
        out << "  normals " << vertex_count << "\n" << normals;
        out << "  triangles " << triangle_count << "\n" << triangles << "end\n";
        out << "node " << id << " \"\" geometry  geometry " << id << "  end\n";
    }
};

void convert(const std::string& from, const std::string& to) {
    std::ifstream in(from);
    std::ofstream out(to);
    out << "vrut-text 1\n";
    Object object;
    int id = 1;
    for (std::string line; std::getline(in, line);) {
        const std::string keyword = line.substr(0, line.find(' '));
        const std::string rest = line.substr(std::min(keyword.size(), line.size()));
        if (keyword == "o") {
            object.write(out, id++);
            const std::size_t next = object.first_vertex + object.vertex_count;
            object = {};
            object.first_vertex = next;
        } else if (keyword == "v") {
            object.vertices += rest + '\n';
            ++object.vertex_count;
        } else if (keyword == "vn") {
            object.normals += rest + '\n';
        } else if (keyword == "f") {
            object.add_face(rest);
        }
    }
    object.write(out, id);
    if (!out.flush()) throw std::runtime_error(to + " cannot be written");
}

/// Vertices of a position and a normal, in float, and triangles of three indices.
double drawn_megabytes(const scene::Scene& scene) {
    double bytes = 0;
    for (const scene::Geometry& geometry : scene.geometries())
        bytes += 24 * static_cast<double>(geometry.positions.size()) +
                 12 * static_cast<double>(geometry.triangles.size());
    return bytes / (1 << 20);
}

/// Of all threads.
double processor_milliseconds() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
void measure(const Work& work) {
    const double before = peak_megabytes(), cpu_before = processor_milliseconds();
    const auto start = std::chrono::steady_clock::now();
    const auto result = work();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    std::cout << "ms " << took.count() << " cpu " << processor_milliseconds() - cpu_before << " peak "
              << peak_megabytes() - before;
    if constexpr (std::is_same_v<decltype(result), const scene::Scene>)
        std::cout << " drawn " << drawn_megabytes(result) << " triangles " << result.triangle_count();
    std::cout << std::endl;
}

template <class Result>
auto good(Result result) {
    if (!result) throw std::runtime_error(result.error());
    return *std::move(result);
}

bool import(const std::string& file) {
    Assimp::Importer importer;
    if (importer.ReadFile(file, 0) == nullptr) throw std::runtime_error(importer.GetErrorString());
    return true;
}

void run(const std::vector<std::string>& words) {
    const std::string& file = words[1];
    if (words[0] == "convert" && words.size() == 3) return convert(file, words[2]);
    if (words[0] == "ours") return measure([&] { return good(io::read_scene(file)); });
    if (words[0] == "parts") return measure([&] { return good(io::read_vrut_file(file)).nodes.size(); });
    if (words[0] == "peer") return measure([&] { return import(file); });
    if (words[0] == "sum") return measure([&] { return sha256_of(file); });
    throw std::runtime_error("what is '" + words[0] + "'?");
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        std::cerr << "usage: bench_scene_text convert|ours|parts|peer|sum FILE [FILE]\n";
        return 2;
    }
    try {
        run({arguments + 1, arguments + count});
    } catch (const std::exception& error) {
        std::cerr << "bench_scene_text: " << error.what() << "\n";
        return 1;
    }
}
