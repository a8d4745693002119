// Draws a glTF model as the peer of tests/bench/peers.mjs does: same orbit, light, background and material.
// Does what its standard input says, line by line, and answers with a line each:
//   frames DETAIL SCALE QUALITY [sorted] [vertex]
//       draws, reads back and encodes STEPS pictures; medians. With sorted transparency, with vertex light
//   compare DETAIL
//       how far that detail is from every triangle, at its worst on the orbit
//   picture FILE
//       writes step 7 as PNG
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "base/files.hpp"
#include "compare/difference.hpp"
#include "engine/images.hpp"
#include "io/read_scene.hpp"
#include "mesh/detail_levels.hpp"
#include "renderer/renderer.hpp"

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::engine;

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// VmHWM of /proc/self/status.
double peak_megabytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
    throw std::runtime_error("/proc/self/status does not tell VmHWM");
}

/// Through the transfer curve of sRGB (IEC 61966-2-1), back.
double linear(double displayed) {
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}

/// The peer's: ambient 0.25, diffuse 0.75, specular 0.5, all of the file's colour, which it shows as it is;
/// power 40.
scene::Material peers_material(scene::Material material) {
    const glm::dvec3 color(linear(material.diffuse.r), linear(material.diffuse.g),
                           linear(material.diffuse.b));
    material.ambient = glm::dvec4(0.25 * color, 1);
    material.diffuse = glm::dvec4(0.75 * color, material.diffuse.a);
    material.specular = glm::dvec4(0.5 * color, 1);
    material.emission = {0, 0, 0, 1};
    material.shininess = 40;
    material.reflectivity = 0;
    return material;
}

std::shared_ptr<const scene::PlacedScene> load(const std::string& file) {
    auto parts = io::read_scene_parts(file);
    if (!parts) throw std::runtime_error(parts.error());
    for (scene::Material& material : parts->materials) material = peers_material(material);
    auto scene = io::build_scene(*std::move(parts), file);
    if (!scene) throw std::runtime_error(scene.error());
    return std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
}

/// Sixty steps around the model.
scene::Camera camera_at(int step) {
    constexpr double kRise = 18 * scene::kRadiansPerDegree, kRadius = 6.2;
    const double turn = step * 2 * std::numbers::pi / 60;
    scene::Camera camera;
    camera.focus = {0, 0.6, 0};
    camera.eye = camera.focus + kRadius * glm::dvec3(std::cos(kRise) * std::cos(turn), std::sin(kRise),
                                                     std::cos(kRise) * std::sin(turn));
    camera.fov = 30;
    return scene::with_orthogonal_up(camera);
}

class Bench {
public:
    Bench(std::shared_ptr<const scene::PlacedScene> scene, int width, int height, int steps)
        : width_(width), height_(height), steps_(steps) {
        view_.scene = std::move(scene);
        view_.background.color = {0.9, 0.92, 0.95};
        view_.light.headlight = false;
        view_.light.type = scene::LightData::Type::directional;
        view_.light.direction = -glm::normalize(glm::dvec3(4, 8, 4.5));
    }

    void make_levels() { view_.levels = std::make_shared<const mesh::DetailLevels>(view_.scene->scene); }

    /// In milliseconds, and as the server's quality of stills encodes it.
    double first_picture() {
        const auto start = Clock::now();
        jpeg_.encode(draw(0, 0, 1), 85, true);
        return milliseconds_since(start);
    }

    void use(const plan::Methods& methods) { view_.methods = methods; }

    void frames(double detail, double scale, int quality) {
        std::vector<double> draw_ms, readback_ms, encode_ms, frame_ms, bytes, triangles;
        for (int step = -2; step < steps_; ++step) {
            const auto start = Clock::now();
            const scene::Image& image = draw(step, detail, scale);
            const auto drawn = Clock::now();
            const std::size_t size = jpeg_.encode(image, quality, true).size();
            if (step < 0) continue;  // warming up
            frame_ms.push_back(milliseconds_since(start));
            encode_ms.push_back(milliseconds_since(drawn));
            draw_ms.push_back(stats_.render_ms);
            readback_ms.push_back(stats_.readback_ms);
            bytes.push_back(static_cast<double>(size));
            triangles.push_back(static_cast<double>(stats_.triangles));
        }
        std::cout << "draw " << median(draw_ms) << " readback " << median(readback_ms) << " encode "
                  << median(encode_ms) << " frame " << median(frame_ms) << " bytes " << median(bytes)
                  << " triangles " << median(triangles) << " peak " << peak_megabytes() << std::endl;
    }

    void compare(double detail) {
        use({});
        double psnr = std::numeric_limits<double>::infinity(), share = 0;
        for (int step = 0; step < 60; step += 12) {
            const scene::Image every = draw(step, 0, 1);
            const compare::Difference off = compare::difference(every, draw(step, detail, 1));
            psnr = std::min(psnr, off.psnr());
            share = std::max(share, off.share_above(8));
        }
        std::cout << "psnr " << psnr << " above8 " << 100 * share << std::endl;
    }

    void picture(const std::string& file) { write_file(file, io::encode_png(draw(7, 0, 1))); }

private:
    const scene::Image& draw(int step, double detail, double scale) {
        view_.camera = camera_at(step);
        view_.detail = detail;
        view_.width = static_cast<int>(std::lround(width_ * scale));
        view_.height = static_cast<int>(std::lround(height_ * scale));
        if (detail > 0 && view_.levels) view_.levels->wait();
        renderer_.render(view_, image_, stats_);
        return image_;
    }

    int width_, height_, steps_;
    plan::View view_;
    renderer::Renderer renderer_;
    JpegEncoder jpeg_;
    scene::Image image_;
    plan::FrameStats stats_;
};

plan::Methods methods_of(std::istream& words) {
    plan::Methods methods;
    for (std::string word; words >> word;) {
        if (word == "sorted") methods.transparency = plan::Methods::Transparency::sorted;
        if (word == "vertex") methods.light = plan::Methods::Lighting::vertex;
    }
    return methods;
}

void obey(Bench& bench, const std::string& line) {
    std::istringstream words(line);
    std::string order, file;
    double detail = 0, scale = 1;
    int quality = 0;
    words >> order;
    if (order == "frames" && words >> detail >> scale >> quality) {
        bench.use(methods_of(words));
        return bench.frames(detail, scale, quality);
    }
    if (order == "compare" && words >> detail) return bench.compare(detail);
    if (order == "picture" && words >> file) {
        bench.picture(file);
        std::cout << file << std::endl;
        return;
    }
    throw std::runtime_error("what is '" + line +
                             "'? frames DETAIL SCALE QUALITY [METHODS], compare DETAIL or picture FILE");
}

}  // namespace

int main(int count, char** arguments) {
    int width = 0, height = 0;
    if (count < 4 || std::sscanf(arguments[2], "%dx%d", &width, &height) != 2) {
        std::cerr << "usage: bench_frames FILE.glb WxH STEPS [--levels] < ORDERS\n";
        return 2;
    }
    try {
        const auto start = Clock::now();
        auto scene = load(arguments[1]);
        const double load_ms = milliseconds_since(start);
        const bool levels = count > 4 && std::string(arguments[4]) == "--levels";
        Bench bench(std::move(scene), width, height, std::stoi(arguments[3]));
        if (levels) bench.make_levels();
        const double first_ms = bench.first_picture();
        std::cout << std::fixed << std::setprecision(2) << "load " << load_ms << " first " << first_ms
                  << " start_to_first " << milliseconds_since(start) << " peak " << peak_megabytes()
                  << std::endl;
        for (std::string line; std::getline(std::cin, line);) obey(bench, line);
    } catch (const std::exception& error) {
        std::cerr << "bench_frames: " << error.what() << "\n";
        return 1;
    }
}
