// The program's frames beside a bare GL loop over the same triangles, which is the least that they can take;
// in turns in one run, since machines drift. Prints medians, the ratio to the row that is the limit, and
// whether it meets what we want. Then views that are close to each other, with occlusion culling and without.
// Textures, glass and reflections are taken out of the scenes: all parts are opaque.
//   bench_bare_gl [FILE...]    scenes; then scenes of many parts, and of hidden ones
// Of a file that is not there it says so: `ninja car_levels` makes the cars. Without any it exits with 77.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bare_loop.hpp"
#include "compare/difference.hpp"
#include "io/read_scene.hpp"
#include "mesh/detail_levels.hpp"
#include "renderer/renderer.hpp"
#include "shapes.hpp"

using namespace vrut;
using bench::BareMethod;
using Culling = plan::Methods::Culling;

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidth = 1280, kHeight = 720, kRounds = 7, kSkipped = 77;
constexpr double kSmallStep = 0.05;  ///< of a large one
constexpr double kMovingScale = 0.5, kMovingDetail = 1, kHalfPixel = 0.5;
constexpr double kMostOverBare = 1.10;     ///< the program at every triangle, of the bare loop
constexpr double kMostOverFewParts = 1.5;  ///< 20,000 parts, of the same triangles in 200
constexpr double kMostWithHidden = 0.5;    ///< of the time without occlusion culling
constexpr double kLeastPsnr = 40;          ///< dB, of the bare loop's picture and the program's

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

using ScenePointer = std::shared_ptr<const scene::PlacedScene>;

ScenePointer opaque_scene(scene::SceneParts parts, const std::string& name) {
    for (scene::Material& material : parts.materials) {
        material.texture = scene::kNone;
        material.diffuse.a = 1;
        material.reflectivity = 0;
    }
    auto scene = io::build_scene(std::move(parts), name);
    if (!scene) throw std::runtime_error(scene.error());
    return std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
}

ScenePointer load(const std::string& file) {
    auto parts = io::read_scene_parts(file);
    if (!parts) throw std::runtime_error(parts.error());
    return opaque_scene(*std::move(parts), file);
}

/// Cubes in a lattice, of 12 triangles each; `parts` parts hold equally many.
ScenePointer cubes(unsigned count, unsigned parts) {
    constexpr unsigned kMaterials = 20, kSide = 28;
    scene::SceneParts result;
    for (unsigned i = 0; i < kMaterials; ++i) {
        scene::Material material;
        material.id = i + 1;
        material.diffuse = glm::dvec4(0.2 + 0.03 * i, 0.5, 0.8 - 0.03 * i, 1);
        result.materials.push_back(material);
    }
    const scene::Geometry cube_around_0 = box(glm::dvec3(0.3));
    const unsigned cubes_each = count / parts;
    for (unsigned part = 0; part < parts; ++part) {
        scene::Geometry geometry;
        for (unsigned cube = part * cubes_each; cube < (part + 1) * cubes_each; ++cube) {
            const auto first = static_cast<unsigned>(geometry.positions.size());
            const glm::dvec3 at(cube % kSide, cube / kSide % kSide, cube / kSide / kSide);
            for (const glm::dvec3& corner : cube_around_0.positions)
                geometry.positions.push_back(at + corner);
            for (const glm::uvec3& triangle : cube_around_0.triangles)
                geometry.triangles.push_back(first + triangle);
        }
        for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
        result.geometries.push_back(std::move(geometry));
        scene::Node node;
        node.id = part + 1;
        node.type = scene::NodeType::geometry;
        const auto index = static_cast<scene::Index>(part);
        node.data = scene::GeometryData{index, static_cast<scene::Index>(part % kMaterials)};
        result.nodes.push_back({std::move(node), 0});
    }
    return opaque_scene(std::move(result), "cubes");
}

/// A ball of 200,000 triangles around 160 parts of 5,000 each.
ScenePointer body_around_parts() {
    constexpr unsigned kParts = 160, kSide = 6;
    scene::SceneParts result;
    result.materials.resize(2);
    for (unsigned i = 0; i < 2; ++i) {
        result.materials[i].id = i + 1;
        result.materials[i].diffuse = glm::dvec4(0.3 + 0.4 * i, 0.5, 0.6, 1);
    }
    const auto add = [&](scene::Geometry geometry, scene::Index material) {
        scene::Node node;
        node.id = static_cast<scene::Id>(result.nodes.size() + 1);
        node.type = scene::NodeType::geometry;
        node.data = scene::GeometryData{static_cast<scene::Index>(result.geometries.size()), material};
        result.geometries.push_back(std::move(geometry));
        result.nodes.push_back({std::move(node), 0});
    };
    add(sphere(12, 224), 0);
    for (unsigned part = 0; part < kParts; ++part) {
        const glm::dvec3 place(part % kSide, part / kSide % kSide, part / kSide / kSide);
        add(mapped(sphere(0.9, 36), 1, 2.2 * (place - glm::dvec3(2.5, 2.5, 2))), 1);
    }
    return opaque_scene(std::move(result), "a body around parts");
}

/// Milliseconds for each step, and those of the processor, of all threads.
struct Times {
    std::vector<double> ms, cpu_ms;
};

/// What is drawn in one way: `draw` draws step k of an orbit into an image.
struct Row {
    std::string name;
    std::function<void(int, scene::Image&)> draw;
    std::size_t limit = 0;  ///< the row that it is compared with
    double most = std::numeric_limits<double>::infinity();
    std::vector<double> ms = {}, cpu_ms = {}, ratios = {};
};

/// Draws a scene in several ways.
class Subject {
public:
    Subject(renderer::Renderer& renderer, const bench::SecondContext& contexts, ScenePointer scene, int steps)
        : renderer_(renderer),
          contexts_(contexts),
          scene_(std::move(scene)),
          steps_(steps),
          levels_(std::make_shared<const mesh::DetailLevels>(scene_->scene)) {
        levels_->wait();
        contexts_.use_second();
        const glm::dvec3 center = scene_->bounds.center();
        full_.emplace(kWidth, kHeight, center);
        materials_ = bench::draws_of_materials(view(0, 0, 1), center);
        parts_ = bench::draws_of_parts(view(0, 0, 1), center);
        half_pixel_ = bench::draws_of_parts(view(0, kHalfPixel, 1), center);
    }
    Subject(const Subject&) = delete;
    Subject& operator=(const Subject&) = delete;
    ~Subject() { contexts_.use_second(); }

    std::size_t part_count() const { return parts_.size(); }
    int steps() const { return steps_; }

    Row program(const std::string& name, double detail, double scale, std::size_t limit) {
        return program(name, limit, [=, this](int step) { return view(step, detail, scale); });
    }
    /// From places that lie close together, as while a view moves.
    Row moving(const std::string& name, double detail, std::size_t limit, Culling culling) {
        return program(name, limit, [=, this](int step) {
            plan::View shown = view(kSmallStep * step, detail, 1);
            shown.methods.culling = culling;
            return shown;
        });
    }
    Row bare_materials(const std::string& name, BareMethod method) {
        return bare(name, materials_, method, 0);
    }
    /// In small steps.
    Row bare_moving(const std::string& name) {
        return bare(name, materials_, BareMethod::plain, 0, kSmallStep);
    }
    Row bare_parts(const std::string& name, BareMethod method, std::size_t limit) {
        return bare(name, parts_, method, limit);
    }
    Row bare_half_pixel(const std::string& name, BareMethod method, std::size_t limit) {
        return bare(name, half_pixel_, method, limit);
    }

    Times measure(Row& row) {
        const bool is_bare = row.name.starts_with("bare");
        is_bare ? contexts_.use_second() : contexts_.use_first();
        Times times;
        for (int step = 0; step < steps_; ++step) {
            const auto start = Clock::now();
            const std::clock_t cpu_start = std::clock();
            row.draw(step, image_);
            times.ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
            times.cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC);
        }
        return times;
    }

    /// Peak signal-to-noise ratio of two rows' pictures, in dB.
    double psnr(Row& a, Row& b) {
        measure(a);
        const scene::Image first = image_;
        measure(b);
        return compare::difference(first, image_).psnr();
    }

private:
    Row program(const std::string& name, std::size_t limit, const std::function<plan::View(int)>& view_at) {
        return {name,
                [=, this](int step, scene::Image& image) {
                    plan::FrameStats stats;
                    renderer_.render(view_at(step), image, stats);
                },
                limit};
    }
    Row bare(const std::string& name, const std::vector<bench::BareDraw>& draws, BareMethod method,
             std::size_t limit, double step_size = 1) {
        return {name,
                [=, this, &draws](int step, scene::Image& image) {
                    full_->draw(draws, view(step_size * step, 0, 1), method, image);
                },
                limit};
    }

    /// From all around, at a distance from which the picture holds the scene.
    plan::View view(double step, double detail, double scale) const {
        constexpr double kRise = 18 * scene::kRadiansPerDegree;
        const double turn = (0.1 + step / steps_) * 2 * std::numbers::pi;
        plan::View view;
        view.scene = scene_;
        view.levels = levels_;
        view.detail = detail;
        view.width = static_cast<int>(kWidth * scale);
        view.height = static_cast<int>(kHeight * scale);
        view.camera.fov = 30;
        view.camera.focus = scene_->bounds.center();
        const double distance =
            scene_->bounds.radius() / std::sin(view.camera.fov / 2 * scene::kRadiansPerDegree);
        view.camera.eye =
            view.camera.focus + distance * glm::dvec3(std::cos(kRise) * std::cos(turn), std::sin(kRise),
                                                      std::cos(kRise) * std::sin(turn));
        view.camera = scene::with_orthogonal_up(view.camera);
        return view;
    }

    renderer::Renderer& renderer_;
    const bench::SecondContext& contexts_;
    ScenePointer scene_;
    int steps_;
    std::shared_ptr<const mesh::DetailLevels> levels_;
    std::optional<bench::BareLoop> full_;
    std::vector<bench::BareDraw> materials_, parts_, half_pixel_;
    scene::Image image_;
};

/// In turns.
void measure(Subject& subject, std::vector<Row>& rows) {
    for (Row& row : rows) subject.measure(row);  // warming up
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> of_round;
        for (Row& row : rows) {
            const Times times = subject.measure(row);
            row.ms.insert(row.ms.end(), times.ms.begin(), times.ms.end());
            row.cpu_ms.insert(row.cpu_ms.end(), times.cpu_ms.begin(), times.cpu_ms.end());
            of_round.push_back(median(times.ms));
        }
        for (std::size_t i = 0; i < rows.size(); ++i)
            rows[i].ratios.push_back(of_round[i] / of_round[rows[i].limit]);
    }
}

void print(const std::string& title, const std::vector<Row>& rows) {
    std::printf("%s\n%-45s %9s %9s %9s %7s  %s\n", title.c_str(), "", "ms", "least", "CPU ms", "ratio", "to");
    for (const Row& row : rows) {
        std::printf("%-45s %9.2f %9.2f %9.2f %7.2f  %s", row.name.c_str(), median(row.ms),
                    std::ranges::min(row.ms), median(row.cpu_ms), median(row.ratios),
                    rows[row.limit].name.c_str());
        if (row.most < std::numeric_limits<double>::infinity())
            std::printf("  <= %.2f %s", row.most, median(row.ratios) <= row.most ? "met" : "NOT met");
        std::printf("\n");
    }
    std::fflush(stdout);
}

void measure_file(renderer::Renderer& renderer, const bench::SecondContext& contexts,
                  const std::string& file) {
    const ScenePointer scene = load(file);
    const std::uint64_t triangles = scene->scene->triangle_count();
    const int steps = triangles > 2'000'000 ? 3 : triangles > 200'000 ? 6 : 24;  // short frames vary most
    Subject subject(renderer, contexts, scene, steps);
    std::vector<Row> rows{
        subject.bare_materials("bare, a draw a material", BareMethod::plain),
        subject.program("program, every triangle", 0, 1, 0),
        subject.program("program, 1/2 pixel", kHalfPixel, 1, 0),
        subject.program("program, moving: 1 pixel, half size", kMovingDetail, kMovingScale, 0),
        subject.bare_materials("bare, depth pre-pass", BareMethod::depth_pre_pass),
        subject.bare_materials("bare, 4 samples", BareMethod::multisampled),
        subject.bare_materials("bare, flushes", BareMethod::flushes),
        subject.bare_parts("bare, a draw a part", BareMethod::plain, 0),
        subject.bare_parts("bare, parts front to back", BareMethod::front_to_back, 7),
        subject.bare_half_pixel("bare, 1/2 pixel, parts", BareMethod::plain, 0),
        subject.bare_half_pixel("bare, 1/2 pixel, two strips", BareMethod::strips, 9),
        subject.bare_half_pixel("bare, 1/2 pixel, flushes", BareMethod::flushes, 9),
    };
    rows[1].most = kMostOverBare;
    measure(subject, rows);
    const double psnr = subject.psnr(rows[0], rows[1]);
    print(file + ": " + std::to_string(triangles) + " triangles, " + std::to_string(subject.part_count()) +
              " parts; PSNR of bare and program " + std::to_string(psnr) + " dB",
          rows);
    if (psnr < kLeastPsnr) throw std::runtime_error("the bare loop draws another picture");
    std::vector<Row> moving{
        subject.bare_moving("bare, a draw a material"),
        subject.moving("program, every triangle, frustum culling only", 0, 0, Culling::frustum),
        subject.moving("program, every triangle", 0, 0, Culling::occlusion),
        subject.moving("program, 1/2 pixel, frustum culling only", kHalfPixel, 3, Culling::frustum),
        subject.moving("program, 1/2 pixel", kHalfPixel, 3, Culling::occlusion),
    };
    moving[2].most = kMostOverBare;
    measure(subject, moving);
    print("the same in small steps", moving);
}

void measure_many_parts(renderer::Renderer& renderer, const bench::SecondContext& contexts) {
    constexpr unsigned kCubes = 20'000;
    constexpr int kSteps = 6;
    Subject few(renderer, contexts, cubes(kCubes, 200), kSteps),
        many(renderer, contexts, cubes(kCubes, kCubes), kSteps);
    std::vector<Row> rows{few.program("program, 200 parts", 0, 1, 0),
                          many.program("program, 20,000 parts", 0, 1, 0),
                          many.bare_materials("bare, a draw a material", BareMethod::plain),
                          many.bare_parts("bare, a draw a part", BareMethod::plain, 0)};
    rows[1].most = kMostOverFewParts;
    measure(few, rows);
    print("240,000 triangles in many parts", rows);
}

void measure_hidden_parts(renderer::Renderer& renderer, const bench::SecondContext& contexts) {
    constexpr int kSteps = 6;
    Subject subject(renderer, contexts, body_around_parts(), kSteps);
    std::vector<Row> rows{subject.moving("program, frustum culling only", 0, 0, Culling::frustum),
                          subject.moving("program", 0, 0, Culling::occlusion)};
    rows[1].most = kMostWithHidden;
    measure(subject, rows);
    print("1,000,000 triangles, 80 % of them hidden", rows);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        std::vector<std::string> files(arguments + 1, arguments + count);
        const std::size_t given = files.size();
        std::erase_if(files, [](const std::string& file) {
            const bool missing = !std::filesystem::exists(file);
            if (missing) std::printf("%s is not there: ninja car_levels makes the cars\n", file.c_str());
            return missing;
        });
        if (given > 0 && files.empty()) return kSkipped;
        renderer::Renderer renderer;
        renderer.choose_resolver();  // as a server does
        const bench::SecondContext contexts;
        std::printf("%s, %dx%d, medians of %d rounds in turns\n", renderer.description().c_str(), kWidth,
                    kHeight, kRounds);
        for (const std::string& file : files) measure_file(renderer, contexts, file);
        measure_many_parts(renderer, contexts);
        measure_hidden_parts(renderer, contexts);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_bare_gl: %s\n", error.what());
        return 1;
    }
}
