// What tests/data/warp holds for the tests of the page, which decodes depth maps and warps by them, too: maps
// with their layers, matrices, and a frame with what other cameras see of it. After a change VRUT_RENEW=1
// writes them again. Look at the diff then.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "depth_map_of.hpp"
#include "io/image/image_file.hpp"
#include "io/texture_writer.hpp"
#include "warp/warp.hpp"

using namespace vrut;
using namespace vrut::warp;
using nlohmann::ordered_json;

namespace {

const std::filesystem::path kFolder = VRUT_DATA;

bool renews() { return std::getenv("VRUT_RENEW") != nullptr; }

std::string hex_of(std::string_view bytes) {
    std::string hex;
    for (const char byte : bytes) {
        const unsigned value = static_cast<unsigned char>(byte);
        hex += "0123456789abcdef"[value >> 4U];
        hex += "0123456789abcdef"[value & 15U];
    }
    return hex;
}

std::string bytes_of(const std::string& hex) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
}

ordered_json read(const std::string& name) {
    std::ifstream file(kFolder / name);
    CAPTURE(name);
    REQUIRE(file.is_open());
    return ordered_json::parse(file);
}

/// A line for each member or element.
void write(const std::string& name, const ordered_json& value) {
    std::ofstream file(kFolder / name);
    const bool is_object = value.is_object();
    const char* before = is_object ? "{\n  " : "[\n  ";
    for (const auto& [member, element] : value.items()) {
        file << before;
        if (is_object) file << ordered_json(member) << ": ";
        file << element;
        before = ",\n  ";
    }
    file << (is_object ? "\n}\n" : "\n]\n");
}

ordered_json json_of(const DepthMap& map) {
    return {
        {"columns", map.columns}, {"rows", map.rows}, {"scale", map.scale}, {"bytes", hex_of(encode(map))}};
}

std::optional<DepthMap> decoded(const ordered_json& file) {
    return decode(bytes_of(file.at("bytes")), file.at("columns"), file.at("rows"), file.at("scale"));
}

constexpr double kNear = 0.5;

/// Of blocks of 4 pixels that have reciprocal distances `of` their column and row, from the top left.
template <class Of>
DepthMap map_of(int columns, int rows, Of of) {
    const int width = 4 * columns, height = 4 * rows;
    std::vector<float> depth;
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x) depth.push_back(static_cast<float>(kNear * of(x, y)));
    return depth_map_of(depth, width, height, kNear, depth_map_size(width, height, 4));
}

std::vector<std::pair<std::string, DepthMap>> maps() {
    std::mt19937 random(7);
    const auto noise = [&](int x, int y) {
        return x + y < 20 ? 0.0 : static_cast<double>(random() % 1000) / 1000;
    };
    const auto surfaces = [](int x, int y) {
        if (std::hypot(x - 30, y - 14) < 9) return 1.0;
        return y < 8 - x / 8 ? 0.0 : y < 20 ? 0.25 + 0.002 * x : 0.25 + 0.02 * (y - 20);
    };
    return {{"one-block", map_of(1, 1, [](int x, int y) { return x < y ? 1.0 : 0.5; })},
            {"infinity", map_of(3, 2, [](int, int) { return 0.0; })},
            {"surfaces", map_of(16, 9, surfaces)},
            {"noise", map_of(13, 7, noise)}};
}

/// What a camera sees of the world in one direction.
struct Seen {
    glm::dvec3 color{0};  ///< 0 to 255
    double reciprocal = 0;
};

constexpr int kWidth = 96, kHeight = 64;
constexpr double kAspect = static_cast<double>(kWidth) / kHeight;

/// A square at z = -5, behind it a wall at z = -12 up to y = 2.8, at whose foot begins a slope; a sky with
/// clouds.
Seen seen(const scene::Camera& camera, const glm::dvec2& point) {
    const glm::dvec3 ray = scene::direction_through(camera, kAspect, point);
    Seen result{{30, 60, 120 + 40 * std::sin(20 * ray.x)}, 0};
    const auto meet = [&](double distance, auto is_there, auto color_at) {
        const glm::dvec3 at = camera.eye + distance * ray;
        const double reciprocal = 1 / (distance * glm::dot(ray, scene::view_direction(camera)));
        if (distance > 0 && reciprocal > result.reciprocal && is_there(at))
            result = {glm::round(color_at(at)), reciprocal};
    };
    meet((-12 - camera.eye.z) / ray.z, [](const glm::dvec3& p) { return p.y < 2.8; },
         [](const glm::dvec3& p) {
             return glm::dvec3(120 + 80 * std::sin(2 * p.x), 120 + 80 * std::cos(2 * p.y), 40);
         });
    meet((-8.4 - 0.6 * camera.eye.z - camera.eye.y) / (ray.y + 0.6 * ray.z),
         [](const glm::dvec3& p) { return p.z > -12; },
         [](const glm::dvec3& p) { return glm::dvec3(90, 90 + 60 * std::sin(3 * p.x + 2 * p.z), 90); });
    meet((-5 - camera.eye.z) / ray.z,
         [](const glm::dvec3& p) { return std::abs(p.x + 0.25) < 0.8 && std::abs(p.y) < 0.8; },
         [](const glm::dvec3& p) { return glm::dvec3(230, 120 + 60 * std::sin(5 * p.y + 3 * p.x), 200); });
    return result;
}

struct Taken {
    scene::Image image;
    DepthMap depth;
};

Taken taken(const scene::Camera& camera) {
    Taken result;
    result.image.resize(kWidth, kHeight);
    std::vector<float> depth;
    for (std::size_t i = 0; i < result.image.rgba.size(); i += 4) {
        const int pixel = static_cast<int>(i / 4), x = pixel % kWidth, y = pixel / kWidth;
        const Seen what = seen(camera, {2 * (x + 0.5) / kWidth - 1, 1 - 2 * (y + 0.5) / kHeight});
        for (int k = 0; k < 3; ++k)
            result.image.rgba[i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(what.color[k]);
        result.image.rgba[i + 3] = 255;
        depth.push_back(static_cast<float>(kNear * what.reciprocal));
    }
    result.depth = depth_map_of(depth, kWidth, kHeight, kNear, depth_map_size(kWidth, kHeight, 4));
    return result;
}

scene::Camera camera_at(const glm::dvec3& eye, const glm::dvec3& focus, const glm::dvec3& up = {0, 1, 0},
                        double fov = 40) {
    scene::Camera camera;
    camera.eye = eye;
    camera.focus = focus;
    camera.up = up;
    camera.fov = fov;
    return scene::with_orthogonal_up(camera);
}

ordered_json json_of(const scene::Camera& camera) {
    const auto list = [](const glm::dvec3& v) { return ordered_json{v.x, v.y, v.z}; };
    return {{"eye", list(camera.eye)},
            {"focus", list(camera.focus)},
            {"up", list(camera.up)},
            {"fov", camera.fov}};
}

struct Move {
    std::string name;
    scene::Camera to;
    Background background = Background::turns;
};

const scene::Camera kFrom = camera_at({0.25, 0.5, 0}, {0, 0, -5});

std::vector<Move> moves() {
    const glm::dvec3 view = kFrom.focus - kFrom.eye;
    const double angle = 10 * scene::kRadiansPerDegree, c = std::cos(angle), s = std::sin(angle);
    const glm::dvec3 turned(c * view.x - s * view.z, view.y, s * view.x + c * view.z);
    const glm::dvec3 aside(0.5, 0.1, 0.2);
    return {{"turned", camera_at(kFrom.eye, kFrom.eye + turned)},
            {"around", camera_at(kFrom.focus - turned, kFrom.focus), Background::stays},
            {"aside", camera_at(kFrom.eye + aside, kFrom.focus + aside)},
            {"nearer", camera_at(kFrom.eye + 0.4 * view, kFrom.focus, {0.1, 1, 0})},
            {"zoomed", camera_at(kFrom.eye, kFrom.focus, {0, 1, 0}, 25)}};
}

/// The part of the pixels that differ by more than a step of rounding.
double different_part(const scene::Image& a, const scene::Image& b) {
    if (a.rgba.size() != b.rgba.size()) return 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        for (std::size_t k = i; k < i + 3; ++k)
            if (std::abs(a.rgba[k] - b.rgba[k]) > 1) {
                ++count;
                break;
            }
    return 4 * static_cast<double>(count) / static_cast<double>(a.rgba.size());
}

void check_image(const std::string& name, const scene::Image& image) {
    const std::filesystem::path path = kFolder / "warps" / (name + ".png");
    if (renews()) {
        const std::vector<std::uint8_t> bytes = io::encode_png(image);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return;
    }
    const auto expected = io::read_image_file(path);
    CAPTURE(name);
    REQUIRE(expected);
    CHECK(different_part(*expected, image) < 0.001);
}

}  // namespace

TEST_CASE("the page's depth maps are what is encoded, with these layers") {
    for (const auto& named : maps()) {
        const auto& [name, map] = named;
        CAPTURE(named.first);
        const Layers layers = layers_of(map);
        ordered_json file = json_of(map);
        file.update({{"near", map.near}, {"far", map.far}, {"mask", map.mask}});
        file["layers"] = {{"near", layers.near},
                          {"far", layers.far},
                          {"mask", layers.mask},
                          {"farthest", layers.farthest},
                          {"nearSlope", layers.near_slope},
                          {"farSlope", layers.far_slope}};
        if (renews()) write("depth-maps/" + name + ".json", file);
        const ordered_json expected = read("depth-maps/" + name + ".json");
        // Another zlib writes other bytes.
        CHECK(decoded(expected) == map);
        for (const char* member : {"near", "far", "mask", "layers"})
            CHECK(expected.at(member) == file.at(member));
    }
}

TEST_CASE("the page's matrices are these, and the same far from the origin") {
    const glm::dvec3 away(1e7, -1e7, 3e6);
    ordered_json pairs = ordered_json::array();
    for (const Move& move : moves()) {
        const glm::dmat4 matrix = warp_matrix(kFrom, move.to, kAspect);
        ordered_json numbers = ordered_json::array();
        for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4]);
        pairs.push_back({{"from", json_of(kFrom)},
                         {"to", json_of(move.to)},
                         {"aspect", kAspect},
                         {"matrix", std::move(numbers)}});
    }
    // Eyes and focuses that doubles hold there, too.
    scene::Camera from = kFrom, to = camera_at({0.75, -0.5, 0.25}, {0.5, 0.25, -4});
    const glm::dmat4 matrix = warp_matrix(from, to, kAspect);
    for (scene::Camera* camera : {&from, &to}) {
        camera->eye += away;
        camera->focus += away;
    }
    ordered_json numbers = ordered_json::array();
    for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4]);
    pairs.push_back(
        {{"from", json_of(from)}, {"to", json_of(to)}, {"aspect", kAspect}, {"matrix", std::move(numbers)}});

    if (renews()) write("warps/matrices.json", pairs);
    const ordered_json expected = read("warps/matrices.json");
    REQUIRE(expected.size() == pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        CAPTURE(i);
        for (const char* camera : {"from", "to"})
            for (const char* member : {"eye", "focus", "up"})
                for (std::size_t k = 0; k < 3; ++k)
                    CHECK(pairs[i][camera][member][k].get<double>() ==
                          doctest::Approx(expected[i][camera][member][k].get<double>()).epsilon(1e-12));
        for (std::size_t k = 0; k < 16; ++k)
            CHECK(pairs[i]["matrix"][k].get<double>() ==
                  doctest::Approx(expected[i]["matrix"][k].get<double>()).epsilon(1e-12));
    }
}

TEST_CASE("the page's frame looks to other cameras as its images show") {
    const Taken from = taken(kFrom);
    check_image("frame", from.image);
    ordered_json file = json_of(from.depth);
    file["camera"] = json_of(kFrom);
    file["warps"] = ordered_json::array();
    for (const Move& move : moves()) {
        check_image(move.name, warped(from.image, from.depth, kFrom, move.to, move.background));
        file["warps"].push_back({{"image", move.name + ".png"},
                                 {"camera", json_of(move.to)},
                                 {"backgroundTurns", move.background == Background::turns}});
    }
    if (renews()) write("warps/frame.json", file);
    const ordered_json expected = read("warps/frame.json");
    CHECK(decoded(expected) == from.depth);
    CHECK(expected.at("warps").size() == file.at("warps").size());
}
